/* Fixed point: positions in counts of 1e-6 rad, inside segments with 20 more bits of fraction.
   Signed right shifts round down on every compiler that these builds use. */
#ifndef FIXED_H
#define FIXED_H

#include <stdint.h>

#define FRACTION_BITS 20
#define US_PER_S 1000000

static inline int64_t to_fine(int32_t counts)
{
    return (int64_t)counts * ((int64_t)1 << FRACTION_BITS);
}

static inline int32_t to_counts(int64_t fine)
{
    return (int32_t)((fine + ((int64_t)1 << (FRACTION_BITS - 1))) >> FRACTION_BITS);
}

/* 32 by 32 bits: small processors take a tenth of the time that 64 by 64 bits take them. */
static inline int64_t times_word(int32_t value, uint32_t factor)
{
    uint64_t product = (uint64_t)(uint32_t)value * factor;
    return (int64_t)(value < 0 ? product - ((uint64_t)factor << 32) : product);
}

/* value * share / 2^32. Whole bytes of shift cost small processors nothing. */
static inline int64_t times_share(int64_t value, uint32_t share)
{
    int64_t high = times_word((int32_t)(value >> 32), share);
    uint64_t low = (uint64_t)(uint32_t)value * share;
    return high + (int64_t)(low >> 32);
}

static inline int32_t magnitude(int32_t value)
{
    return value < 0 ? -value : value;
}

#endif
