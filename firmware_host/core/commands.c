#include "commands.h"

#include "states.h"
#include "transmission.h"

#define PREFILL_US 500000
#define START_WINDOW_US 60000000
#define LARGEST_ZERO 20000000 /* three turns: more is no zero */

typedef struct violation (*action)(struct controller *, const struct frame *);

static const struct violation MALFORMED = {REASON_MALFORMED, 0};
static const struct violation DONE = {0, 0};

void command_stop(struct controller *controller, uint8_t state, uint8_t cause)
{
    controller->state = state;
    controller->cause = cause;
    follower_stop(&controller->follower);
}

void command_hold(struct controller *controller)
{
    uint8_t next = state_after(controller->state, MESSAGE_HOLD);
    if (controller->state == STATE_HOMING) {
        command_stop_homing(controller);
    }
    if (next != controller->state) {
        command_stop(controller, next, CAUSE_HOST);
    }
}

void command_stop_homing(struct controller *controller)
{
    controller->homing.outcome = HOMING_OUTCOME_STOPPED;
    controller->torque_on = false;
    follower_rest_at(&controller->follower, controller->measured);
}

void command_estop(struct controller *controller, uint8_t cause)
{
    controller->board->torque_off(controller->board->context);
    controller->torque_on = false;
    if (controller->state == STATE_HOMING) {
        controller->homing.outcome = HOMING_OUTCOME_STOPPED;
    }
    controller->state = STATE_ESTOP;
    controller->cause = cause;
    follower_rest_at(&controller->follower, controller->measured);
}

static struct violation arm(struct controller *controller, const struct frame *frame)
{
    if (frame->length != 0) {
        return MALFORMED;
    }
    follower_forget(&controller->follower);
    return DONE;
}

static struct violation take_knot(struct controller *controller, const struct frame *frame)
{
    struct knot knot;
    uint8_t joints;
    if (!decode_knot(frame->payload, frame->length, &joints, &knot) ||
        joints != controller->setup->joints) {
        return MALFORMED;
    }
    return follower_offer(&controller->follower, &knot, controller->measured);
}

static struct violation start(struct controller *controller, const struct frame *frame)
{
    struct start start;
    uint8_t joints;
    if (!decode_start(frame->payload, frame->length, &joints, &start)) {
        return MALFORMED;
    }
    if (start.device_us < controller->time_us ||
        start.device_us - controller->time_us > START_WINDOW_US) {
        return (struct violation){REASON_START_TIME, 0};
    }
    const struct follower *follower = &controller->follower;
    if (follower_queued_us(follower) < PREFILL_US && !follower->ended) {
        return (struct violation){REASON_TOO_LITTLE_PREFILL, 0};
    }
    controller->start_us = start.device_us;
    return DONE;
}

static struct violation end(struct controller *controller, const struct frame *frame)
{
    struct end end;
    uint8_t joints;
    if (!decode_end(frame->payload, frame->length, &joints, &end)) {
        return MALFORMED;
    }
    return (struct violation){follower_end(&controller->follower, end.knots), 0};
}

/* Unlatch: the goal becomes where the joints are, then torque comes back. */
static struct violation clear(struct controller *controller, const struct frame *frame)
{
    if (frame->length != 0) {
        return MALFORMED;
    }
    if (controller->follower.rate > 0) {
        return (struct violation){REASON_STILL_MOVING, 0};
    }
    controller->cause = CAUSE_NONE;
    controller->guard = (struct guard){0};
    follower_rest_at(&controller->follower, controller->measured);
    controller->torque_on = controller->homed;
    return DONE;
}

static struct violation home(struct controller *controller, const struct frame *frame)
{
    (void)frame;
    controller->homed = false;
    controller->cause = CAUSE_NONE;
    controller->guard = (struct guard){0};
    homing_begin(&controller->homing, controller->setup, controller->measured);
    controller->torque_on = true;
    return DONE;
}

/* Whether zeros put each joint within its end stops, or a tenth of its range beyond. */
static struct violation implausible(const struct controller *controller, const int32_t *offset)
{
    const struct hand_setup *setup = controller->setup;
    int32_t joint[MAX_JOINTS];
    for (uint8_t i = 0; i < setup->joints; i++) {
        if (offset[i] > LARGEST_ZERO || offset[i] < -LARGEST_ZERO) {
            return (struct violation){REASON_IMPLAUSIBLE, i};
        }
    }
    joints_of(&setup->transmission, setup->joints, offset, controller->readings.position, joint);
    for (uint8_t i = 0; i < setup->joints; i++) {
        int32_t lower = setup->homing.lower[i], upper = setup->homing.upper[i];
        int32_t margin = (upper - lower) / 10;
        if (joint[i] < lower - margin || joint[i] > upper + margin) {
            return (struct violation){REASON_IMPLAUSIBLE, i};
        }
    }
    return DONE;
}

static struct violation calibrate(struct controller *controller, const struct frame *frame)
{
    struct calibrate zeros;
    uint8_t joints;
    if (!decode_calibrate(frame->payload, frame->length, &joints, &zeros) ||
        joints != controller->setup->joints) {
        return MALFORMED;
    }
    struct violation fault = implausible(controller, zeros.offset_urad);
    if (fault.reason == 0) {
        controller_set_zeros(controller, zeros.offset_urad);
        controller->homing.outcome = HOMING_OUTCOME_CALIBRATED;
        controller->cause = CAUSE_NONE;
        controller->torque_on = true;
    }
    return fault;
}

static action action_of(uint8_t kind)
{
    switch (kind) {
    case MESSAGE_HOME:
        return home;
    case MESSAGE_CALIBRATE:
        return calibrate;
    case MESSAGE_ARM:
        return arm;
    case MESSAGE_KNOT:
        return take_knot;
    case MESSAGE_START:
        return start;
    case MESSAGE_END:
        return end;
    default:
        return clear;
    }
}

/* Whether a payload has the form of its message, whatever the state. */
static bool well_formed(const struct frame *frame)
{
    switch (frame->kind) {
    case MESSAGE_KNOT:
        return frame->length >= 8 && (frame->length - 8) % 14 == 0;
    case MESSAGE_START:
        return frame->length == 8;
    case MESSAGE_END:
        return frame->length == 4;
    case MESSAGE_CALIBRATE:
        return frame->length % 4 == 0;
    default:
        return frame->length == 0;
    }
}

bool command_perform(struct controller *controller, const struct frame *frame)
{
    struct violation refusal = {REASON_WRONG_STATE, 0};
    uint8_t next = state_after(controller->state, frame->kind);
    if (!well_formed(frame)) {
        refusal = MALFORMED;
    } else if (next != REFUSED) {
        refusal = action_of(frame->kind)(controller, frame);
    }
    if (refusal.reason == 0) {
        controller->state = next == STATE_READY && !controller->homed ? STATE_IDLE : next;
        return true;
    }
    controller->refusal = (struct refused){
        .seq = frame->seq,
        .command = frame->kind,
        .reason = refusal.reason,
        .joint = refusal.joint,
        .state = controller->state,
        .cause = controller->cause,
    };
    return false;
}
