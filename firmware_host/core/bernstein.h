/* Polynomials of one variable s in [0, 1] by their Bernstein coefficients: they lie in the hull of
   these, so that bounds can be proven by comparing numbers. */
#ifndef BERNSTEIN_H
#define BERNSTEIN_H

#include <stdbool.h>
#include <stdint.h>

#include "quintic.h"

struct bernstein {
    uint8_t degree;
    uint8_t halvings;
    int64_t at[6]; /* fine counts */
};

struct bounds {
    int64_t lower;
    int64_t upper;
};

/* The position of one joint of a segment. */
void bernstein_of(const struct hermite *ends, struct bernstein *out);
/* The derivative by s. */
void bernstein_differentiate(struct bernstein *curve);
/* Whether the curve stays within the bounds for all s; in doubt below a count it does not. */
bool bernstein_inside(const struct bernstein *curve, const struct bounds *bounds);

#endif
