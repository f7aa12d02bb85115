/* Motors that are at their goal one tick later, unless an end stop of a joint holds them: what homing
   needs on targets too slow to simulate a hand. */
#include <string.h>

#include "motors.h"
#include "transmission.h"

extern const struct hand_setup HAND_SETUP;
extern const float HAND_START_RAD[MAX_JOINTS];
extern const float HAND_ZERO_ERROR_RAD[MAX_JOINTS];

static int32_t zero[MAX_JOINTS]; /* where the motors' zeros truly are */
static int32_t position[MAX_JOINTS];

void motors_start(void)
{
    int32_t joint[MAX_JOINTS];
    for (uint8_t i = 0; i < MAX_JOINTS; i++) {
        joint[i] = (int32_t)(HAND_START_RAD[i] * 1e6f);
        zero[i] = HAND_SETUP.transmission.offset[i] + (int32_t)(HAND_ZERO_ERROR_RAD[i] * 1e6f);
    }
    motors_of(&HAND_SETUP.transmission, HAND_SETUP.joints, zero, joint, position);
}

static void turn_to(const int32_t *goal)
{
    int32_t joint[MAX_JOINTS];
    joints_of(&HAND_SETUP.transmission, HAND_SETUP.joints, zero, goal, joint);
    for (uint8_t i = 0; i < HAND_SETUP.joints; i++) {
        if (joint[i] < HAND_SETUP.homing.lower[i]) {
            joint[i] = HAND_SETUP.homing.lower[i];
        }
        if (joint[i] > HAND_SETUP.homing.upper[i]) {
            joint[i] = HAND_SETUP.homing.upper[i];
        }
    }
    motors_of(&HAND_SETUP.transmission, HAND_SETUP.joints, zero, joint, position);
}

void motors_exchange(
    void *context, const struct motor_goals *goals, struct motor_readings *readings)
{
    (void)context;
    if (goals->torque_on) {
        turn_to(goals->position);
    }
    memcpy(readings->position, position, sizeof position);
    for (uint8_t i = 0; i < HAND_SETUP.joints; i++) {
        readings->current_ma[i] = 0;
        readings->temperature_c[i] = 25;
        readings->answered[i] = true;
    }
}

void motors_torque_off(void *context)
{
    (void)context;
}
