/* Bytes that no host would send, against the whole controller, under sanitizers.

   Usage: fuzz BYTES SEED. Noise, cut and flipped frames, and frames that are whole but hold anything
   (their CRC fits, so they reach the commands). Ticks pass between them. After each round a good
   frame must be answered, and the commands must lie within the joints' limits. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "simulated_board.h"

#define SESSION 77
#define ROUND_BYTES 20000

static struct device device;
static uint64_t chance;

static uint32_t draw(uint32_t bound)
{
    chance ^= chance << 13;
    chance ^= chance >> 7;
    chance ^= chance << 17;
    return (uint32_t)(chance >> 32) % bound;
}

static void feed(const uint8_t *bytes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        controller_receive(&device.controller, bytes[i]);
    }
}

static uint8_t wrap(uint8_t kind, uint16_t seq, const uint8_t *payload, uint8_t length, uint8_t *wire)
{
    bool stranger = kind == MESSAGE_HELLO || draw(100) == 0;
    uint16_t session = stranger ? (uint16_t)draw(65536) : device.controller.session;
    struct frame frame = {draw(200) ? PROTOCOL_VERSION : (uint8_t)draw(256), kind, seq, session, length, payload};
    return frame_encode(&frame, wire);
}

/* A knot that is sane but for one field, or wild altogether. */
static uint8_t any_knot(uint8_t *payload)
{
    static uint64_t time_us;
    struct knot knot = {.t_us = time_us += 2900 + draw(200000)};
    bool wild = draw(100) == 0, resting = draw(3) == 0;
    for (uint8_t i = 0; i < MAX_JOINTS; i++) {
        knot.position_urad[i] = wild ? (int32_t)draw(UINT32_MAX) : (int32_t)draw(3000);
        knot.velocity_urad_s[i] = wild ? (int32_t)draw(UINT32_MAX) : (int32_t)draw(20000) - 10000;
        knot.acceleration_urad_s2[i] = wild ? (int32_t)draw(UINT32_MAX) : (int32_t)draw(100000);
        knot.preload_20urad[i] = wild ? (int16_t)draw(65536) : (int16_t)draw(20);
        if (resting) {
            knot.velocity_urad_s[i] = knot.acceleration_urad_s2[i] = 0;
        }
    }
    if (device.controller.follower.queued == 0) {
        time_us = 0;
        knot = (struct knot){0};
    }
    return encode_knot(&knot, (uint8_t)(draw(100) ? MAX_JOINTS : draw(MAX_JOINTS + 1)), payload);
}

/* What leads on from where the controller is, so that motion is reached and not only refusals. */
static uint8_t sensible_kind(void)
{
    static const uint8_t TO_ARMED[] = {MESSAGE_KNOT, MESSAGE_KNOT, MESSAGE_KNOT, MESSAGE_START};
    if (device.controller.refusal.command != 0) {
        return MESSAGE_HELLO;
    }
    switch (device.controller.state) {
    case STATE_READY:
        return MESSAGE_ARM;
    case STATE_IDLE:
        return draw(3) ? MESSAGE_CALIBRATE : MESSAGE_HOME;
    case STATE_HOMING:
        return draw(50) ? MESSAGE_PING : MESSAGE_HOLD;
    case STATE_ARMED:
        return device.controller.follower.queued < 8 ? MESSAGE_KNOT : TO_ARMED[draw(4)];
    case STATE_RUNNING:
        return draw(60) ? MESSAGE_KNOT : MESSAGE_END;
    default:
        return MESSAGE_CLEAR;
    }
}

static uint32_t any_frame(uint8_t *wire)
{
    static const uint8_t KINDS[] = {
        MESSAGE_HELLO, MESSAGE_ASK_LIMITS, MESSAGE_PING, MESSAGE_HOLD, MESSAGE_ESTOP, MESSAGE_ARM,
        MESSAGE_KNOT, MESSAGE_KNOT, MESSAGE_KNOT, MESSAGE_START, MESSAGE_END, MESSAGE_CLEAR,
        MESSAGE_HOME, MESSAGE_CALIBRATE, MESSAGE_ASK_HOMING, 0x99};
    uint8_t payload[MAX_PAYLOAD], length = 0;
    uint8_t kind = draw(12) ? sensible_kind() : KINDS[draw(sizeof KINDS)];
    uint16_t seq = device.controller.sequence.expected;
    seq = (uint16_t)(draw(20) ? seq : seq + draw(65536));
    if (kind == MESSAGE_KNOT) {
        length = any_knot(payload);
    } else if (kind == MESSAGE_START) {
        put_u64(payload, device.controller.time_us + draw(100000));
        length = 8;
    } else if (kind == MESSAGE_END) {
        put_u32(payload, device.controller.follower.accepted);
        length = 4;
    } else if (kind == MESSAGE_CALIBRATE) {
        bool sane = draw(3) > 0;
        length = 4 * MAX_JOINTS;
        for (uint8_t i = 0; i < MAX_JOINTS; i++) {
            put_u32(payload + 4 * i, sane ? draw(9) - 4 : draw(UINT32_MAX));
        }
    } else if (kind == MESSAGE_PING) {
        length = 8;
        memset(payload, (int)draw(256), 8);
    }
    if (draw(40) == 0) {
        length = (uint8_t)draw(MAX_PAYLOAD + 1);
        memset(payload, (int)draw(256), sizeof payload);
    }
    return wrap(kind, seq, payload, length, wire);
}

