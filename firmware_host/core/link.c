#include "link.h"

#include <string.h>

#include "commands.h"
#include "crc32.h"

static bool moving(const struct controller *controller)
{
    return controller->state == STATE_RUNNING || controller->follower.rate > 0;
}

void link_send(
    struct controller *controller, uint8_t kind, uint16_t session, const uint8_t *payload,
    uint8_t length)
{
    struct frame frame = {
        .version = controller->setup->protocol,
        .kind = kind,
        .session = session,
        .length = length,
        .payload = payload,
    };
    uint8_t wire[FRAME_MAX_WIRE];
    uint8_t count = frame_encode(&frame, wire);
    controller->board->send(controller->board->context, wire, count);
}

static void send_ack(struct controller *controller, uint16_t session)
{
    struct ack ack = {
        .expected = controller->sequence.expected,
        .free_knots = follower_free(&controller->follower),
        .state = controller->state,
    };
    uint8_t payload[MAX_PAYLOAD];
    uint8_t length = encode_ack(&ack, 0, payload);
    link_send(controller, MESSAGE_ACK, session, payload, length);
}

static void send_refusal(struct controller *controller)
{
    uint8_t payload[MAX_PAYLOAD];
    uint8_t length = encode_refused(&controller->refusal, 0, payload);
    link_send(controller, MESSAGE_REFUSED, controller->session, payload, length);
}

static void send_nak(struct controller *controller)
{
    struct nak nak = {.expected = controller->sequence.expected};
    uint8_t payload[MAX_PAYLOAD];
    uint8_t length = encode_nak(&nak, 0, payload);
    controller->gaps++;
    link_send(controller, MESSAGE_NAK, controller->session, payload, length);
}

static void send_no_session(struct controller *controller, uint16_t session)
{
    struct no_session answer = {.boot_nonce = controller->setup->boot_nonce};
    uint8_t payload[MAX_PAYLOAD];
    uint8_t length = encode_no_session(&answer, 0, payload);
    link_send(controller, MESSAGE_NO_SESSION, session, payload, length);
}

static void send_limits(struct controller *controller)
{
    const struct joint_limits *own = &controller->setup->limits;
    struct limits limits;
    memcpy(limits.lower_urad, own->lower, sizeof own->lower);
    memcpy(limits.upper_urad, own->upper, sizeof own->upper);
    memcpy(limits.velocity_urad_s, own->velocity, sizeof own->velocity);
    memcpy(limits.acceleration_urad_s2, own->acceleration, sizeof own->acceleration);
    uint8_t payload[MAX_PAYLOAD];
    uint8_t length = encode_limits(&limits, controller->setup->joints, payload);
    link_send(controller, MESSAGE_LIMITS, controller->session, payload, length);
}

/* CRC-32 of the zeros in use, as the host would send them; 0 while none are known. */
static uint32_t zeros_check(const struct controller *controller)
{
    struct calibrate zeros;
    uint8_t payload[MAX_PAYLOAD];
    memcpy(zeros.offset_urad, controller->offset, sizeof zeros.offset_urad);
    uint8_t length = encode_calibrate(&zeros, controller->setup->joints, payload);
    return controller->homed ? crc32(payload, length) : 0;
}

static void send_homing(struct controller *controller)
{
    const struct homing *own = &controller->homing;
    struct homing_report report = {.outcome = own->outcome, .joint = own->culprit};
    uint8_t found = homing_found(own, controller->setup);
    memcpy(report.offset_urad, controller->offset, sizeof report.offset_urad);
    memcpy(report.lower_urad, own->lower, found * sizeof *own->lower);
    memcpy(report.upper_urad, own->upper, found * sizeof *own->upper);
    uint8_t payload[MAX_PAYLOAD];
    uint8_t length = encode_homing_report(&report, controller->setup->joints, payload);
    link_send(controller, MESSAGE_HOMING_REPORT, controller->session, payload, length);
}

