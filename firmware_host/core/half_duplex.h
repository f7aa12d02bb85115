/* The one wire on which servos are asked and answer, and how they sit on it. */
#ifndef HALF_DUPLEX_H
#define HALF_DUPLEX_H

#include <stdint.h>

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

#endif
