#include "servo_bus.h"

#include "bytes.h"

#define HEADER 0xff
#define BROADCAST 0xfe
#define INSTRUCTION_READ 0x02
#define INSTRUCTION_SYNC_WRITE 0x83

#define REGISTER_TORQUE 40
#define REGISTER_GOAL 42 /* position, time, speed, torque limit: two bytes each */
#define REGISTER_STATE 56
#define STATE_BYTES 15 /* up to and with the current */
#define STATE_TEMPERATURE 7
#define STATE_CURRENT 13

#define STEPS_PER_TURN 4096
#define TURN 6283185 /* [1e-6 rad] */
#define MICROAMPERES_PER_STEP 6500
#define STALL_MA 2700 /* what the whole torque takes */
#define WHOLE_TORQUE 1000
#define ANSWER_PATIENCE_US 1000

/* Header, id, length, instruction, parameters, checksum. */
#define PACKET_BYTES (8 + MAX_JOINTS * 9)

static uint8_t checksum(const uint8_t *bytes, uint8_t count)
{
    uint8_t sum = 0;
    while (count-- > 0) {
        sum = (uint8_t)(sum + *bytes++);
    }
    return (uint8_t)~sum;
}

/* `packet` holds parameters from its sixth byte on; the rest is put around them. */
static void transmit(
    const struct servo_bus *bus, uint8_t id, uint8_t instruction, uint8_t parameters,
    uint8_t *packet)
{
    packet[0] = packet[1] = HEADER;
    packet[2] = id;
    packet[3] = (uint8_t)(parameters + 2);
    packet[4] = instruction;
    packet[5 + parameters] = checksum(packet + 2, (uint8_t)(parameters + 3));
    bus->line->transmit(bus->line->context, packet, (uint8_t)(parameters + 6));
}

/* Registers of one servo; false when it does not answer, answers badly, or reports an error. */
static bool read_registers(
    const struct servo_bus *bus, uint8_t id, uint8_t start, uint8_t count, uint8_t *out)
{
    uint8_t packet[8], answer[6 + STATE_BYTES], length = (uint8_t)(count + 6);
    packet[5] = start;
    packet[6] = count;
    transmit(bus, id, INSTRUCTION_READ, 2, packet);
    uint8_t came =
        bus->line->receive(bus->line->context, answer, length, ANSWER_PATIENCE_US);
    bool whole = came == length && answer[0] == HEADER && answer[1] == HEADER &&
                 answer[2] == id && answer[3] == count + 2 &&
                 answer[length - 1] == checksum(answer + 2, (uint8_t)(count + 3));
    if (!whole || answer[4] != 0) {
        return false;
    }
    get_bytes(answer + 5, out, count);
    return true;
}

/* Angle to steps, rounded to the nearest. */
static int16_t steps_of(const struct servo_mount *mount, int32_t angle)
{
    int64_t scaled = (int64_t)angle * mount->sign * STEPS_PER_TURN;
    scaled += scaled < 0 ? -TURN / 2 : TURN / 2;
    return (int16_t)(mount->zero + scaled / TURN);
}

static int32_t angle_of(const struct servo_mount *mount, int16_t steps)
{
    return (int32_t)((int64_t)(steps - mount->zero) * mount->sign * TURN / STEPS_PER_TURN);
}

/* The servos' signed numbers: a sign in the highest bit, then the magnitude. */
static uint16_t with_sign_bit(int16_t value)
{
    if (value < 0) {
        return (uint16_t)(0x8000u | (uint16_t)-value);
    }
    return (uint16_t)value;
}

static int16_t from_sign_bit(uint16_t word)
{
    int16_t value = (int16_t)(word & 0x7fff);
    return word & 0x8000 ? (int16_t)-value : value;
}

/* A bound on the current as the servos take it, in thousandths of their torque. */
static uint16_t torque_share(int16_t current_ma)
{
    if (current_ma == 0 || current_ma > STALL_MA) {
        return WHOLE_TORQUE;
    }
    return (uint16_t)((int32_t)current_ma * WHOLE_TORQUE / STALL_MA);
}

static void write_goals(const struct servo_bus *bus, const struct motor_goals *goals)
{
    uint8_t packet[PACKET_BYTES], *at = packet + 5;
    at = put_u8(put_u8(at, REGISTER_GOAL), 8);
    for (uint8_t i = 0; i < bus->count; i++) {
        at = put_u8(at, bus->mounts[i].id);
        at = put_u16(at, with_sign_bit(steps_of(&bus->mounts[i], goals->position[i])));
        at = put_u32(at, 0); /* no time, no speed limit: the path comes in small steps */
        at = put_u16(at, torque_share(goals->current_ma));
    }
    transmit(bus, BROADCAST, INSTRUCTION_SYNC_WRITE, (uint8_t)(at - packet - 5), packet);
}

static void write_torque(const struct servo_bus *bus, bool on)
{
    uint8_t packet[PACKET_BYTES], *at = packet + 5;
    at = put_u8(put_u8(at, REGISTER_TORQUE), 1);
    for (uint8_t i = 0; i < bus->count; i++) {
        at = put_u8(put_u8(at, bus->mounts[i].id), on);
    }
    transmit(bus, BROADCAST, INSTRUCTION_SYNC_WRITE, (uint8_t)(at - packet - 5), packet);
}

static bool goals_arrived(const struct servo_bus *bus, const struct motor_goals *goals)
{
    for (uint8_t i = 0; i < bus->count; i++) {
        uint8_t goal[2];
        uint16_t wanted = with_sign_bit(steps_of(&bus->mounts[i], goals->position[i]));
        if (!read_registers(bus, bus->mounts[i].id, REGISTER_GOAL, 2, goal) ||
            get_u16(goal) != wanted) {
            return false;
        }
    }
    return true;
}

static void read_state(const struct servo_bus *bus, uint8_t i, struct motor_readings *readings)
{
    uint8_t state[STATE_BYTES];
    const struct servo_mount *mount = &bus->mounts[i];
    readings->answered[i] = read_registers(bus, mount->id, REGISTER_STATE, STATE_BYTES, state);
    if (!readings->answered[i]) {
        return;
    }
    int32_t current = from_sign_bit(get_u16(state + STATE_CURRENT));
    readings->position[i] = angle_of(mount, from_sign_bit(get_u16(state)));
    readings->temperature_c[i] = (int8_t)state[STATE_TEMPERATURE];
    readings->current_ma[i] = (int16_t)(current * MICROAMPERES_PER_STEP / 1000);
}

void servo_bus_exchange(void *context, const struct motor_goals *goals, struct motor_readings *readings)
{
    struct servo_bus *bus = context;
    write_goals(bus, goals);
    if (goals->torque_on && !bus->torque_on && goals_arrived(bus, goals)) {
        write_torque(bus, true);
        bus->torque_on = true;
    } else if (!goals->torque_on && bus->torque_on) {
        servo_bus_torque_off(bus);
    }
    for (uint8_t i = 0; i < bus->count; i++) {
        read_state(bus, i, readings);
    }
}

void servo_bus_torque_off(void *context)
{
    struct servo_bus *bus = context;
    write_torque(bus, false);
    write_torque(bus, false);
    bus->torque_on = false;
}
