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

/* value * share / 2^31 for 0 <= share <= 2^31. */
static inline int64_t times_q31(int64_t value, uint32_t share)
{
    int64_t high = value >> 32;
    uint64_t low = (uint32_t)value;
    return (high * (int64_t)share) * 2 + (int64_t)(low * share >> 31);
}

static inline int32_t magnitude(int32_t value)
{
    return value < 0 ? -value : value;
}

#endif
