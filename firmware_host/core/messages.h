/* Written by firmware_host/tools/generate.py from fpcad/run/messages.py; do not edit. */
#ifndef MESSAGES_H
#define MESSAGES_H

#include <stdbool.h>
#include <stdint.h>

#define PROTOCOL_VERSION 2
#define MAX_PAYLOAD 200
#define MAX_JOINTS 12
#define PRELOAD_URAD 20

enum message {
    MESSAGE_HELLO = 0x01,
    MESSAGE_ASK_LIMITS = 0x02,
    MESSAGE_PING = 0x03,
    MESSAGE_HOLD = 0x04,
    MESSAGE_ESTOP = 0x05,
    MESSAGE_ASK_HOMING = 0x06,
    MESSAGE_ARM = 0x10,
    MESSAGE_KNOT = 0x11,
    MESSAGE_START = 0x12,
    MESSAGE_END = 0x13,
    MESSAGE_CLEAR = 0x14,
    MESSAGE_HOME = 0x15,
    MESSAGE_CALIBRATE = 0x16,
    MESSAGE_WELCOME = 0x40,
    MESSAGE_LIMITS = 0x41,
    MESSAGE_PONG = 0x42,
    MESSAGE_ACK = 0x43,
    MESSAGE_NAK = 0x44,
    MESSAGE_REFUSED = 0x45,
    MESSAGE_NO_SESSION = 0x46,
    MESSAGE_TELEMETRY = 0x47,
    MESSAGE_HEALTH = 0x48,
    MESSAGE_HOMING_REPORT = 0x49,
};

enum state {
    STATE_BOOT = 0,
    STATE_IDLE = 1,
    STATE_HOMING = 2,
    STATE_READY = 3,
    STATE_ARMED = 4,
    STATE_RUNNING = 5,
    STATE_HOLD = 6,
    STATE_FAULT = 7,
    STATE_ESTOP = 8,
};

enum cause {
    CAUSE_NONE = 0,
    CAUSE_HOST = 1,
    CAUSE_SILENCE = 2,
    CAUSE_UNDERRUN = 3,
    CAUSE_TRACKING = 4,
    CAUSE_CURRENT = 5,
    CAUSE_TEMPERATURE = 6,
    CAUSE_MOTOR_LOST = 7,
    CAUSE_SWITCH = 8,
    CAUSE_HOMING = 9,
};

enum homing_outcome {
    HOMING_OUTCOME_NEVER = 0,
    HOMING_OUTCOME_SEARCHING = 1,
    HOMING_OUTCOME_FOUND = 2,
    HOMING_OUTCOME_NO_END = 3,
    HOMING_OUTCOME_WRONG_RANGE = 4,
    HOMING_OUTCOME_WRONG_SIGN = 5,
    HOMING_OUTCOME_STOPPED = 6,
    HOMING_OUTCOME_CALIBRATED = 7,
};

enum reason {
    REASON_WRONG_STATE = 1,
    REASON_MALFORMED = 2,
    REASON_BUFFER_FULL = 3,
    REASON_TIME_NOT_INCREASING = 4,
    REASON_LATE = 5,
    REASON_NOT_AT_REST = 6,
    REASON_TOO_FAR_FROM_START = 7,
    REASON_POSITION_LIMIT = 8,
    REASON_VELOCITY_LIMIT = 9,
    REASON_ACCELERATION_LIMIT = 10,
    REASON_TOO_LITTLE_PREFILL = 11,
    REASON_START_TIME = 12,
    REASON_KNOT_COUNT = 13,
    REASON_STILL_MOVING = 14,
    REASON_SEGMENT_TIME = 15,
    REASON_PRELOAD_LIMIT = 16,
    REASON_MOTOR_POSITION_LIMIT = 17,
    REASON_MOTOR_VELOCITY_LIMIT = 18,
    REASON_MOTOR_ACCELERATION_LIMIT = 19,
    REASON_IMPLAUSIBLE = 20,
};

struct hello {
    uint8_t nothing;
};

struct ask_limits {
    uint8_t nothing;
};

struct ping {
    uint64_t host_us;
};

struct hold {
    uint8_t nothing;
};

struct estop {
    uint8_t nothing;
};

struct ask_homing {
    uint8_t nothing;
};

struct arm {
    uint8_t nothing;
};

struct knot {
    uint64_t t_us;
    int32_t position_urad[MAX_JOINTS];
    int32_t velocity_urad_s[MAX_JOINTS];
    int32_t acceleration_urad_s2[MAX_JOINTS];
    int16_t preload_20urad[MAX_JOINTS];
};

struct start {
    uint64_t device_us;
};

struct end {
    uint32_t knots;
};

struct clear {
    uint8_t nothing;
};

struct home {
    uint8_t nothing;
};

struct calibrate {
    int32_t offset_urad[MAX_JOINTS];
};

struct welcome {
    uint8_t protocol;
    uint8_t joints;
    uint8_t state;
    uint8_t cause;
    uint16_t tick_hz;
    uint16_t buffer_knots;
    uint32_t boot_nonce;
    uint64_t configuration;
    uint8_t homed;
    uint32_t calibration;
    uint8_t build[16];
};

struct limits {
    int32_t lower_urad[MAX_JOINTS];
    int32_t upper_urad[MAX_JOINTS];
    int32_t velocity_urad_s[MAX_JOINTS];
    int32_t acceleration_urad_s2[MAX_JOINTS];
};

struct pong {
    uint64_t host_us;
    uint64_t device_us;
};

struct ack {
    uint16_t expected;
    uint16_t free_knots;
    uint8_t state;
};

struct nak {
    uint16_t expected;
};

