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
    int32_t offset[MAX_JOINTS]; /* by design; homing and calibration find better ones */
};

/* How zeros are searched: end stops as designed, and how gently they are touched. */
struct homing_setup {
    int32_t lower[MAX_JOINTS]; /* the joints' end stops */
    int32_t upper[MAX_JOINTS];
    int32_t speed;      /* of the joint that is moved */
    int16_t current_ma; /* of one motor at most */
};

/* Preload of a grip: joint angle that the goals are put beyond the path. */
struct preload_setup {
    int32_t limit;
    int32_t rate; /* [1e-6 rad/s] */
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
    int16_t hold_ma;       /* of one motor while the hand holds; 0: as always */
    struct joint_limits limits;
    struct joint_limits motor_limits; /* of the motors, one a joint */
    struct transmission transmission;
    struct homing_setup homing;
    struct preload_setup preload;
};

#endif
