#include "homing.h"

#include <string.h>

#include "fixed.h"

#define PROGRESS 2000        /* less than this is the encoders' noise [1e-6 rad] */
#define STALL_US 200000      /* without progress: an end */
#define BLOCKED_US 1000000   /* without progress on the way back: something is in the way */
#define LEAD 100000          /* how far the command runs ahead; with it grows the motors' pull */
#define ARRIVED 50000
#define TOLERANCE_SHARE 10   /* a tenth of the designed range */

enum step {
    SEEK_LOWER,
    SEEK_UPPER,
    PARK,
    BEND,       /* flexion to its middle */
    SEEK_AGAIN, /* the IP joint's lower end once more */
    PARK_AGAIN,
    UNBEND,
};

static int32_t designed_range(const struct hand_setup *setup, uint8_t joint)
{
    return setup->homing.upper[joint] - setup->homing.lower[joint];
}

static uint8_t first_of_finger(const struct hand_setup *setup, uint8_t joint)
{
    return (uint8_t)(joint / setup->transmission.group * setup->transmission.group);
}

/* Whether a joint is its finger's last, and its motor follows the first joint: the sign shows. */
static bool sign_shows(const struct hand_setup *setup, uint8_t joint)
{
    uint8_t group = setup->transmission.group;
    return group > 1 && joint % group == group - 1 && setup->transmission.gain[joint][0] != 0;
}

int32_t homing_shift(const struct homing *homing, const struct hand_setup *setup, uint8_t joint)
{
    int32_t designed = (setup->homing.lower[joint] + setup->homing.upper[joint]) / 2;
    return designed - (homing->lower[joint] + homing->upper[joint]) / 2;
}

uint8_t homing_found(const struct homing *homing, const struct hand_setup *setup)
{
    if (homing->outcome == HOMING_OUTCOME_FOUND) {
        return setup->joints;
    }
    return homing->outcome == HOMING_OUTCOME_NEVER ? 0 : homing->culprit;
}

/* The posture nearest to straight that the limits allow. */
static int32_t resting_place(const struct homing *homing, const struct hand_setup *setup, uint8_t joint)
{
    int32_t lower = setup->limits.lower[joint], upper = setup->limits.upper[joint];
    int32_t straight = lower > 0 ? lower : upper < 0 ? upper : 0;
    return straight - homing_shift(homing, setup, joint);
}

static void turn_to(
    struct homing *homing, enum step step, uint8_t moved, int32_t rate, const int32_t *measured)
{
    homing->step = step;
    homing->moved = moved;
    homing->rate = rate;
    homing->began = homing->furthest = measured[moved];
    homing->still_us = 0;
    if (step == SEEK_LOWER || step == SEEK_UPPER || step == SEEK_AGAIN) {
        homing->place[moved] = measured[moved]; /* leaves behind what pressed on the last end */
    }
}

static void search(
    struct homing *homing, const struct hand_setup *setup, uint8_t joint, const int32_t *measured)
{
    homing->culprit = joint;
    turn_to(homing, SEEK_LOWER, joint, -setup->homing.speed, measured);
}

void homing_begin(struct homing *homing, const struct hand_setup *setup, const int32_t *measured)
{
    memset(homing, 0, sizeof *homing);
    memcpy(homing->place, measured, sizeof homing->place);
    homing->outcome = HOMING_OUTCOME_SEARCHING;
    search(homing, setup, 0, measured);
}

static void fail(struct homing *homing, uint8_t outcome)
{
    homing->outcome = outcome;
    homing->rate = 0;
}

/* How long the moved joint has not come further. */
static void note_progress(struct homing *homing, const int32_t *measured, int32_t dt_us)
{
    int32_t further = measured[homing->moved] - homing->furthest;
    further = homing->rate < 0 ? -further : further;
    if (further > PROGRESS) {
        homing->furthest = measured[homing->moved];
        homing->still_us = 0;
    } else {
        homing->still_us += (uint32_t)dt_us;
    }
}

static void go_on(struct homing *homing, const int32_t *measured, int32_t dt_us)
{
    int32_t lead = homing->place[homing->moved] - measured[homing->moved];
    lead = homing->rate < 0 ? -lead : lead;
    if (lead < LEAD) {
        homing->place[homing->moved] += (int32_t)((int64_t)homing->rate * dt_us / US_PER_S);
    }
}

/* Move until an end is felt: true. An end that does not come is a failure. */
static bool end_is_felt(
    struct homing *homing, const struct hand_setup *setup, const int32_t *measured, int32_t dt_us)
{
    int32_t range = designed_range(setup, homing->moved);
    if (magnitude(measured[homing->moved] - homing->began) > range + range / 3) {
        fail(homing, HOMING_OUTCOME_NO_END);
        return false;
    }
    go_on(homing, measured, dt_us);
    return homing->still_us >= STALL_US;
}

