/* Feetech STS servos on one half-duplex line, as the motors of a hand.

   All goals go out in one packet; then each servo is asked for its state. At 1 Mbaud twelve take some
   5 ms, so ticks of 100 Hz suit. Torque comes on only after the goals have been read back. */
#ifndef SERVO_BUS_H
#define SERVO_BUS_H

#include "board.h"

struct bus_line {
    void *context;
    void (*transmit)(void *context, const uint8_t *bytes, uint8_t count);
    /* Bytes that came before `patience_us` passed without a new one; echoes are left out. */
    uint8_t (*receive)(void *context, uint8_t *bytes, uint8_t room, uint16_t patience_us);
};

struct servo_mount {
    uint8_t id;
    int8_t sign;  /* 1 or -1: whether it turns as the transmission says */
    int16_t zero; /* its steps where the motor's angle is 0 */
};

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
