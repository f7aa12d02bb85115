#include "follower.h"

#include <string.h>

#include "fixed.h"

#define START_DISTANCE 34906     /* 2 degrees */
#define STARVING_US 200000       /* enough to slow down on */
#define FASTEST_BRAKING 20       /* loss of rate a second: from full speed to rest in 50 ms */
#define BRAKING_BITS 16
#define PRELOAD_STEP 2000         /* a preload that counts as unchanged */

static const struct knot *knot_at(const struct follower *follower, uint16_t place)
{
    return &follower->queue[(follower->first + place) % QUEUE_KNOTS];
}

static const struct knot *last_knot(const struct follower *follower)
{
    return knot_at(follower, (uint16_t)(follower->queued - 1));
}

static bool at_rest(const struct knot *knot, uint8_t joints)
{
    for (uint8_t i = 0; i < joints; i++) {
        if (knot->velocity_urad_s[i] != 0 || knot->acceleration_urad_s2[i] != 0) {
            return false;
        }
    }
    return true;
}

void follower_forget(struct follower *follower)
{
    follower->first = follower->queued = 0;
    follower->accepted = 0;
    follower->span.us = 0;
    follower->path = 0;
    follower->rate = 0;
    follower->stopping = follower->ended = false;
    memset(follower->command_velocity, 0, sizeof follower->command_velocity);
}

void follower_rest_at(struct follower *follower, const int32_t *position)
{
    follower_forget(follower);
    memmove(follower->command, position, sizeof follower->command);
    memset(follower->preload, 0, sizeof follower->preload);
}

/* Distance of `value` from the stretch between 0 and `preload`. */
static int64_t beyond_preload(int64_t value, int32_t preload)
{
    int64_t lower = preload < 0 ? preload : 0, upper = preload < 0 ? 0 : preload;
    return value < lower ? lower - value : value > upper ? value - upper : 0;
}

int32_t follower_error(const struct follower *follower, uint8_t joint, int32_t measured)
{
    int64_t ahead = (int64_t)measured - follower->command[joint];
    int64_t error = beyond_preload(ahead, follower->preload[joint]);
    return error > INT32_MAX ? INT32_MAX : (int32_t)error;
}

int64_t follower_path_us(const struct follower *follower)
{
    return (follower->path + ((int32_t)1 << 15)) >> 16;
}

int64_t follower_queued_us(const struct follower *follower)
{
    if (follower->queued == 0) {
        return 0;
    }
    return (int64_t)last_knot(follower)->t_us - follower_path_us(follower);
}

uint16_t follower_free(const struct follower *follower)
{
    return (uint16_t)(follower->setup->buffer_knots - follower->queued);
}

bool follower_starving(const struct follower *follower)
{
    return !follower->ended && follower_queued_us(follower) < STARVING_US;
}

bool follower_arrived(const struct follower *follower)
{
    return follower->ended && follower_queued_us(follower) <= 0;
}

static int32_t preload_of(const struct knot *knot, uint8_t joint)
{
    return (int32_t)knot->preload_20urad[joint] * PRELOAD_URAD;
}

/* Whether the preload keeps to its bound and comes no faster than `change` from where it was. */
static struct violation preload_refusal(
    const struct follower *follower, const struct knot *knot, const int32_t *before, int64_t change)
{
    for (uint8_t i = 0; i < follower->setup->joints; i++) {
        int64_t step = (int64_t)preload_of(knot, i) - before[i];
        if (magnitude(preload_of(knot, i)) > follower->setup->preload.limit || step > change ||
            step < -change) {
            return (struct violation){REASON_PRELOAD_LIMIT, i};
        }
    }
    return (struct violation){0, 0};
}

static struct violation first_refusal(
    const struct follower *follower, const struct knot *knot, const int32_t *present)
{
    uint8_t joints = follower->setup->joints, worst = 0;
    int64_t farthest = 0;
    if (knot->t_us != 0) {
        return (struct violation){REASON_TIME_NOT_INCREASING, 0};
    }
    if (!at_rest(knot, joints)) {
        return (struct violation){REASON_NOT_AT_REST, 0};
    }
    for (uint8_t i = 0; i < joints; i++) {
        int64_t ahead = (int64_t)present[i] - knot->position_urad[i];
        int64_t distance = beyond_preload(ahead, follower->preload[i]);
        if (distance > farthest) {
            farthest = distance;
            worst = i;
        }
    }
    if (farthest > START_DISTANCE) {
        return (struct violation){REASON_TOO_FAR_FROM_START, worst};
    }
    /* A grip that is held may go on, but it must not jump. */
    return preload_refusal(follower, knot, follower->preload, PRELOAD_STEP);
}

static struct violation next_refusal(const struct follower *follower, const struct knot *knot)
{
    const struct knot *last = last_knot(follower);
    if (knot->t_us <= last->t_us) {
        return (struct violation){REASON_TIME_NOT_INCREASING, 0};
    }
    if (knot->t_us <= (uint64_t)follower_path_us(follower)) {
        return (struct violation){REASON_LATE, 0};
    }
    struct violation found = segment_violation(last, knot, follower->setup, follower->offset);
    if (found.reason != 0) {
        return found;
    }
    int32_t before[MAX_JOINTS];
    for (uint8_t i = 0; i < follower->setup->joints; i++) {
        before[i] = preload_of(last, i);
    }
    /* The segment's time is checked by now, so that this fits. */
    int64_t change = (int64_t)(knot->t_us - last->t_us) * follower->setup->preload.rate / US_PER_S;
    return preload_refusal(follower, knot, before, change + PRELOAD_URAD);
}

