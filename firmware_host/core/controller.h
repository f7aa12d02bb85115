/* The controller: bytes and ticks go in, bytes and goals come out through the board. */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "board.h"
#include "follower.h"
#include "framing.h"
#include "guard.h"
#include "homing.h"
#include "sequence.h"
#include "watchdog.h"

struct controller {
    const struct hand_setup *setup;
    const struct board *board;
    uint8_t state;
    uint8_t cause;
    bool torque_on;
    bool homed;
    uint64_t time_us;
    uint64_t start_us;
    int32_t offset[MAX_JOINTS];   /* the motors' zeros in use */
    int32_t goal[MAX_JOINTS];     /* of the motors, without preload */
    int32_t told[MAX_JOINTS];     /* what the motors were told: the same with preload */
    int32_t measured[MAX_JOINTS]; /* joints, from the motors' encoders */
    struct motor_readings readings;
    struct follower follower;
    struct homing homing;
    struct guard guard;
    struct watchdog watchdog;
    struct frame_reader reader;
    uint16_t session; /* 0: none */
    struct sequence sequence;
    struct refused refusal; /* stands for the rest of the session once command is not 0 */
    uint16_t gaps;
};

void controller_boot(
    struct controller *controller, const struct hand_setup *setup, const struct board *board);
void controller_receive(struct controller *controller, uint8_t byte);
void controller_tick(struct controller *controller);
/* Take motor zeros (joints of them) into use; the goal becomes where the joints are. */
void controller_set_zeros(struct controller *controller, const int32_t *offset);

#endif
