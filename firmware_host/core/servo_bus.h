/* Feetech STS servos on one half-duplex line, as the motors of a hand.

   All goals go out in one packet; then each servo is asked for its state. At 1 Mbaud twelve take some
   5 ms, so ticks of 100 Hz suit. Torque comes on only after the goals have been read back. */
#ifndef SERVO_BUS_H
#define SERVO_BUS_H

#include "board.h"
#include "half_duplex.h"

struct servo_bus {
    const struct bus_line *line;
    uint8_t count;
    struct servo_mount mounts[MAX_JOINTS];
    bool torque_on;
};

/* Fits `board.exchange` with the bus as context; what does not answer keeps its last reading. */
void servo_bus_exchange(
    void *bus, const struct motor_goals *goals, struct motor_readings *readings);
/* Fits `board.torque_off`: one packet to all servos, sent twice since nobody answers it. */
void servo_bus_torque_off(void *bus);

#endif