static uint32_t damaged(uint8_t *wire, uint32_t count)
{
    uint32_t fate = draw(40);
    if (fate == 0) {
        wire[draw(count)] ^= (uint8_t)(1 << draw(8));
    } else if (fate == 1) {
        return draw(count);
    } else if (fate == 2) {
        for (uint32_t i = 0; i < count; i++) {
            wire[i] = (uint8_t)draw(256);
        }
    }
    return count;
}

static bool commands_are_legal(void)
{
    const struct controller *controller = &device.controller;
    const struct joint_limits *limits = &controller->setup->limits;
    for (uint8_t i = 0; i < controller->setup->joints; i++) {
        /* A hand that is not led rests where it was put: its stops, and what their springs give. */
        bool led = controller->follower.rate > 0;
        int32_t command = controller->follower.command[i], margin = led ? 1000 : 60000;
        if (command < limits->lower[i] - margin || command > limits->upper[i] + margin) {
            return false;
        }
    }
    return true;
}

/* Whether a good Hello is answered with one frame, whatever came before. */
static bool still_listens(void)
{
    uint8_t wire[FRAME_MAX_WIRE];
    struct frame hello = {PROTOCOL_VERSION, MESSAGE_HELLO, 0, SESSION, 0, wire};
    uint8_t count = frame_encode(&hello, wire);
    feed((const uint8_t *)"", 1);
    device.output_used = 0;
    feed(wire, count);
    return device.output_used > 0;
}

static char *setup_text(void)
{
    static char text[4096];
    char *at = text;
    at += sprintf(at, "joints 12\nhomed 1\nprotocol 2\ntick_hz 250\nbuffer_knots 64\ngroup 1\n");
    at += sprintf(at, "silence_us 500000\ntracking_error 150000\n");
    at += sprintf(at, "preload_limit 400000\npreload_rate 1000000\nhoming_speed 500000\nhoming_ma 400\n");
    const char *names[] = {"lower -10000", "upper 1000000", "velocity 1500000",
                           "acceleration 12000000", "gain 16777216", "inverse 16777216",
                           "motor_lower -20000", "motor_upper 1010000", "motor_velocity 1600000",
                           "motor_acceleration 13000000", "homing_lower -30000", "homing_upper 1030000"};
    for (size_t row = 0; row < sizeof names / sizeof names[0]; row++) {
        char name[32], number[16];
        sscanf(names[row], "%31s %15s", name, number);
        at += sprintf(at, "%s", name);
        for (int i = 0; i < 12; i++) {
            at += sprintf(at, " %s", number);
        }
        at += sprintf(at, "\n");
    }
    return text;
}

int main(int count, char **arguments)
{
    long bytes = count > 1 ? atol(arguments[1]) : 1000000, fed = 0, frames = 0, runs = 0;
    chance = count > 2 ? strtoull(arguments[2], NULL, 10) * 2654435761u + 1 : 1;
    const char *fault = device_make(&device, setup_text());
    if (fault != NULL) {
        fprintf(stderr, "%s\n", fault);
        return 1;
    }
    for (long next_check = 0; fed < bytes; frames++) {
        uint8_t wire[FRAME_MAX_WIRE];
        uint32_t size = any_frame(wire);
        size = damaged(wire, size);
        feed(wire, size);
        fed += size;
        for (uint32_t ticks = draw(3); ticks > 0; ticks--) {
            uint8_t before = device.controller.state;
            controller_tick(&device.controller);
            runs += before == STATE_RUNNING && device.controller.state != STATE_RUNNING;
        }
        device.output_used = 0;
        if (!commands_are_legal()) {
            fprintf(stderr, "a command left the limits after %ld bytes\n", fed);
            return 1;
        }
        if (fed >= next_check) {
            next_check += ROUND_BYTES;
            if (!still_listens()) {
                fprintf(stderr, "no answer after %ld bytes\n", fed);
                return 1;
            }
        }
    }
    printf(
        "%ld bytes, %ld frames, %u bad ones, %ld motions ended by themselves, %.1f s of motion time\n",
        fed, frames, device.controller.reader.bad_frames, runs,
        (double)device.controller.time_us * 1e-6);
    return 0;
}
