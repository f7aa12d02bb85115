/* Motors that are at their goal one tick later: for targets too slow to simulate a hand. */
#include "motors.h"
#include "transmission.h"

extern const struct hand_setup HAND_SETUP;
extern const float HAND_START_RAD[MAX_JOINTS];

static int32_t position[MAX_JOINTS];

void motors_start(void)
{
    int32_t joint[MAX_JOINTS];
    for (uint8_t i = 0; i < MAX_JOINTS; i++) {
        joint[i] = (int32_t)(HAND_START_RAD[i] * 1e6f);
    }
    motors_of(
        &HAND_SETUP.transmission, HAND_SETUP.joints, HAND_SETUP.transmission.offset, joint, position);
}

void motors_exchange(
    void *context, const struct motor_goals *goals, struct motor_readings *readings)
{
    (void)context;
    for (uint8_t i = 0; i < HAND_SETUP.joints; i++) {
        if (goals->torque_on) {
            position[i] = goals->position[i];
        }
        readings->position[i] = position[i];
        readings->current_ma[i] = 0;
        readings->temperature_c[i] = 25;
        readings->answered[i] = true;
    }
}

void motors_torque_off(void *context)
{
    (void)context;
}
