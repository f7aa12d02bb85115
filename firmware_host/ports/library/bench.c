#include "bench.h"

#include <stdlib.h>
#include <string.h>

#include "states.h"

struct device *bench_new(const char *setup, const char **fault)
{
    struct device *device = malloc(sizeof *device);
    char *text = strdup(setup);
    *fault = device_make(device, text);
    free(text);
    return device;
}

void bench_delete(struct device *device)
{
    free(device);
}

void bench_receive(struct device *device, const uint8_t *bytes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        controller_receive(&device->controller, bytes[i]);
    }
}

uint32_t bench_take_output(struct device *device, uint8_t *bytes, uint32_t room)
{
    uint32_t count = device->output_used < room ? device->output_used : room;
    memcpy(bytes, device->output, count);
    device->output_used -= count;
    memmove(device->output, device->output + count, device->output_used);
    return count;
}

void bench_tick(struct device *device)
{
    controller_tick(&device->controller);
}

void bench_look(const struct device *device, struct view *view)
{
    const struct controller *controller = &device->controller;
    *view = (struct view){
        .time_us = controller->time_us,
        .path_us = follower_path_us(&controller->follower),
        .rate = (double)controller->follower.rate / FULL_RATE,
        .queued = controller->follower.queued,
        .free = follower_free(&controller->follower),
        .bad_frames = controller->reader.bad_frames,
        .state = controller->state,
        .cause = controller->cause,
        .torque_on = controller->torque_on,
    };
    memcpy(view->command, controller->follower.command, sizeof view->command);
    memcpy(
        view->command_velocity, controller->follower.command_velocity,
        sizeof view->command_velocity);
    memcpy(view->preload, controller->follower.preload, sizeof view->preload);
    memcpy(view->measured, controller->measured, sizeof view->measured);
    memcpy(view->current_ma, controller->readings.current_ma, sizeof view->current_ma);
    memcpy(view->position, device->plant.joint, sizeof view->position);
}

void bench_set_state(struct device *device, uint8_t state)
{
    device->controller.state = state;
}

uint8_t bench_mishap(struct device *device, const char *kind, uint8_t number)
{
    return device_mishap(device, kind, number);
}

void bench_keep_knots(struct device *device, uint16_t count)
{
    if (device->controller.follower.queued > count) {
        device->controller.follower.queued = count;
    }
}

static void knots_of(const int64_t *row, struct knot *from, struct knot *to)
{
    struct knot *ends[2] = {from, to};
    for (int end = 0; end < 2; end++, row += 4) {
        ends[end]->t_us = (uint64_t)row[0];
        ends[end]->position_urad[0] = (int32_t)row[1];
        ends[end]->velocity_urad_s[0] = (int32_t)row[2];
        ends[end]->acceleration_urad_s2[0] = (int32_t)row[3];
    }
}

void bench_quintic(const int64_t *rows, int32_t *results, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, rows += 9, results += 3) {
        struct knot from, to;
        struct hermite ends;
        struct quintic quintic;
        knots_of(rows, &from, &to);
        int32_t duration_us = (int32_t)(to.t_us - from.t_us);
        struct span span = span_of(duration_us);
        hermite_of(&from, &to, 0, &span, &ends);
        quintic_of(&ends, &quintic);
        uint32_t share = quintic_share((int32_t)rows[8], duration_us);
        struct motion motion = quintic_at(&quintic, share, &span, WITH_ACCELERATION);
        results[0] = motion.position;
        results[1] = motion.velocity;
        results[2] = motion.acceleration;
    }
}

void bench_violation(
    const int64_t *rows, const int32_t *limits, uint8_t *reasons, uint32_t count)
{
    const struct hand_setup setup = {
        .joints = 1,
        .limits = {{limits[0]}, {limits[1]}, {limits[2]}, {limits[3]}},
        .motor_limits = {{limits[4]}, {limits[5]}, {limits[6]}, {limits[7]}},
        .transmission = {.group = 1, .gain = {{limits[8]}}},
    };
    const int32_t offset = limits[9];
    for (uint32_t i = 0; i < count; i++, rows += 8) {
        struct knot from, to;
        knots_of(rows, &from, &to);
        reasons[i] = segment_violation(&from, &to, &setup, &offset).reason;
    }
}

#define RECODE(code, name)                                                \
    case code: {                                                          \
        struct name message;                                              \
        if (!decode_##name(payload, length, &joints, &message)) {         \
            return 255;                                                   \
        }                                                                 \
        return encode_##name(&message, joints, out);                      \
    }

uint8_t bench_recode(uint8_t kind, const uint8_t *payload, uint8_t length, uint8_t *out)
{
    uint8_t joints;
    switch (kind) {
        RECODE(MESSAGE_HELLO, hello)
        RECODE(MESSAGE_ASK_LIMITS, ask_limits)
        RECODE(MESSAGE_PING, ping)
        RECODE(MESSAGE_HOLD, hold)
        RECODE(MESSAGE_ESTOP, estop)
        RECODE(MESSAGE_ARM, arm)
        RECODE(MESSAGE_KNOT, knot)
        RECODE(MESSAGE_START, start)
        RECODE(MESSAGE_END, end)
        RECODE(MESSAGE_CLEAR, clear)
        RECODE(MESSAGE_WELCOME, welcome)
        RECODE(MESSAGE_LIMITS, limits)
        RECODE(MESSAGE_PONG, pong)
        RECODE(MESSAGE_ACK, ack)
        RECODE(MESSAGE_NAK, nak)
        RECODE(MESSAGE_REFUSED, refused)
        RECODE(MESSAGE_NO_SESSION, no_session)
        RECODE(MESSAGE_TELEMETRY, telemetry)
        RECODE(MESSAGE_HEALTH, health)
        RECODE(MESSAGE_ASK_HOMING, ask_homing)
        RECODE(MESSAGE_HOME, home)
        RECODE(MESSAGE_CALIBRATE, calibrate)
        RECODE(MESSAGE_HOMING_REPORT, homing_report)
    default:
        return 255;
    }
}

uint8_t bench_frame(
    uint8_t kind, uint16_t seq, uint16_t session, const uint8_t *payload, uint8_t length,
    uint8_t *wire)
{
    struct frame frame = {PROTOCOL_VERSION, kind, seq, session, length, payload};
    return frame_encode(&frame, wire);
}

uint8_t bench_state_after(uint8_t state, uint8_t message)
{
    return state_after(state, message);
}
