/* Finds the motors' zeros by touching the joints' end stops with little current.

   A joint is moved along its column of the transmission, so that the others stay where they are:
   flexion turns m1 and m2 alike while m3 follows by c1, abduction turns them against each other, the
   IP joint turns m3 alone. One joint after the other goes to its lower end, to its upper end, and
   rests. What lies between must be the designed range within a tenth. Then flexion goes to its
   middle, and the IP joint must have its lower end where it was: if m3 turned the wrong way, or m1
   and m2 did, its tendon has moved the joint instead of keeping it. */
#ifndef HOMING_H
#define HOMING_H

#include "hand_setup.h"

struct homing {
    uint8_t outcome; /* enum homing_outcome */
    uint8_t culprit; /* the joint being searched, or where the search failed */
    uint8_t step;
    uint8_t moved;      /* the joint that moves; not always the one being searched */
    int32_t rate;       /* its command, with sign */
    int32_t place[MAX_JOINTS]; /* commands, counted from the zeros in use so far, as all here */
    int32_t began;
    int32_t furthest;
    uint32_t still_us;
    int32_t lower[MAX_JOINTS]; /* ends as found */
    int32_t upper[MAX_JOINTS];
};

/* Start a search where the joints are. */
void homing_begin(struct homing *homing, const struct hand_setup *setup, const int32_t *measured);
/* One tick: look at the joints, set `place` and `rate`; `outcome` tells when it is over. */
void homing_step(
    struct homing *homing, const struct hand_setup *setup, const int32_t *measured, int32_t dt_us);
/* What a joint's angle was found to be greater by than it was taken for. */
int32_t homing_shift(const struct homing *homing, const struct hand_setup *setup, uint8_t joint);
/* Joints whose two ends have been found, in the order of the joints. */
uint8_t homing_found(const struct homing *homing, const struct hand_setup *setup);

#endif
