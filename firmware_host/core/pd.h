/* A motor's position controller: proportional and derivative, with a limited torque. */
#ifndef PD_H
#define PD_H

#include <stdint.h>

struct pd {
    int32_t stiffness;    /* [1e-6 N m / rad] */
    int32_t damping;      /* [1e-6 N m s / rad] */
    int32_t torque_limit; /* [1e-6 N m] */
};

/* Torque [1e-6 N m] from errors of position [1e-6 rad] and velocity [1e-6 rad/s]. */
int32_t pd_torque(const struct pd *pd, int32_t position_error, int32_t velocity_error);

#endif
