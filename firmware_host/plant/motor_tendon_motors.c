/* Simulated motors and tendons as the motors of a port. */
#include "motor_tendon.h"
#include "motors.h"

extern const struct hand_setup HAND_SETUP;
extern const float HAND_START_RAD[MAX_JOINTS];
extern const float HAND_ZERO_ERROR_RAD[MAX_JOINTS];

static struct plant plant;

void motors_start(void)
{
    real start[MAX_JOINTS];
    for (uint8_t i = 0; i < MAX_JOINTS; i++) {
        start[i] = HAND_START_RAD[i];
    }
    plant_rest_at(&plant, &HAND_SETUP, start);
    for (uint8_t i = 0; i < HAND_SETUP.joints; i++) {
        plant_misplace_zero(&plant, i, HAND_ZERO_ERROR_RAD[i]);
    }
}

void motors_exchange(
    void *context, const struct motor_goals *goals, struct motor_readings *readings)
{
    (void)context;
    plant_step(&plant, goals, (uint16_t)(1000 / HAND_SETUP.tick_hz));
    plant_read(&plant, readings);
}

void motors_torque_off(void *context)
{
    (void)context;
    plant.torque_on = false;
}
