/* The motors of a port: a servo bus on a real board, simulated ones elsewhere. */
#ifndef MOTORS_H
#define MOTORS_H

#include "board.h"

void motors_start(void);
void motors_exchange(
    void *context, const struct motor_goals *goals, struct motor_readings *readings);
void motors_torque_off(void *context);

#endif
