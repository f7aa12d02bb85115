#include "controller.h"

#include <string.h>

#include "commands.h"
#include "fixed.h"
#include "link.h"
#include "telemetry.h"
#include "transmission.h"

/* Homing touches gently, and a hand that only holds needs less than one that moves. */
static int16_t largest_current(const struct controller *controller)
{
    const struct hand_setup *setup = controller->setup;
    if (controller->state == STATE_HOMING) {
        return setup->homing.current_ma;
    }
    bool holds = controller->state == STATE_HOLD || controller->state == STATE_FAULT;
    return holds && controller->follower.rate == 0 ? setup->hold_ma : 0;
}

static void measure(struct controller *controller)
{
    const struct hand_setup *setup = controller->setup;
    joints_of(
        &setup->transmission, setup->joints, controller->offset, controller->readings.position,
        controller->measured);
}

static void exchange(struct controller *controller)
{
    const struct hand_setup *setup = controller->setup;
    const struct follower *follower = &controller->follower;
    struct motor_goals goals = {
        .torque_on = controller->torque_on, .current_ma = largest_current(controller)};
    const int32_t *place = follower->command, *rate = follower->command_velocity;
    int32_t searching[MAX_JOINTS] = {0}, stretch[MAX_JOINTS];
    if (controller->state == STATE_HOMING) {
        searching[controller->homing.moved] = controller->homing.rate;
        place = controller->homing.place;
        rate = searching;
    }
    motors_of(&setup->transmission, setup->joints, controller->offset, place, controller->goal);
    motor_rates_of(&setup->transmission, setup->joints, rate, goals.velocity);
    motor_rates_of(&setup->transmission, setup->joints, follower->preload, stretch);
    for (uint8_t i = 0; i < setup->joints; i++) {
        goals.position[i] = controller->told[i] = controller->goal[i] + stretch[i];
    }
    controller->board->exchange(controller->board->context, &goals, &controller->readings);
    measure(controller);
}

void controller_set_zeros(struct controller *controller, const int32_t *offset)
{
    memcpy(controller->offset, offset, controller->setup->joints * sizeof *offset);
    measure(controller);
    follower_rest_at(&controller->follower, controller->measured);
    controller->homed = true;
}

void controller_boot(
    struct controller *controller, const struct hand_setup *setup, const struct board *board)
{
    memset(controller, 0, sizeof *controller);
    controller->setup = setup;
    controller->board = board;
    controller->follower.setup = setup;
    controller->follower.offset = controller->offset;
    memcpy(controller->offset, setup->transmission.offset, sizeof controller->offset);
    controller->watchdog.patience_us = setup->silence_us;
    controller->homed = setup->homed;
    controller->state = setup->homed ? STATE_READY : STATE_IDLE;
    /* Torque stays off until it is known where the motors are: nothing jumps at power-on. */
    exchange(controller);
    follower_rest_at(&controller->follower, controller->measured);
    controller->torque_on = setup->homed;
}

void controller_receive(struct controller *controller, uint8_t byte)
{
    struct frame frame;
    if (frame_reader_take(&controller->reader, byte, &frame)) {
        link_take(controller, &frame);
    }
}

static void fault(struct controller *controller, uint8_t cause)
{
    command_stop(controller, STATE_FAULT, cause);
}

static void supervise(struct controller *controller)
{
    bool silent = watchdog_barks(&controller->watchdog, controller->time_us);
    uint8_t motors = guard_motors(&controller->guard, controller->setup, &controller->readings);
    if (motors != CAUSE_NONE && controller->state >= STATE_HOMING && controller->state <= STATE_HOLD) {
        if (controller->state == STATE_HOMING) {
            command_stop_homing(controller);
        }
        fault(controller, motors);
        return;
    }
    if (controller->state == STATE_HOMING && silent) {
        command_stop_homing(controller);
        controller->state = STATE_IDLE;
        controller->cause = CAUSE_SILENCE;
    }
    if (controller->state == STATE_ARMED && silent) {
        controller->state = STATE_READY;
    }
    if (controller->state != STATE_RUNNING) {
        return;
    }
    const struct follower *follower = &controller->follower;
    const int32_t *turned = controller->readings.position;
    if (guard_tracking(follower, controller->measured) != CAUSE_NONE ||
        guard_standstill(&controller->guard, controller->setup->joints, turned, controller->goal, controller->told) !=
            CAUSE_NONE) {
        fault(controller, CAUSE_TRACKING);
    } else if (follower_arrived(follower)) {
        controller->state = STATE_READY;
    } else if (silent) {
        command_stop(controller, STATE_HOLD, CAUSE_SILENCE);
    } else if (follower_starving(follower)) {
        command_stop(controller, STATE_HOLD, CAUSE_UNDERRUN);
    }
}

/* The zeros found are taken into use all at once, at the end. */
static void use_homing(struct controller *controller)
{
    const struct hand_setup *setup = controller->setup;
    int32_t shift[MAX_JOINTS], offset[MAX_JOINTS];
    for (uint8_t i = 0; i < setup->joints; i++) {
        shift[i] = homing_shift(&controller->homing, setup, i);
    }
    motor_rates_of(&setup->transmission, setup->joints, shift, offset);
    for (uint8_t i = 0; i < setup->joints; i++) {
        offset[i] = controller->offset[i] - offset[i];
        controller->homing.lower[i] += shift[i];
        controller->homing.upper[i] += shift[i];
    }
    controller_set_zeros(controller, offset);
    controller->state = STATE_READY;
}

static void home(struct controller *controller, int32_t tick_us)
{
    homing_step(&controller->homing, controller->setup, controller->measured, tick_us);
    if (controller->homing.outcome == HOMING_OUTCOME_FOUND) {
        use_homing(controller);
    } else if (controller->homing.outcome != HOMING_OUTCOME_SEARCHING) {
        controller->torque_on = false;
        follower_rest_at(&controller->follower, controller->measured);
        fault(controller, CAUSE_HOMING);
    }
}

void controller_tick(struct controller *controller)
{
    int32_t tick_us = US_PER_S / controller->setup->tick_hz;
    controller->time_us += (uint32_t)tick_us;
    if (controller->state == STATE_RUNNING && controller->follower.rate == 0 &&
        controller->time_us >= controller->start_us) {
        follower_start(&controller->follower);
    }
    follower_step(&controller->follower, tick_us);
    exchange(controller);
    if (controller->state == STATE_HOMING) {
        home(controller, tick_us);
    }
    supervise(controller);
    telemetry_send_if_due(controller);
}