/* Move to a place: true once there. What blocks the way back is no end of the joint. */
static bool has_arrived(
    struct homing *homing, int32_t goal, const int32_t *measured, int32_t dt_us)
{
    int32_t left = goal - homing->place[homing->moved], speed = magnitude(homing->rate);
    if (magnitude(left) <= (int32_t)((int64_t)speed * dt_us / US_PER_S)) {
        homing->place[homing->moved] = goal;
        homing->rate = 0;
        if (magnitude(measured[homing->moved] - goal) < ARRIVED) {
            return true;
        }
    } else {
        int32_t rate = left < 0 ? -speed : speed;
        if (rate != homing->rate) {
            homing->furthest = measured[homing->moved];
            homing->rate = rate;
        }
        go_on(homing, measured, dt_us);
    }
    if (homing->still_us >= BLOCKED_US) {
        fail(homing, HOMING_OUTCOME_WRONG_RANGE);
    }
    return false;
}

static void next_joint(
    struct homing *homing, const struct hand_setup *setup, const int32_t *measured)
{
    if (homing->culprit + 1 < setup->joints) {
        search(homing, setup, (uint8_t)(homing->culprit + 1), measured);
    } else {
        homing->outcome = HOMING_OUTCOME_FOUND;
        homing->rate = 0;
    }
}

static void upper_end_found(
    struct homing *homing, const struct hand_setup *setup, const int32_t *measured)
{
    uint8_t joint = homing->culprit;
    int32_t designed = designed_range(setup, joint);
    homing->upper[joint] = measured[joint];
    if (magnitude(homing->upper[joint] - homing->lower[joint] - designed) > designed / TOLERANCE_SHARE) {
        fail(homing, HOMING_OUTCOME_WRONG_RANGE);
    } else {
        turn_to(homing, PARK, joint, -setup->homing.speed, measured);
    }
}

static void end_found_again(
    struct homing *homing, const struct hand_setup *setup, const int32_t *measured)
{
    uint8_t joint = homing->culprit;
    int32_t moved = magnitude(measured[joint] - homing->lower[joint]);
    if (moved > designed_range(setup, joint) / TOLERANCE_SHARE) {
        fail(homing, HOMING_OUTCOME_WRONG_SIGN);
    } else {
        turn_to(homing, PARK_AGAIN, joint, setup->homing.speed, measured);
    }
}

static int32_t goal_of(const struct homing *homing, const struct hand_setup *setup)
{
    uint8_t joint = homing->moved;
    if (homing->step == BEND) {
        return (homing->lower[joint] + homing->upper[joint]) / 2;
    }
    return resting_place(homing, setup, joint);
}

static void place_reached(
    struct homing *homing, const struct hand_setup *setup, const int32_t *measured)
{
    uint8_t joint = homing->culprit, first = first_of_finger(setup, joint);
    int32_t speed = setup->homing.speed;
    if (homing->step == PARK && sign_shows(setup, joint)) {
        turn_to(homing, BEND, first, speed, measured);
    } else if (homing->step == BEND) {
        turn_to(homing, SEEK_AGAIN, joint, -speed, measured);
    } else if (homing->step == PARK_AGAIN) {
        turn_to(homing, UNBEND, first, -speed, measured);
    } else {
        next_joint(homing, setup, measured);
    }
}

static void end_reached(
    struct homing *homing, const struct hand_setup *setup, const int32_t *measured)
{
    if (homing->step == SEEK_LOWER) {
        homing->lower[homing->culprit] = measured[homing->culprit];
        turn_to(homing, SEEK_UPPER, homing->culprit, setup->homing.speed, measured);
    } else if (homing->step == SEEK_UPPER) {
        upper_end_found(homing, setup, measured);
    } else {
        end_found_again(homing, setup, measured);
    }
}

void homing_step(
    struct homing *homing, const struct hand_setup *setup, const int32_t *measured, int32_t dt_us)
{
    note_progress(homing, measured, dt_us);
    switch (homing->step) {
    case SEEK_LOWER:
    case SEEK_UPPER:
    case SEEK_AGAIN:
        if (end_is_felt(homing, setup, measured, dt_us)) {
            end_reached(homing, setup, measured);
        }
        return;
    default:
        if (has_arrived(homing, goal_of(homing, setup), measured, dt_us)) {
            place_reached(homing, setup, measured);
        }
    }
}
