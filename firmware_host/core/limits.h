/* Whether a segment of motion stays within the limits from end to end, not at its knots only, for
   the joints and for the motors: a box of joints is no box of motors behind a differential. */
#ifndef LIMITS_H
#define LIMITS_H

#include "hand_setup.h"

/* Shorter ones would be all rounding, longer ones leave 64 bits. */
#define SHORTEST_SEGMENT_US 3000
#define LONGEST_SEGMENT_US 10000000

struct violation {
    uint8_t reason; /* 0: none */
    uint8_t joint;  /* or motor, where the reason is one of a motor */
};

/* `offset`: the motors' zeros in use. */
struct violation segment_violation(
    const struct knot *from, const struct knot *to, const struct hand_setup *setup,
    const int32_t *offset);

#endif
