/* Dynamixel XL330 and XC330 servos on one half-duplex line, as the motors of a hand.

   They run in current-based position mode: a goal, and a bound on the current that pulls there. All
   goals go out in one packet, all states come back after one question. The servos' own watchdog is
   set, so that they stop when this controller falls silent. */
#ifndef DYNAMIXEL_BUS_H
#define DYNAMIXEL_BUS_H

#include "board.h"
#include "half_duplex.h"

struct dynamixel_bus {
    const struct bus_line *line;
    uint8_t count;
    struct servo_mount mounts[MAX_JOINTS];
    int16_t full_ma;    /* the bound where the controller sets none */
    bool prepared;      /* mode and watchdog are set and have been read back */
    bool torque_on;
    int16_t bound_ma;   /* as last written; 0: not yet */
};

/* Fits `board.exchange` with the bus as context; what does not answer keeps its last reading. */
void dynamixel_bus_exchange(
    void *bus, const struct motor_goals *goals, struct motor_readings *readings);
/* Fits `board.torque_off`: one packet to all servos, sent twice since nobody answers it. */
void dynamixel_bus_torque_off(void *bus);

#endif
