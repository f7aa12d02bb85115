/* What a controller is set up with for one hand. All angles in 1e-6 rad, gains in 2^-24. */
#ifndef HAND_SETUP_H
#define HAND_SETUP_H

#include <stdbool.h>
#include <stdint.h>

#include "messages.h"

/* Joints that share motors: a finger's. The transmission couples nothing beyond them. */
#define MAX_GROUP 4

struct joint_limits {
    int32_t lower[MAX_JOINTS];
    int32_t upper[MAX_JOINTS];
    int32_t velocity[MAX_JOINTS];
    int32_t acceleration[MAX_JOINTS];
};

/* motor = gain * joint + offset, in blocks of `group` joints; inverse: joint = inverse * (...). */
struct transmission {
    uint8_t group;
    int32_t gain[MAX_JOINTS][MAX_GROUP];
    int32_t inverse[MAX_JOINTS][MAX_GROUP];
    int32_t offset[MAX_JOINTS];
};

struct hand_setup {
    uint8_t joints;
    bool homed; /* whether the motors' zeros are known at power-on */
    uint8_t protocol;
    uint16_t tick_hz; /* divides 1e6 */
    uint16_t buffer_knots;
    uint32_t boot_nonce;
    uint64_t configuration; /* hash that the host compares */
    uint8_t build[16];
    uint32_t silence_us;
    int32_t tracking_error;
    int16_t current_ma;    /* of one motor; 0: not guarded */
    int8_t temperature_c;  /* of one motor; 0: not guarded */
    struct joint_limits limits;
    struct transmission transmission;
};

#endif