struct violation follower_offer(
    struct follower *follower, const struct knot *knot, const int32_t *present)
{
    struct violation refusal = {0, 0};
    if (follower->ended) {
        refusal.reason = REASON_KNOT_COUNT;
    } else if (follower_free(follower) == 0) {
        refusal.reason = REASON_BUFFER_FULL;
    } else if (follower->queued == 0) {
        refusal = first_refusal(follower, knot, present);
    } else {
        refusal = next_refusal(follower, knot);
    }
    if (refusal.reason == 0) {
        follower->queue[(follower->first + follower->queued) % QUEUE_KNOTS] = *knot;
        follower->queued++;
        follower->accepted++;
    }
    return refusal;
}

uint8_t follower_end(struct follower *follower, uint32_t count)
{
    if (count != follower->accepted || follower->queued < 2) {
        return REASON_KNOT_COUNT;
    }
    if (!at_rest(last_knot(follower), follower->setup->joints)) {
        return REASON_NOT_AT_REST;
    }
    follower->ended = true;
    return 0;
}

void follower_start(struct follower *follower)
{
    follower->rate = FULL_RATE;
}

void follower_stop(struct follower *follower)
{
    follower->stopping = true;
}

static void enter_segment(struct follower *follower)
{
    while (follower->queued > 2 && knot_at(follower, 1)->t_us <= (uint64_t)(follower->path >> 16)) {
        follower->first = (uint16_t)((follower->first + 1) % QUEUE_KNOTS);
        follower->queued--;
        follower->span.us = 0;
    }
    if (follower->span.us != 0) {
        return;
    }
    const struct knot *from = knot_at(follower, 0), *to = knot_at(follower, 1);
    follower->span = span_of((int32_t)(to->t_us - from->t_us));
    for (uint8_t i = 0; i < follower->setup->joints; i++) {
        struct hermite ends;
        hermite_of(from, to, i, &follower->span, &ends);
        quintic_of(&ends, &follower->segment[i]);
    }
}

/* Where the last knot's velocity leads when the path is used up while braking. */
static struct motion beyond(const struct follower *follower, uint8_t joint, int64_t late_us)
{
    const struct knot *last = knot_at(follower, 1);
    struct motion motion = {.position = last->position_urad[joint]};
    if (!follower->ended) {
        motion.velocity = last->velocity_urad_s[joint];
        motion.position += (int32_t)(motion.velocity * late_us / US_PER_S);
    }
    return motion;
}

/* Motion of all joints by path time, at the present place. */
static void sample(struct follower *follower, struct motion *motion, enum detail detail)
{
    enter_segment(follower);
    int64_t elapsed = (follower->path >> 16) - (int64_t)knot_at(follower, 0)->t_us;
    int64_t late = elapsed - follower->span.us;
    uint32_t share = late > 0 ? 0 : quintic_share((int32_t)elapsed, follower->span.us);
    for (uint8_t i = 0; i < follower->setup->joints; i++) {
        motion[i] = late > 0 ? beyond(follower, i, late)
                             : quintic_at(&follower->segment[i], share, &follower->span, detail);
    }
}

/* Preload goes straight from knot to knot, and stays where the path is used up. */
static void follow_preload(struct follower *follower)
{
    const struct knot *from = knot_at(follower, 0), *to = knot_at(follower, 1);
    int64_t elapsed = (follower->path >> 16) - (int64_t)from->t_us;
    elapsed = elapsed > follower->span.us ? follower->span.us : elapsed;
    for (uint8_t i = 0; i < follower->setup->joints; i++) {
        int32_t start = preload_of(from, i);
        int64_t way = preload_of(to, i) - start;
        follower->preload[i] = start + (int32_t)(way * elapsed / follower->span.us);
    }
}

static int32_t times_rate(int32_t value, int32_t rate)
{
    return (int32_t)((int64_t)value * rate >> 30);
}

/* Fastest loss of rate that keeps |q'' rate^2 + q' rate'| within the limits [2^-16 / s]. */
static int32_t braking(struct follower *follower)
{
    int64_t strongest = (int64_t)FASTEST_BRAKING << BRAKING_BITS;
    int32_t rate = follower->rate;
    struct motion motions[MAX_JOINTS];
    sample(follower, motions, WITH_ACCELERATION);
    for (uint8_t i = 0; i < follower->setup->joints; i++) {
        struct motion motion = motions[i];
        if (motion.velocity == 0) {
            continue;
        }
        int32_t bend = times_rate(times_rate(motion.acceleration, rate), rate);
        int64_t spare = follower->setup->limits.acceleration[i];
        spare += motion.velocity > 0 ? bend : -(int64_t)bend;
        int64_t own = spare * ((int32_t)1 << BRAKING_BITS) / magnitude(motion.velocity);
        strongest = own < strongest ? own : strongest;
    }
    return strongest < 0 ? 0 : (int32_t)strongest;
}

void follower_step(struct follower *follower, int32_t dt_us)
{
    int32_t rate = follower->rate;
    if (rate == 0) {
        return;
    }
    if (follower->stopping) {
        int64_t loss = (int64_t)braking(follower) * dt_us / US_PER_S * ((int32_t)1 << (30 - BRAKING_BITS));
        rate = loss < rate ? (int32_t)(rate - loss) : 0;
    }
    follower->path += (((int64_t)follower->rate + rate) / 2 * dt_us) >> 14;
    follower->rate = rate;
    struct motion motions[MAX_JOINTS];
    sample(follower, motions, WITHOUT_ACCELERATION);
    for (uint8_t i = 0; i < follower->setup->joints; i++) {
        follower->command[i] = motions[i].position;
        follower->command_velocity[i] = times_rate(motions[i].velocity, rate);
    }
    follow_preload(follower);
    if (follower_arrived(follower)) {
        follower->rate = 0;
    }
}