static void take_hello(struct controller *controller, uint16_t session)
{
    const struct hand_setup *setup = controller->setup;
    if (session != controller->session && !moving(controller)) {
        controller->session = session;
        sequence_reset(&controller->sequence);
        controller->refusal = (struct refused){0};
        watchdog_feed(&controller->watchdog, controller->time_us);
        if (controller->state == STATE_ARMED) {
            controller->state = STATE_READY;
        }
    }
    struct welcome welcome = {
        .protocol = setup->protocol,
        .joints = setup->joints,
        .state = controller->state,
        .cause = controller->cause,
        .tick_hz = setup->tick_hz,
        .buffer_knots = setup->buffer_knots,
        .boot_nonce = setup->boot_nonce,
        .configuration = setup->configuration,
        .homed = controller->homed,
        .calibration = zeros_check(controller),
    };
    memcpy(welcome.build, setup->build, sizeof welcome.build);
    uint8_t payload[MAX_PAYLOAD];
    uint8_t length = encode_welcome(&welcome, 0, payload);
    link_send(controller, MESSAGE_WELCOME, session, payload, length);
}

static void take_ping(struct controller *controller, const struct frame *frame)
{
    struct ping ping;
    uint8_t joints;
    if (!decode_ping(frame->payload, frame->length, &joints, &ping)) {
        controller->reader.bad_frames++;
        return;
    }
    struct pong pong = {.host_us = ping.host_us, .device_us = controller->time_us};
    uint8_t payload[MAX_PAYLOAD];
    uint8_t length = encode_pong(&pong, 0, payload);
    link_send(controller, MESSAGE_PONG, controller->session, payload, length);
}

static void take_sequenced(struct controller *controller, const struct frame *frame)
{
    if (controller->refusal.command != 0) {
        send_refusal(controller);
        return;
    }
    switch (sequence_turn(&controller->sequence, frame->seq)) {
    case TURN_NOW:
        if (command_perform(controller, frame)) {
            sequence_done(&controller->sequence);
            send_ack(controller, controller->session);
        } else {
            send_refusal(controller);
        }
        return;
    case TURN_REPEAT:
        send_ack(controller, controller->session);
        return;
    case TURN_GAP:
        send_nak(controller);
        return;
    case TURN_GAP_KNOWN:
        return;
    }
}

/* Messages without a payload that are acted on at receipt. */
static void take_bare(struct controller *controller, const struct frame *frame)
{
    if (frame->length != 0) {
        controller->reader.bad_frames++;
    } else if (frame->kind == MESSAGE_HOLD) {
        command_hold(controller);
        send_ack(controller, controller->session);
    } else if (frame->kind == MESSAGE_ASK_LIMITS) {
        send_limits(controller);
    } else {
        send_homing(controller);
    }
}

static bool is_command(uint8_t kind)
{
    return (kind >= MESSAGE_HELLO && kind <= MESSAGE_ASK_HOMING) ||
           (kind >= MESSAGE_ARM && kind <= MESSAGE_CALIBRATE);
}

void link_take(struct controller *controller, const struct frame *frame)
{
    if (frame->kind == MESSAGE_HELLO) {
        take_hello(controller, frame->session);
    } else if (frame->version != controller->setup->protocol || !is_command(frame->kind)) {
        return;
    } else if (frame->kind == MESSAGE_ESTOP) {
        command_estop(controller, CAUSE_HOST);
        send_ack(controller, frame->session);
    } else if (frame->session != controller->session || controller->session == 0) {
        send_no_session(controller, frame->session);
    } else {
        watchdog_feed(&controller->watchdog, controller->time_us);
        if (frame->kind >= MESSAGE_ARM) {
            take_sequenced(controller, frame);
        } else if (frame->kind == MESSAGE_PING) {
            take_ping(controller, frame);
        } else {
            take_bare(controller, frame);
        }
    }
}
