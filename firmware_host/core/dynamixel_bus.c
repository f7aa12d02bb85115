#include "dynamixel_bus.h"

#include <string.h>

#include "bytes.h"
#include "dynamixel_packet.h"

#define BROADCAST 0xfe
#define INSTRUCTION_READ 0x02
#define INSTRUCTION_SYNC_READ 0x82
#define INSTRUCTION_SYNC_WRITE 0x83

#define REGISTER_MODE 11
#define REGISTER_TORQUE 64
#define REGISTER_WATCHDOG 98
#define REGISTER_GOAL_CURRENT 102
#define REGISTER_GOAL 116
#define REGISTER_STATE 126 /* current, velocity, position ... temperature */
#define STATE_BYTES 21
#define STATE_POSITION 6
#define STATE_TEMPERATURE 20

#define CURRENT_BASED_POSITION 5
#define WATCHDOG_STEPS 5 /* of 20 ms */

#define STEPS_PER_TURN 4096
#define TURN 6283185 /* [1e-6 rad] */
#define ANSWER_PATIENCE_US 1000

#define VALUE_BYTES 4
#define NOBODY 0xff
/* Head, register and size, ids with values, room for stuffing, tail. */
#define PACKET_BYTES (DYNAMIXEL_HEAD + 4 + MAX_JOINTS * (1 + VALUE_BYTES) * 4 / 3 + DYNAMIXEL_TAIL)
#define ANSWER_BYTES (DYNAMIXEL_HEAD + 1 + STATE_BYTES * 4 / 3 + DYNAMIXEL_TAIL)

static void send(
    const struct dynamixel_bus *bus, uint8_t *packet, uint8_t id, uint8_t instruction,
    const uint8_t *end)
{
    uint8_t count = (uint8_t)(end - packet - DYNAMIXEL_HEAD);
    bus->line->transmit(
        bus->line->context, packet, dynamixel_frame(packet, id, instruction, count));
}

/* One register of all servos at once, little-endian. */
static void write_all(
    const struct dynamixel_bus *bus, uint8_t start, uint8_t size, const int32_t *values)
{
    uint8_t packet[PACKET_BYTES], *at = packet + DYNAMIXEL_HEAD;
    at = put_u16(put_u16(at, start), size);
    for (uint8_t i = 0; i < bus->count; i++) {
        at = put_u8(at, bus->mounts[i].id);
        for (uint8_t byte = 0; byte < size; byte++) {
            at = put_u8(at, (uint8_t)((uint32_t)values[i] >> (8 * byte)));
        }
    }
    send(bus, packet, BROADCAST, INSTRUCTION_SYNC_WRITE, at);
}

static void write_same(
    const struct dynamixel_bus *bus, uint8_t start, uint8_t size, int32_t value)
{
    int32_t values[MAX_JOINTS];
    for (uint8_t i = 0; i < bus->count; i++) {
        values[i] = value;
    }
    write_all(bus, start, size, values);
}

/* The next answer: the number of the servo that gave it, and its `count` bytes at `out`. NOBODY when
   none comes in time, or one that is damaged or reports an error. */
static uint8_t take_answer(const struct dynamixel_bus *bus, uint8_t count, uint8_t *out)
{
    uint8_t answer[ANSWER_BYTES];
    uint8_t wanted = (uint8_t)(DYNAMIXEL_HEAD + 1 + count + DYNAMIXEL_TAIL);
    uint8_t came = bus->line->receive(bus->line->context, answer, wanted, ANSWER_PATIENCE_US);
    if (came == wanted && get_u16(answer + 5) + 7 > wanted &&
        get_u16(answer + 5) + 7 <= ANSWER_BYTES) {
        /* Stuffed: the rest follows. */
        uint8_t rest = (uint8_t)(get_u16(answer + 5) + 7 - wanted);
        came = (uint8_t)(came + bus->line->receive(
                                    bus->line->context, answer + came, rest, ANSWER_PATIENCE_US));
    }
    for (uint8_t i = 0; i < bus->count; i++) {
        if (dynamixel_open(answer, came, bus->mounts[i].id, count)) {
            get_bytes(answer + DYNAMIXEL_HEAD + 1, out, count);
            return i;
        }
    }
    return NOBODY;
}

static bool read_value(
    const struct dynamixel_bus *bus, uint8_t servo, uint8_t start, uint8_t size, uint8_t *out)
{
    uint8_t packet[PACKET_BYTES], *at = packet + DYNAMIXEL_HEAD;
    at = put_u16(put_u16(at, start), size);
    send(bus, packet, bus->mounts[servo].id, INSTRUCTION_READ, at);
    return take_answer(bus, size, out) == servo;
}