struct refused {
    uint16_t seq;
    uint8_t command;
    uint8_t reason;
    uint8_t joint;
    uint8_t state;
    uint8_t cause;
};

struct no_session {
    uint32_t boot_nonce;
};

struct telemetry {
    uint64_t device_us;
    uint64_t path_us;
    uint8_t state;
    uint8_t cause;
    uint16_t rate_permille;
    uint16_t queued_knots;
    uint16_t bad_frames;
    int32_t position_urad[MAX_JOINTS];
    int32_t command_urad[MAX_JOINTS];
};

struct health {
    uint64_t device_us;
    uint16_t gaps;
    int16_t current_ma[MAX_JOINTS];
    int8_t temperature_c[MAX_JOINTS];
    int16_t preload_20urad[MAX_JOINTS];
};

struct homing_report {
    uint8_t outcome;
    uint8_t joint;
    int32_t offset_urad[MAX_JOINTS];
    int32_t lower_urad[MAX_JOINTS];
    int32_t upper_urad[MAX_JOINTS];
};

uint8_t encode_hello(const struct hello *in, uint8_t joints, uint8_t *payload);
bool decode_hello(const uint8_t *payload, uint8_t length, uint8_t *joints, struct hello *out);
uint8_t encode_ask_limits(const struct ask_limits *in, uint8_t joints, uint8_t *payload);
bool decode_ask_limits(const uint8_t *payload, uint8_t length, uint8_t *joints, struct ask_limits *out);
uint8_t encode_ping(const struct ping *in, uint8_t joints, uint8_t *payload);
bool decode_ping(const uint8_t *payload, uint8_t length, uint8_t *joints, struct ping *out);
uint8_t encode_hold(const struct hold *in, uint8_t joints, uint8_t *payload);
bool decode_hold(const uint8_t *payload, uint8_t length, uint8_t *joints, struct hold *out);
uint8_t encode_estop(const struct estop *in, uint8_t joints, uint8_t *payload);
bool decode_estop(const uint8_t *payload, uint8_t length, uint8_t *joints, struct estop *out);
uint8_t encode_ask_homing(const struct ask_homing *in, uint8_t joints, uint8_t *payload);
bool decode_ask_homing(const uint8_t *payload, uint8_t length, uint8_t *joints, struct ask_homing *out);
uint8_t encode_arm(const struct arm *in, uint8_t joints, uint8_t *payload);
bool decode_arm(const uint8_t *payload, uint8_t length, uint8_t *joints, struct arm *out);
uint8_t encode_knot(const struct knot *in, uint8_t joints, uint8_t *payload);
bool decode_knot(const uint8_t *payload, uint8_t length, uint8_t *joints, struct knot *out);
uint8_t encode_start(const struct start *in, uint8_t joints, uint8_t *payload);
bool decode_start(const uint8_t *payload, uint8_t length, uint8_t *joints, struct start *out);
uint8_t encode_end(const struct end *in, uint8_t joints, uint8_t *payload);
bool decode_end(const uint8_t *payload, uint8_t length, uint8_t *joints, struct end *out);
uint8_t encode_clear(const struct clear *in, uint8_t joints, uint8_t *payload);
bool decode_clear(const uint8_t *payload, uint8_t length, uint8_t *joints, struct clear *out);
uint8_t encode_home(const struct home *in, uint8_t joints, uint8_t *payload);
bool decode_home(const uint8_t *payload, uint8_t length, uint8_t *joints, struct home *out);
uint8_t encode_calibrate(const struct calibrate *in, uint8_t joints, uint8_t *payload);
bool decode_calibrate(const uint8_t *payload, uint8_t length, uint8_t *joints, struct calibrate *out);
uint8_t encode_welcome(const struct welcome *in, uint8_t joints, uint8_t *payload);
bool decode_welcome(const uint8_t *payload, uint8_t length, uint8_t *joints, struct welcome *out);
uint8_t encode_limits(const struct limits *in, uint8_t joints, uint8_t *payload);
bool decode_limits(const uint8_t *payload, uint8_t length, uint8_t *joints, struct limits *out);
uint8_t encode_pong(const struct pong *in, uint8_t joints, uint8_t *payload);
bool decode_pong(const uint8_t *payload, uint8_t length, uint8_t *joints, struct pong *out);
uint8_t encode_ack(const struct ack *in, uint8_t joints, uint8_t *payload);
bool decode_ack(const uint8_t *payload, uint8_t length, uint8_t *joints, struct ack *out);
uint8_t encode_nak(const struct nak *in, uint8_t joints, uint8_t *payload);
bool decode_nak(const uint8_t *payload, uint8_t length, uint8_t *joints, struct nak *out);
uint8_t encode_refused(const struct refused *in, uint8_t joints, uint8_t *payload);
bool decode_refused(const uint8_t *payload, uint8_t length, uint8_t *joints, struct refused *out);
uint8_t encode_no_session(const struct no_session *in, uint8_t joints, uint8_t *payload);
bool decode_no_session(const uint8_t *payload, uint8_t length, uint8_t *joints, struct no_session *out);
uint8_t encode_telemetry(const struct telemetry *in, uint8_t joints, uint8_t *payload);
bool decode_telemetry(const uint8_t *payload, uint8_t length, uint8_t *joints, struct telemetry *out);
uint8_t encode_health(const struct health *in, uint8_t joints, uint8_t *payload);
bool decode_health(const uint8_t *payload, uint8_t length, uint8_t *joints, struct health *out);
uint8_t encode_homing_report(const struct homing_report *in, uint8_t joints, uint8_t *payload);
bool decode_homing_report(const uint8_t *payload, uint8_t length, uint8_t *joints, struct homing_report *out);

#endif
