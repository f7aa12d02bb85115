#include "limits.h"

#include "bernstein.h"
#include "fixed.h"
#include "quintic.h"
#include "transmission.h"

#define ORDERS 3 /* position, velocity, acceleration */

/* Limits as seen in derivatives by s, widened by what rounding knots to counts can do: half a count
   at both ends of each number times the largest basis functions' derivatives. */
struct slack {
    int64_t of_order[ORDERS];
};

static struct slack slack_of(const struct span *span)
{
    int64_t one = to_fine(1);
    int64_t h = span_times(span, one), hh = span_times(span, h);
    return (struct slack){{2 * one + h, 2 * one + 2 * h + hh, 6 * one + 6 * h + 2 * hh}};
}

static struct bounds bounds_of(
    uint8_t order, uint8_t place, const struct span *span, const struct joint_limits *limits)
{
    if (order == 0) {
        return (struct bounds){to_fine(limits->lower[place]), to_fine(limits->upper[place])};
    }
    int64_t limit = to_fine(order == 1 ? limits->velocity[place] : limits->acceleration[place]);
    limit = span_times(span, limit);
    if (order == 2) {
        limit = span_times(span, limit);
    }
    return (struct bounds){-limit, limit};
}

/* The first order in which a curve leaves its limits, or ORDERS. */
static uint8_t first_order_outside(
    struct bernstein curve, uint8_t place, const struct span *span, const struct slack *slack,
    const struct joint_limits *limits)
{
    for (uint8_t order = 0; order < ORDERS; order++) {
        struct bounds bounds = bounds_of(order, place, span, limits);
        bounds.lower -= slack->of_order[order];
        bounds.upper += slack->of_order[order];
        if (!bernstein_inside(&curve, &bounds)) {
            return order;
        }
        bernstein_differentiate(&curve);
    }
    return ORDERS;
}

/* What a motor does while its finger's joints follow their curves. */
static struct bernstein motor_curve(
    const struct bernstein *joints, uint8_t motor, const struct transmission *transmission,
    int32_t offset)
{
    uint8_t group = transmission->group;
    struct bernstein curve = {.degree = 5};
    for (uint8_t i = 0; i <= curve.degree; i++) {
        curve.at[i] = to_fine(offset);
        for (uint8_t k = 0; k < group; k++) {
            curve.at[i] += times_gain(joints[motor / group * group + k].at[i], transmission->gain[motor][k]);
        }
    }
    return curve;
}

/* A count in each joint, as the motor sees them together. */
static struct slack motor_slack(
    const struct slack *slack, uint8_t motor, const struct transmission *transmission)
{
    int32_t sum = 0;
    for (uint8_t k = 0; k < transmission->group; k++) {
        sum += magnitude(transmission->gain[motor][k]);
    }
    struct slack result;
    for (uint8_t order = 0; order < ORDERS; order++) {
        result.of_order[order] = slack->of_order[order] + times_gain(slack->of_order[order], sum);
    }
    return result;
}

static struct violation worse(
    struct violation found, uint8_t order, uint8_t first_reason, uint8_t place)
{
    uint8_t reason = (uint8_t)(first_reason + order);
    if (order == ORDERS || (found.reason != 0 && found.reason <= reason)) {
        return found;
    }
    return (struct violation){reason, place};
}

struct violation segment_violation(
    const struct knot *from, const struct knot *to, const struct hand_setup *setup,
    const int32_t *offset)
{
    if (to->t_us - from->t_us < SHORTEST_SEGMENT_US || to->t_us - from->t_us > LONGEST_SEGMENT_US) {
        return (struct violation){REASON_SEGMENT_TIME, 0};
    }
    struct span span = span_of((int32_t)(to->t_us - from->t_us));
    struct slack slack = slack_of(&span);
    struct bernstein curves[MAX_JOINTS];
    struct violation found = {0, 0};
    for (uint8_t joint = 0; joint < setup->joints; joint++) {
        struct hermite ends;
        hermite_of(from, to, joint, &span, &ends);
        bernstein_of(&ends, &curves[joint]);
        uint8_t order = first_order_outside(curves[joint], joint, &span, &slack, &setup->limits);
        found = worse(found, order, REASON_POSITION_LIMIT, joint);
    }
    bool beyond_joints = found.reason != 0;
    /* Beyond the joints' limits a motor's curve says nothing, and could leave 64 bits. */
    for (uint8_t motor = 0; motor < setup->joints && !beyond_joints; motor++) {
        struct bernstein curve = motor_curve(curves, motor, &setup->transmission, offset[motor]);
        struct slack own = motor_slack(&slack, motor, &setup->transmission);
        uint8_t order = first_order_outside(curve, motor, &span, &own, &setup->motor_limits);
        found = worse(found, order, REASON_MOTOR_POSITION_LIMIT, motor);
    }
    return found;
}
