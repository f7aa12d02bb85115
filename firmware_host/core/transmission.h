/* The tendon-pulley differential: joints to motors and back. `offset`: the motors' zeros in use, as
   homing found them, the host remembers them, or the setup has them. */
#ifndef TRANSMISSION_H
#define TRANSMISSION_H

#include "hand_setup.h"

#define GAIN_BITS 24

void motors_of(
    const struct transmission *transmission, uint8_t joints, const int32_t *offset,
    const int32_t *joint, int32_t *motor);
void joints_of(
    const struct transmission *transmission, uint8_t joints, const int32_t *offset,
    const int32_t *motor, int32_t *joint);
/* As motors_of, for velocities: without the offset. */
void motor_rates_of(
    const struct transmission *transmission, uint8_t joints, const int32_t *rate, int32_t *motor);
/* A fine number times a gain; |value| < 2^58. */
int64_t times_gain(int64_t value, int32_t gain);

#endif
