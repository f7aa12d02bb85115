/* An image for measurements: each piece of work between two marks.

   On an AVR the simulator times them (tools/time_avr.c). On a Cortex-M the image sends each mark
   with the reading of a counter (tests/firmware/test_pace.py), for QEMU to count instructions. */
#include "bytes.h"
#include "controller.h"
#include "link.h"
#include "motors.h"
#include "fixed.h"

#include <string.h>

#ifdef __AVR__
#include <avr/io.h>
#include <avr/sleep.h>
#define MARK(number) (GPIOR0 = (number))
#else
#include "mcu.h"
#define COUNTER (*(volatile uint32_t *)0xe000e018) /* runs down */
#define MARK(number) note_mark(number)
#endif

#define KNOTS 20
#define STEP_US 40000

extern const struct hand_setup HAND_SETUP;

static struct controller controller;

#ifndef __AVR__
static struct {
    uint8_t number;
    uint32_t counter;
} marks[200];
static uint16_t marked;

static void note_mark(uint8_t number)
{
    marks[marked].number = number;
    marks[marked++].counter = COUNTER;
}

static void send_marks(void)
{
    for (uint16_t i = 0; i < marked; i++) {
        uint8_t bytes[5];
        put_u32(put_u8(bytes, marks[i].number), marks[i].counter);
        mcu_put(bytes, sizeof bytes);
    }
}
#endif

static void send(void *context, const uint8_t *bytes, uint8_t count)
{
    (void)context;
    (void)bytes;
    (void)count;
}

/* A gentle swing of all joints around where the hand starts, within every limit. */
static void next_knot(struct knot *knot, const int32_t *start, uint8_t number)
{
    memset(knot, 0, sizeof *knot);
    knot->t_us = (uint64_t)number * STEP_US;
    for (uint8_t i = 0; i < HAND_SETUP.joints; i++) {
        knot->position_urad[i] = start[i] + 400 * (number % 4 < 2 ? number % 4 : 2 - number % 4);
        knot->preload_20urad[i] = number;
    }
}

static void take(uint8_t kind, uint16_t seq, const uint8_t *payload, uint8_t length)
{
    struct frame frame = {PROTOCOL_VERSION, kind, seq, 1, length, payload};
    uint8_t wire[FRAME_MAX_WIRE];
    uint8_t count = frame_encode(&frame, wire);
    for (uint8_t i = 0; i < count; i++) {
        controller_receive(&controller, wire[i]);
    }
}

static void prepare(const struct board *board)
{
    motors_start();
    controller_boot(&controller, &HAND_SETUP, board);
    take(MESSAGE_HELLO, 0, NULL, 0);
    take(MESSAGE_ARM, 0, NULL, 0);
}

static void stream(void)
{
    int32_t start[MAX_JOINTS];
    uint8_t payload[MAX_PAYLOAD], bytes[8] = {0};
    memcpy(start, controller.measured, sizeof start);
    for (uint8_t number = 0; number < KNOTS; number++) {
        struct knot knot;
        next_knot(&knot, start, number);
        uint8_t length = encode_knot(&knot, HAND_SETUP.joints, payload);
        MARK(1);
        take(MESSAGE_KNOT, (uint16_t)(number + 1), payload, length);
        MARK(2);
    }
    bytes[0] = 1;
    take(MESSAGE_START, KNOTS + 1, bytes, 8);
}

int main(void)
{
    const struct board board = {
        .send = send, .exchange = motors_exchange, .torque_off = motors_torque_off};
#ifndef __AVR__
    mcu_start(10);
    uint8_t byte;
    while (!mcu_take_byte(&byte)) { /* until somebody listens */
        mcu_rest();
    }
#endif
    prepare(&board);
    stream();
    for (uint8_t tick = 0; tick < 20; tick++) {
        MARK(3);
        controller_tick(&controller);
        MARK(4);
        MARK(5);
        follower_step(&controller.follower, US_PER_S / HAND_SETUP.tick_hz);
        MARK(6);
    }
    MARK(7);
    take(MESSAGE_ESTOP, 0, NULL, 0);
    MARK(8);
    MARK(controller.state == STATE_ESTOP && controller.follower.path == 0 ? 0xff : 0xfe);
#ifndef __AVR__
    send_marks();
#endif
    for (;;) {
#ifdef __AVR__
        sleep_cpu();
#endif
    }
}
