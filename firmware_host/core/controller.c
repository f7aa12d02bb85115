#include "controller.h"

#include <string.h>

#include "commands.h"
#include "fixed.h"
#include "link.h"
#include "telemetry.h"
#include "transmission.h"

static void exchange(struct controller *controller)
{
    const struct hand_setup *setup = controller->setup;
    struct follower *follower = &controller->follower;
    struct motor_goals goals = {.torque_on = controller->torque_on};
    motors_of(&setup->transmission, setup->joints, follower->command, goals.position);
    motor_rates_of(&setup->transmission, setup->joints, follower->command_velocity, goals.velocity);
    controller->board->exchange(controller->board->context, &goals, &controller->readings);
    joints_of(
        &setup->transmission, setup->joints, controller->readings.position, controller->measured);
}

void controller_boot(
    struct controller *controller, const struct hand_setup *setup, const struct board *board)
{
    memset(controller, 0, sizeof *controller);
    controller->setup = setup;
    controller->board = board;
    controller->follower.setup = setup;
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
    if (motors != CAUSE_NONE && controller->state >= STATE_READY && controller->state <= STATE_HOLD) {
        fault(controller, motors);
        return;
    }
    if (controller->state == STATE_ARMED && silent) {
        controller->state = STATE_READY;
    }
    if (controller->state != STATE_RUNNING) {
        return;
    }
    const struct follower *follower = &controller->follower;
    if (guard_tracking(controller->setup, controller->measured, follower->command) != CAUSE_NONE) {
        fault(controller, CAUSE_TRACKING);
    } else if (follower_arrived(follower)) {
        controller->state = STATE_READY;
    } else if (silent) {
        command_stop(controller, STATE_HOLD, CAUSE_SILENCE);
    } else if (follower_starving(follower)) {
        command_stop(controller, STATE_HOLD, CAUSE_UNDERRUN);
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
    supervise(controller);
    telemetry_send_if_due(controller);
}
