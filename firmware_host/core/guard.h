/* Guards the motors: following, turning at all, current, temperature, answering. */
#ifndef GUARD_H
#define GUARD_H

#include "board.h"
#include "follower.h"

/* Ticks in a row that a fault must last, so that one bad reading stops nothing. */
#define GUARD_TICKS 2
/* Way of a goal that must move its motor by an encoder's step at least: 1.4 degrees. */
#define STANDSTILL 25000

struct guard {
    /* Each motor's reading when it last changed, and its goal at that time, without preload and with it. */
    int32_t still_reading[MAX_JOINTS];
    int32_t still_goal[MAX_JOINTS];
    int32_t still_told[MAX_JOINTS];
    uint8_t current_ticks[MAX_JOINTS];
    uint8_t temperature_ticks[MAX_JOINTS];
    uint8_t absent_ticks[MAX_JOINTS];
};

/* A cause of FAULT, or CAUSE_NONE. */
uint8_t guard_motors(
    struct guard *guard, const struct hand_setup *setup, const struct motor_readings *readings);
/* A reading that has not changed at all while its motor's goal has gone on: an encoder that stands still,
   or a motor that cannot turn. The goal without preload must have gone on, for preload may press against
   an end stop, and what the motor is told, for preload may make up for the path. For every tick of a run. */
uint8_t guard_standstill(
    struct guard *guard, uint8_t joints, const int32_t *reading, const int32_t *goal, const int32_t *told);
uint8_t guard_tracking(const struct follower *follower, const int32_t *measured);

#endif
