#include "quintic.h"

#include "fixed.h"

void hermite_of(
    const struct knot *from, const struct knot *to, uint8_t joint, const struct span *span,
    struct hermite *out)
{
    const struct knot *ends[2] = {from, to};
    for (uint8_t end = 0; end < 2; end++) {
        const struct knot *knot = ends[end];
        int64_t velocity = to_fine(knot->velocity_urad_s[joint]);
        int64_t acceleration = to_fine(knot->acceleration_urad_s2[joint]);
        out->position[end] = to_fine(knot->position_urad[joint]);
        out->velocity[end] = span_times(span, velocity);
        out->acceleration[end] = span_times(span, span_times(span, acceleration));
    }
}

void quintic_of(const struct hermite *ends, struct quintic *out)
{
    int64_t way = ends->position[1] - ends->position[0];
    const int64_t *v = ends->velocity, *a = ends->acceleration;
    out->power[0] = ends->position[0];
    out->power[1] = v[0];
    out->power[2] = a[0] / 2;
    out->power[3] = 10 * way - 6 * v[0] - 4 * v[1] - (3 * a[0] - a[1]) / 2;
    out->power[4] = -15 * way + 8 * v[0] + 7 * v[1] + (3 * a[0] - 2 * a[1]) / 2;
    out->power[5] = 6 * way - 3 * v[0] - 3 * v[1] - (a[0] - a[1]) / 2;
}

uint32_t quintic_share(int32_t elapsed_us, int32_t duration_us)
{
    if (elapsed_us >= duration_us) {
        return UINT32_MAX;
    }
    return (uint32_t)(((uint64_t)elapsed_us << 32) / (uint32_t)duration_us);
}

/* Horner's scheme for the `order`-th derivative by s. */
static int64_t derivative(const struct quintic *quintic, uint8_t order, uint32_t share)
{
    static const uint8_t FACTOR[3][6] = {{1, 1, 1, 1, 1, 1}, {0, 1, 2, 3, 4, 5}, {0, 0, 2, 6, 12, 20}};
    int64_t sum = 0;
    for (uint8_t k = 5; k > order; k--) {
        sum = times_share(sum + FACTOR[order][k] * quintic->power[k], share);
    }
    return sum + FACTOR[order][order] * quintic->power[order];
}

struct motion quintic_at(
    const struct quintic *quintic, uint32_t share, const struct span *span, enum detail detail)
{
    struct motion motion = {
        .position = to_counts(derivative(quintic, 0, share)),
        .velocity = to_counts(span_per(span, derivative(quintic, 1, share))),
    };
    if (detail == WITH_ACCELERATION) {
        int64_t acceleration = span_per(span, derivative(quintic, 2, share));
        motion.acceleration = to_counts(span_per(span, acceleration));
    }
    return motion;
}
