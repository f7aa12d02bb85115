/* Guards the motors: following, current, temperature, answering. */
#ifndef GUARD_H
#define GUARD_H

#include "board.h"
#include "follower.h"

/* Ticks in a row that a fault must last, so that one bad reading stops nothing. */
#define GUARD_TICKS 2

struct guard {
    uint8_t current_ticks[MAX_JOINTS];
    uint8_t temperature_ticks[MAX_JOINTS];
    uint8_t absent_ticks[MAX_JOINTS];
};

/* A cause of FAULT, or CAUSE_NONE. */
uint8_t guard_motors(
    struct guard *guard, const struct hand_setup *setup, const struct motor_readings *readings);
uint8_t guard_tracking(const struct follower *follower, const int32_t *measured);

#endif
