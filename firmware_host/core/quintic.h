/* Quintic Hermite segments in fixed point: position, velocity, acceleration given at both ends.

   float holds 24 bits, which is not a count of 1e-6 rad beyond 16 rad and loses more on the way;
   here all is 64-bit integers with 20 bits below a count. */
#ifndef QUINTIC_H
#define QUINTIC_H

#include <stdint.h>

#include "messages.h"
#include "span.h"

/* Powers of s in [0, 1], fine counts. */
struct quintic {
    int64_t power[6];
};

struct motion {
    int32_t position;
    int32_t velocity;
    int32_t acceleration;
};

/* A knot's numbers at both ends, scaled to the segment: p, h v, h^2 a. */
struct hermite {
    int64_t position[2];
    int64_t velocity[2];
    int64_t acceleration[2];
};

/* One joint of the segment between two knots. */
void hermite_of(
    const struct knot *from, const struct knot *to, uint8_t joint, const struct span *span,
    struct hermite *out);
void quintic_of(const struct hermite *ends, struct quintic *out);

/* How far `elapsed_us` is into a segment, in 2^-32; its very end counts as one step less. */
uint32_t quintic_share(int32_t elapsed_us, int32_t duration_us);
/* Position and velocity alone take less time. */
enum detail { WITHOUT_ACCELERATION, WITH_ACCELERATION };
struct motion quintic_at(
    const struct quintic *quintic, uint32_t share, const struct span *span, enum detail detail);

#endif
