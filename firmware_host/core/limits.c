#include "limits.h"

#include <stdbool.h>

#include "fixed.h"
#include "quintic.h"

/* A polynomial lies in the hull of its Bernstein coefficients. Halving it brings the hull towards
   it, four times closer a step, so that this many leave less than a count in doubt. */
#define MAX_HALVINGS 14

struct bernstein {
    uint8_t degree;
    uint8_t halvings;
    int64_t at[6];
};

struct bounds {
    int64_t lower;
    int64_t upper;
};

static bool outside(int64_t value, const struct bounds *bounds)
{
    return value < bounds->lower || value > bounds->upper;
}

static bool hull_inside(const struct bernstein *curve, const struct bounds *bounds)
{
    for (uint8_t i = 0; i <= curve->degree; i++) {
        if (outside(curve->at[i], bounds)) {
            return false;
        }
    }
    return true;
}

/* De Casteljau at one half: `curve` becomes its first half, `second` the rest. */
static void halve(struct bernstein *curve, struct bernstein *second)
{
    curve->halvings++;
    *second = *curve;
    for (uint8_t round = 1; round <= curve->degree; round++) {
        for (uint8_t i = curve->degree; i >= round; i--) {
            curve->at[i] = (curve->at[i - 1] + curve->at[i]) >> 1;
        }
        second->at[curve->degree - round] = curve->at[curve->degree];
    }
}

/* Depth first over halves with a stack of its own: no recursion, bounded memory and time. */
static bool inside(const struct bernstein *whole, const struct bounds *bounds)
{
    struct bernstein waiting[MAX_HALVINGS + 1];
    uint8_t count = 1;
    waiting[0] = *whole;
    while (count > 0) {
        struct bernstein *top = &waiting[count - 1];
        if (hull_inside(top, bounds)) {
            count--;
        } else if (
            outside(top->at[0], bounds) || outside(top->at[top->degree], bounds) ||
            top->halvings == MAX_HALVINGS) {
            return false;
        } else {
            halve(top, &waiting[count]);
            count++;
        }
    }
    return true;
}

static void position_curve(const struct hermite *ends, struct bernstein *out)
{
    const int64_t *p = ends->position, *v = ends->velocity, *a = ends->acceleration;
    *out = (struct bernstein){
        .degree = 5,
        .at = {p[0], p[0] + v[0] / 5, p[0] + 2 * v[0] / 5 + a[0] / 20,
               p[1] - 2 * v[1] / 5 + a[1] / 20, p[1] - v[1] / 5, p[1]},
    };
}

/* The derivative by s. */
static void differentiate(struct bernstein *curve)
{
    for (uint8_t i = 0; i < curve->degree; i++) {
        curve->at[i] = curve->degree * (curve->at[i + 1] - curve->at[i]);
    }
    curve->degree--;
}

/* Limits as seen in derivatives by s, widened by what rounding knots to counts can do: half a count
   at both ends of each number times the largest basis functions' derivatives. */
struct slack {
    int64_t of_order[3];
};

static struct slack slack_of(const struct span *span)
{
    int64_t one = to_fine(1);
    int64_t h = span_times(span, one), hh = span_times(span, h);
    return (struct slack){{2 * one + h, 2 * one + 2 * h + hh, 6 * one + 6 * h + 2 * hh}};
}

static struct bounds bounds_of(
    uint8_t order, uint8_t joint, const struct span *span, const struct joint_limits *limits)
{
    if (order == 0) {
        return (struct bounds){to_fine(limits->lower[joint]), to_fine(limits->upper[joint])};
    }
    int64_t limit = to_fine(order == 1 ? limits->velocity[joint] : limits->acceleration[joint]);
    limit = span_times(span, limit);
    if (order == 2) {
        limit = span_times(span, limit);
    }
    return (struct bounds){-limit, limit};
}

/* The first order in which a joint leaves its limits: position, velocity, acceleration, none. */
static uint8_t first_order_outside(
    const struct hermite *ends, uint8_t joint, const struct span *span, const struct slack *slack,
    const struct joint_limits *limits)
{
    struct bernstein curve;
    position_curve(ends, &curve);
    for (uint8_t order = 0; order < 3; order++) {
        struct bounds bounds = bounds_of(order, joint, span, limits);
        bounds.lower -= slack->of_order[order];
        bounds.upper += slack->of_order[order];
        if (!inside(&curve, &bounds)) {
            return order;
        }
        differentiate(&curve);
    }
    return 3;
}

struct violation segment_violation(
    const struct knot *from, const struct knot *to, uint8_t joints,
    const struct joint_limits *limits)
{
    if (to->t_us - from->t_us < SHORTEST_SEGMENT_US || to->t_us - from->t_us > LONGEST_SEGMENT_US) {
        return (struct violation){REASON_SEGMENT_TIME, 0};
    }
    struct span span = span_of((int32_t)(to->t_us - from->t_us));
    struct slack slack = slack_of(&span);
    uint8_t worst = 3, culprit = 0;
    for (uint8_t joint = 0; joint < joints; joint++) {
        struct hermite ends;
        hermite_of(from, to, joint, &span, &ends);
        uint8_t order = first_order_outside(&ends, joint, &span, &slack, limits);
        if (order < worst) {
            worst = order;
            culprit = joint;
        }
    }
    return (struct violation){worst < 3 ? (uint8_t)(REASON_POSITION_LIMIT + worst) : 0, culprit};
}
