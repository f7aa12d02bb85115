/* Whether a segment of motion stays within the limits from end to end, not at its knots only. */
#ifndef LIMITS_H
#define LIMITS_H

#include "hand_setup.h"

/* Shorter ones would be all rounding, longer ones leave 64 bits. */
#define SHORTEST_SEGMENT_US 3000
#define LONGEST_SEGMENT_US 10000000

struct violation {
    uint8_t reason; /* 0: none */
    uint8_t joint;
};

struct violation segment_violation(
    const struct knot *from, const struct knot *to, uint8_t joints,
    const struct joint_limits *limits);

#endif
