/* A segment's duration as factors, so that nothing is divided where it is used: a 64-bit division
   takes an 8-bit controller 0.2 ms. */
#ifndef SPAN_H
#define SPAN_H

#include <stdint.h>

struct span {
    int32_t us;       /* 0 < us < 2^24 */
    uint32_t seconds; /* duration = seconds / 2^(28 + seconds_shift), to 32 significant bits */
    uint8_t seconds_shift;
    uint32_t rate; /* 1 / duration = rate / 2^(23 + rate_shift), to 32 significant bits */
    uint8_t rate_shift;
};

/* From SHORTEST_SEGMENT_US to LONGEST_SEGMENT_US of limits.h. */
struct span span_of(int32_t us);
/* value * duration in seconds; |value| < 2^58. */
int64_t span_times(const struct span *span, int64_t value);
/* value / duration in seconds, as far as it fits. */
int64_t span_per(const struct span *span, int64_t value);

#endif
