#include "bernstein.h"

/* Halving a curve brings its hull towards it, four times closer a step, so that this many leave
   less than a count in doubt. */
#define MAX_HALVINGS 14

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
bool bernstein_inside(const struct bernstein *whole, const struct bounds *bounds)
{
    if (hull_inside(whole, bounds)) {
        return true;
    }
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

void bernstein_of(const struct hermite *ends, struct bernstein *out)
{
    const int64_t *p = ends->position, *v = ends->velocity, *a = ends->acceleration;
    *out = (struct bernstein){
        .degree = 5,
        .at = {p[0], p[0] + v[0] / 5, p[0] + 2 * v[0] / 5 + a[0] / 20,
               p[1] - 2 * v[1] / 5 + a[1] / 20, p[1] - v[1] / 5, p[1]},
    };
}

void bernstein_differentiate(struct bernstein *curve)
{
    for (uint8_t i = 0; i < curve->degree; i++) {
        curve->at[i] = curve->degree * (curve->at[i + 1] - curve->at[i]);
    }
    curve->degree--;
}
