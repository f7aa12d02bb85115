/* What the core asks of a board: all that a port has to bring. */
#ifndef BOARD_H
#define BOARD_H

#include <stdbool.h>
#include <stdint.h>

#include "messages.h"

struct motor_goals {
    int32_t position[MAX_JOINTS]; /* [1e-6 rad] */
    int32_t velocity[MAX_JOINTS]; /* [1e-6 rad/s]; a servo that takes none ignores it */
    bool torque_on;               /* turned on only after the goals have arrived */
    int16_t current_ma;           /* of each motor at most; 0: as much as it can */
};

struct motor_readings {
    int32_t position[MAX_JOINTS];
    int16_t current_ma[MAX_JOINTS];
    int8_t temperature_c[MAX_JOINTS];
    bool answered[MAX_JOINTS];
};

struct board {
    void *context;
    /* Bytes for the host; all of them are taken. */
    void (*send)(void *context, const uint8_t *bytes, uint8_t count);
    /* Once a tick: goals to the motors, readings from them. What did not answer keeps its last. */
    void (*exchange)(
        void *context, const struct motor_goals *goals, struct motor_readings *readings);
    /* Emergency stop, called at receipt: no torque when it returns. */
    void (*torque_off)(void *context);
};

#endif