/* Mode and watchdog can only be set without torque. False until all servos confirm them. */
static bool prepare(const struct dynamixel_bus *bus)
{
    write_same(bus, REGISTER_TORQUE, 1, 0);
    write_same(bus, REGISTER_MODE, 1, CURRENT_BASED_POSITION);
    write_same(bus, REGISTER_WATCHDOG, 1, 0); /* clears one that has tripped */
    write_same(bus, REGISTER_WATCHDOG, 1, WATCHDOG_STEPS);
    for (uint8_t i = 0; i < bus->count; i++) {
        uint8_t mode;
        if (!read_value(bus, i, REGISTER_MODE, 1, &mode) ||
            mode != CURRENT_BASED_POSITION) {
            return false;
        }
    }
    return true;
}

/* Angle to steps, rounded to the nearest. */
static int32_t steps_of(const struct servo_mount *mount, int32_t angle)
{
    int64_t scaled = (int64_t)angle * mount->sign * STEPS_PER_TURN;
    scaled += scaled < 0 ? -TURN / 2 : TURN / 2;
    return (int32_t)(mount->zero + scaled / TURN);
}

static int32_t angle_of(const struct servo_mount *mount, int32_t steps)
{
    return (int32_t)((int64_t)(steps - mount->zero) * mount->sign * TURN / STEPS_PER_TURN);
}

static bool goals_arrived(const struct dynamixel_bus *bus, const int32_t *steps)
{
    for (uint8_t i = 0; i < bus->count; i++) {
        uint8_t goal[4];
        if (!read_value(bus, i, REGISTER_GOAL, 4, goal) ||
            (int32_t)get_u32(goal) != steps[i]) {
            return false;
        }
    }
    return true;
}

static void write_goals(struct dynamixel_bus *bus, const struct motor_goals *goals, int32_t *steps)
{
    int16_t bound_ma = goals->current_ma > 0 ? goals->current_ma : bus->full_ma;
    if (bound_ma != bus->bound_ma) {
        write_same(bus, REGISTER_GOAL_CURRENT, 2, bound_ma);
        bus->bound_ma = bound_ma;
    }
    for (uint8_t i = 0; i < bus->count; i++) {
        steps[i] = steps_of(&bus->mounts[i], goals->position[i]);
    }
    write_all(bus, REGISTER_GOAL, 4, steps);
}

static void ask_all(const struct dynamixel_bus *bus)
{
    uint8_t packet[PACKET_BYTES], *at = packet + DYNAMIXEL_HEAD;
    at = put_u16(put_u16(at, REGISTER_STATE), STATE_BYTES);
    for (uint8_t i = 0; i < bus->count; i++) {
        at = put_u8(at, bus->mounts[i].id);
    }
    send(bus, packet, BROADCAST, INSTRUCTION_SYNC_READ, at);
}

/* One that is dead costs its patience once; those behind it are known by their ids. */
static void take_states(const struct dynamixel_bus *bus, struct motor_readings *readings)
{
    memset(readings->answered, 0, sizeof readings->answered);
    for (uint8_t turn = 0; turn < bus->count; turn++) {
        uint8_t state[STATE_BYTES], i = take_answer(bus, STATE_BYTES, state);
        if (i != NOBODY) {
            readings->answered[i] = true;
            readings->current_ma[i] = (int16_t)get_u16(state);
            readings->position[i] =
                angle_of(&bus->mounts[i], (int32_t)get_u32(state + STATE_POSITION));
            readings->temperature_c[i] = (int8_t)state[STATE_TEMPERATURE];
        }
    }
}

void dynamixel_bus_exchange(
    void *context, const struct motor_goals *goals, struct motor_readings *readings)
{
    struct dynamixel_bus *bus = context;
    int32_t steps[MAX_JOINTS];
    if (!bus->prepared) {
        bus->prepared = prepare(bus);
    }
    write_goals(bus, goals, steps);
    if (goals->torque_on && !bus->torque_on && bus->prepared && goals_arrived(bus, steps)) {
        write_same(bus, REGISTER_TORQUE, 1, 1);
        bus->torque_on = true;
    } else if (!goals->torque_on && bus->torque_on) {
        dynamixel_bus_torque_off(bus);
    }
    ask_all(bus);
    take_states(bus, readings);
}

void dynamixel_bus_torque_off(void *context)
{
    struct dynamixel_bus *bus = context;
    write_same(bus, REGISTER_TORQUE, 1, 0);
    write_same(bus, REGISTER_TORQUE, 1, 0);
    bus->torque_on = false;
}
