/* The tendon-pulley differential: joints to motors and back. */
#ifndef TRANSMISSION_H
#define TRANSMISSION_H

#include "hand_setup.h"

#define GAIN_BITS 24

void motors_of(
    const struct transmission *transmission, uint8_t joints, const int32_t *joint, int32_t *motor);
void joints_of(
    const struct transmission *transmission, uint8_t joints, const int32_t *motor, int32_t *joint);
/* As motors_of, for velocities: without the offset. */
void motor_rates_of(
    const struct transmission *transmission, uint8_t joints, const int32_t *rate, int32_t *motor);

#endif
