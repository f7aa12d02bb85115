#include "span.h"

#include "fixed.h"

struct span span_of(int32_t us)
{
    struct span span = {.us = us};
    uint64_t duration = (uint64_t)us << 28, one = (uint64_t)US_PER_S << 23;
    while (duration < (uint64_t)US_PER_S << 31) {
        duration <<= 1;
        span.seconds_shift++;
    }
    while (one < (uint64_t)us << 31) {
        one <<= 1;
        span.rate_shift++;
    }
    span.seconds = (uint32_t)(duration / US_PER_S);
    span.rate = (uint32_t)(one / (uint32_t)us);
    return span;
}

/* value * factor / 2^32, rounded down. */
static int64_t scaled(int64_t value, uint32_t factor)
{
    int64_t high = times_word((int32_t)(value >> 32), factor);
    return high + (int64_t)((uint64_t)(uint32_t)value * factor >> 32);
}

int64_t span_times(const struct span *span, int64_t value)
{
    return scaled(value * 16, span->seconds) >> span->seconds_shift;
}

int64_t span_per(const struct span *span, int64_t value)
{
    int64_t result = scaled(value, span->rate);
    if (span->rate_shift > 9) {
        return result >> (span->rate_shift - 9);
    }
    return result * ((int32_t)1 << (9 - span->rate_shift));
}
