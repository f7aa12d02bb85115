#include "telemetry.h"

#include <string.h>

#include "link.h"

#define PERIOD_US 20000
#define HEALTH_PERIOD_US 100000

static void send_telemetry(struct controller *controller)
{
    const struct follower *follower = &controller->follower;
    struct telemetry telemetry = {
        .device_us = controller->time_us,
        .path_us = (uint64_t)follower_path_us(follower),
        .state = controller->state,
        .cause = controller->cause,
        .rate_permille = (uint16_t)(((int64_t)follower->rate * 1000 + FULL_RATE / 2) >> 30),
        .queued_knots = follower->queued,
        .bad_frames = controller->reader.bad_frames,
    };
    /* Without torque the hand goes where it is put, and so does the goal. */
    const int32_t *goal = controller->torque_on ? follower->command : controller->measured;
    memcpy(telemetry.position_urad, controller->measured, sizeof telemetry.position_urad);
    memcpy(telemetry.command_urad, goal, sizeof telemetry.command_urad);
    uint8_t payload[MAX_PAYLOAD];
    uint8_t length = encode_telemetry(&telemetry, controller->setup->joints, payload);
    link_send(controller, MESSAGE_TELEMETRY, controller->session, payload, length);
}

static void send_health(struct controller *controller)
{
    const struct motor_readings *readings = &controller->readings;
    struct health health = {.device_us = controller->time_us, .gaps = controller->gaps};
    memcpy(health.current_ma, readings->current_ma, sizeof health.current_ma);
    memcpy(health.temperature_c, readings->temperature_c, sizeof health.temperature_c);
    for (uint8_t i = 0; i < controller->setup->joints; i++) {
        health.preload_20urad[i] = (int16_t)(controller->follower.preload[i] / PRELOAD_URAD);
    }
    uint8_t payload[MAX_PAYLOAD];
    uint8_t length = encode_health(&health, controller->setup->joints, payload);
    link_send(controller, MESSAGE_HEALTH, controller->session, payload, length);
}

void telemetry_send_if_due(struct controller *controller)
{
    if (controller->session == 0) {
        return;
    }
    uint32_t phase = (uint32_t)(controller->time_us % HEALTH_PERIOD_US);
    if (phase % PERIOD_US == 0) {
        send_telemetry(controller);
    }
    if (phase == 0) {
        send_health(controller);
    }
}
