/* Written by firmware_host/tools/generate.py from fpcad/run/messages.py; do not edit. */
#include "messages.h"

#include "bytes.h"

uint8_t encode_hello(const struct hello *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    (void)joints;
    (void)in;
    return (uint8_t)(at - payload);
}

bool decode_hello(const uint8_t *payload, uint8_t length, uint8_t *joints, struct hello *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 0);
    if (rest) {
        return false;
    }
    *joints = 0;
    (void)out;
    (void)at;
    return true;
}

uint8_t encode_ask_limits(const struct ask_limits *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    (void)joints;
    (void)in;
    return (uint8_t)(at - payload);
}

bool decode_ask_limits(const uint8_t *payload, uint8_t length, uint8_t *joints, struct ask_limits *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 0);
    if (rest) {
        return false;
    }
    *joints = 0;
    (void)out;
    (void)at;
    return true;
}

uint8_t encode_ping(const struct ping *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u64(at, (uint64_t)in->host_us);
    (void)joints;
    return (uint8_t)(at - payload);
}

bool decode_ping(const uint8_t *payload, uint8_t length, uint8_t *joints, struct ping *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 8);
    if (rest) {
        return false;
    }
    *joints = 0;
    out->host_us = (uint64_t)get_u64(at); at += 8;
    (void)at;
    return true;
}

uint8_t encode_hold(const struct hold *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    (void)joints;
    (void)in;
    return (uint8_t)(at - payload);
}

bool decode_hold(const uint8_t *payload, uint8_t length, uint8_t *joints, struct hold *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 0);
    if (rest) {
        return false;
    }
    *joints = 0;
    (void)out;
    (void)at;
    return true;
}

uint8_t encode_estop(const struct estop *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    (void)joints;
    (void)in;
    return (uint8_t)(at - payload);
}

bool decode_estop(const uint8_t *payload, uint8_t length, uint8_t *joints, struct estop *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 0);
    if (rest) {
        return false;
    }
    *joints = 0;
    (void)out;
    (void)at;
    return true;
}

uint8_t encode_ask_homing(const struct ask_homing *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    (void)joints;
    (void)in;
    return (uint8_t)(at - payload);
}

bool decode_ask_homing(const uint8_t *payload, uint8_t length, uint8_t *joints, struct ask_homing *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 0);
    if (rest) {
        return false;
    }
    *joints = 0;
    (void)out;
    (void)at;
    return true;
}

uint8_t encode_arm(const struct arm *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    (void)joints;
    (void)in;
    return (uint8_t)(at - payload);
}

bool decode_arm(const uint8_t *payload, uint8_t length, uint8_t *joints, struct arm *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 0);
    if (rest) {
        return false;
    }
    *joints = 0;
    (void)out;
    (void)at;
    return true;
}

uint8_t encode_knot(const struct knot *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u64(at, (uint64_t)in->t_us);
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->position_urad[i]);
    }
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->velocity_urad_s[i]);
    }
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->acceleration_urad_s2[i]);
    }
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u16(at, (uint16_t)in->preload_20urad[i]);
    }
    return (uint8_t)(at - payload);
}

bool decode_knot(const uint8_t *payload, uint8_t length, uint8_t *joints, struct knot *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 8);
    if (rest < 0 || rest % 14 || rest / 14 > MAX_JOINTS) {
        return false;
    }
    *joints = (uint8_t)(rest / 14);
    out->t_us = (uint64_t)get_u64(at); at += 8;
    for (uint8_t i = 0; i < *joints; i++) {
        out->position_urad[i] = (int32_t)get_u32(at); at += 4;
    }
    for (uint8_t i = 0; i < *joints; i++) {
        out->velocity_urad_s[i] = (int32_t)get_u32(at); at += 4;
    }
    for (uint8_t i = 0; i < *joints; i++) {
        out->acceleration_urad_s2[i] = (int32_t)get_u32(at); at += 4;
    }
    for (uint8_t i = 0; i < *joints; i++) {
        out->preload_20urad[i] = (int16_t)get_u16(at); at += 2;
    }
    (void)at;
    return true;
}

uint8_t encode_start(const struct start *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u64(at, (uint64_t)in->device_us);
    (void)joints;
    return (uint8_t)(at - payload);
}

bool decode_start(const uint8_t *payload, uint8_t length, uint8_t *joints, struct start *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 8);
    if (rest) {
        return false;
    }
    *joints = 0;
    out->device_us = (uint64_t)get_u64(at); at += 8;
    (void)at;
    return true;
}

uint8_t encode_end(const struct end *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u32(at, (uint32_t)in->knots);
    (void)joints;
    return (uint8_t)(at - payload);
}

bool decode_end(const uint8_t *payload, uint8_t length, uint8_t *joints, struct end *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 4);
    if (rest) {
        return false;
    }
    *joints = 0;
    out->knots = (uint32_t)get_u32(at); at += 4;
    (void)at;
    return true;
}

uint8_t encode_clear(const struct clear *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    (void)joints;
    (void)in;
    return (uint8_t)(at - payload);
}

bool decode_clear(const uint8_t *payload, uint8_t length, uint8_t *joints, struct clear *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 0);
    if (rest) {
        return false;
    }
    *joints = 0;
    (void)out;
    (void)at;
    return true;
}

uint8_t encode_home(const struct home *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    (void)joints;
    (void)in;
    return (uint8_t)(at - payload);
}

bool decode_home(const uint8_t *payload, uint8_t length, uint8_t *joints, struct home *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 0);
    if (rest) {
        return false;
    }
    *joints = 0;
    (void)out;
    (void)at;
    return true;
}

uint8_t encode_calibrate(const struct calibrate *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->offset_urad[i]);
    }
    (void)in;
    return (uint8_t)(at - payload);
}

bool decode_calibrate(const uint8_t *payload, uint8_t length, uint8_t *joints, struct calibrate *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 0);
    if (rest < 0 || rest % 4 || rest / 4 > MAX_JOINTS) {
        return false;
    }
    *joints = (uint8_t)(rest / 4);
    for (uint8_t i = 0; i < *joints; i++) {
        out->offset_urad[i] = (int32_t)get_u32(at); at += 4;
    }
    (void)at;
    return true;
}

uint8_t encode_welcome(const struct welcome *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u8(at, (uint8_t)in->protocol);
    at = put_u8(at, (uint8_t)in->joints);
    at = put_u8(at, (uint8_t)in->state);
    at = put_u8(at, (uint8_t)in->cause);
    at = put_u16(at, (uint16_t)in->tick_hz);
    at = put_u16(at, (uint16_t)in->buffer_knots);
    at = put_u32(at, (uint32_t)in->boot_nonce);
    at = put_u64(at, (uint64_t)in->configuration);
    at = put_u8(at, (uint8_t)in->homed);
    at = put_u32(at, (uint32_t)in->calibration);
    at = put_bytes(at, in->build, 16);
    (void)joints;
    return (uint8_t)(at - payload);
}

bool decode_welcome(const uint8_t *payload, uint8_t length, uint8_t *joints, struct welcome *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 41);
    if (rest) {
        return false;
    }
    *joints = 0;
    out->protocol = (uint8_t)get_u8(at); at += 1;
    out->joints = (uint8_t)get_u8(at); at += 1;
    out->state = (uint8_t)get_u8(at); at += 1;
    out->cause = (uint8_t)get_u8(at); at += 1;
    out->tick_hz = (uint16_t)get_u16(at); at += 2;
    out->buffer_knots = (uint16_t)get_u16(at); at += 2;
    out->boot_nonce = (uint32_t)get_u32(at); at += 4;
    out->configuration = (uint64_t)get_u64(at); at += 8;
    out->homed = (uint8_t)get_u8(at); at += 1;
    out->calibration = (uint32_t)get_u32(at); at += 4;
    at = get_bytes(at, out->build, 16);
    (void)at;
    return true;
}

uint8_t encode_limits(const struct limits *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->lower_urad[i]);
    }
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->upper_urad[i]);
    }
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->velocity_urad_s[i]);
    }
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->acceleration_urad_s2[i]);
    }
    (void)in;
    return (uint8_t)(at - payload);
}

bool decode_limits(const uint8_t *payload, uint8_t length, uint8_t *joints, struct limits *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 0);
    if (rest < 0 || rest % 16 || rest / 16 > MAX_JOINTS) {
        return false;
    }
    *joints = (uint8_t)(rest / 16);
    for (uint8_t i = 0; i < *joints; i++) {
        out->lower_urad[i] = (int32_t)get_u32(at); at += 4;
    }
    for (uint8_t i = 0; i < *joints; i++) {
        out->upper_urad[i] = (int32_t)get_u32(at); at += 4;
    }
    for (uint8_t i = 0; i < *joints; i++) {
        out->velocity_urad_s[i] = (int32_t)get_u32(at); at += 4;
    }
    for (uint8_t i = 0; i < *joints; i++) {
        out->acceleration_urad_s2[i] = (int32_t)get_u32(at); at += 4;
    }
    (void)at;
    return true;
}

uint8_t encode_pong(const struct pong *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u64(at, (uint64_t)in->host_us);
    at = put_u64(at, (uint64_t)in->device_us);
    (void)joints;
    return (uint8_t)(at - payload);
}

bool decode_pong(const uint8_t *payload, uint8_t length, uint8_t *joints, struct pong *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 16);
    if (rest) {
        return false;
    }
    *joints = 0;
    out->host_us = (uint64_t)get_u64(at); at += 8;
    out->device_us = (uint64_t)get_u64(at); at += 8;
    (void)at;
    return true;
}

uint8_t encode_ack(const struct ack *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u16(at, (uint16_t)in->expected);
    at = put_u16(at, (uint16_t)in->free_knots);
    at = put_u8(at, (uint8_t)in->state);
    (void)joints;
    return (uint8_t)(at - payload);
}

bool decode_ack(const uint8_t *payload, uint8_t length, uint8_t *joints, struct ack *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 5);
    if (rest) {
        return false;
    }
    *joints = 0;
    out->expected = (uint16_t)get_u16(at); at += 2;
    out->free_knots = (uint16_t)get_u16(at); at += 2;
    out->state = (uint8_t)get_u8(at); at += 1;
    (void)at;
    return true;
}

uint8_t encode_nak(const struct nak *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u16(at, (uint16_t)in->expected);
    (void)joints;
    return (uint8_t)(at - payload);
}

bool decode_nak(const uint8_t *payload, uint8_t length, uint8_t *joints, struct nak *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 2);
    if (rest) {
        return false;
    }
    *joints = 0;
    out->expected = (uint16_t)get_u16(at); at += 2;
    (void)at;
    return true;
}

uint8_t encode_refused(const struct refused *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u16(at, (uint16_t)in->seq);
    at = put_u8(at, (uint8_t)in->command);
    at = put_u8(at, (uint8_t)in->reason);
    at = put_u8(at, (uint8_t)in->joint);
    at = put_u8(at, (uint8_t)in->state);
    at = put_u8(at, (uint8_t)in->cause);
    (void)joints;
    return (uint8_t)(at - payload);
}

bool decode_refused(const uint8_t *payload, uint8_t length, uint8_t *joints, struct refused *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 7);
    if (rest) {
        return false;
    }
    *joints = 0;
    out->seq = (uint16_t)get_u16(at); at += 2;
    out->command = (uint8_t)get_u8(at); at += 1;
    out->reason = (uint8_t)get_u8(at); at += 1;
    out->joint = (uint8_t)get_u8(at); at += 1;
    out->state = (uint8_t)get_u8(at); at += 1;
    out->cause = (uint8_t)get_u8(at); at += 1;
    (void)at;
    return true;
}

uint8_t encode_no_session(const struct no_session *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u32(at, (uint32_t)in->boot_nonce);
    (void)joints;
    return (uint8_t)(at - payload);
}

bool decode_no_session(const uint8_t *payload, uint8_t length, uint8_t *joints, struct no_session *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 4);
    if (rest) {
        return false;
    }
    *joints = 0;
    out->boot_nonce = (uint32_t)get_u32(at); at += 4;
    (void)at;
    return true;
}

uint8_t encode_telemetry(const struct telemetry *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u64(at, (uint64_t)in->device_us);
    at = put_u64(at, (uint64_t)in->path_us);
    at = put_u8(at, (uint8_t)in->state);
    at = put_u8(at, (uint8_t)in->cause);
    at = put_u16(at, (uint16_t)in->rate_permille);
    at = put_u16(at, (uint16_t)in->queued_knots);
    at = put_u16(at, (uint16_t)in->bad_frames);
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->position_urad[i]);
    }
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->command_urad[i]);
    }
    return (uint8_t)(at - payload);
}

bool decode_telemetry(const uint8_t *payload, uint8_t length, uint8_t *joints, struct telemetry *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 24);
    if (rest < 0 || rest % 8 || rest / 8 > MAX_JOINTS) {
        return false;
    }
    *joints = (uint8_t)(rest / 8);
    out->device_us = (uint64_t)get_u64(at); at += 8;
    out->path_us = (uint64_t)get_u64(at); at += 8;
    out->state = (uint8_t)get_u8(at); at += 1;
    out->cause = (uint8_t)get_u8(at); at += 1;
    out->rate_permille = (uint16_t)get_u16(at); at += 2;
    out->queued_knots = (uint16_t)get_u16(at); at += 2;
    out->bad_frames = (uint16_t)get_u16(at); at += 2;
    for (uint8_t i = 0; i < *joints; i++) {
        out->position_urad[i] = (int32_t)get_u32(at); at += 4;
    }
    for (uint8_t i = 0; i < *joints; i++) {
        out->command_urad[i] = (int32_t)get_u32(at); at += 4;
    }
    (void)at;
    return true;
}

uint8_t encode_health(const struct health *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u64(at, (uint64_t)in->device_us);
    at = put_u16(at, (uint16_t)in->gaps);
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u16(at, (uint16_t)in->current_ma[i]);
    }
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u8(at, (uint8_t)in->temperature_c[i]);
    }
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u16(at, (uint16_t)in->preload_20urad[i]);
    }
    return (uint8_t)(at - payload);
}

bool decode_health(const uint8_t *payload, uint8_t length, uint8_t *joints, struct health *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 10);
    if (rest < 0 || rest % 5 || rest / 5 > MAX_JOINTS) {
        return false;
    }
    *joints = (uint8_t)(rest / 5);
    out->device_us = (uint64_t)get_u64(at); at += 8;
    out->gaps = (uint16_t)get_u16(at); at += 2;
    for (uint8_t i = 0; i < *joints; i++) {
        out->current_ma[i] = (int16_t)get_u16(at); at += 2;
    }
    for (uint8_t i = 0; i < *joints; i++) {
        out->temperature_c[i] = (int8_t)get_u8(at); at += 1;
    }
    for (uint8_t i = 0; i < *joints; i++) {
        out->preload_20urad[i] = (int16_t)get_u16(at); at += 2;
    }
    (void)at;
    return true;
}

uint8_t encode_homing_report(const struct homing_report *in, uint8_t joints, uint8_t *payload)
{
    uint8_t *at = payload;
    at = put_u8(at, (uint8_t)in->outcome);
    at = put_u8(at, (uint8_t)in->joint);
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->offset_urad[i]);
    }
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->lower_urad[i]);
    }
    for (uint8_t i = 0; i < joints; i++) {
        at = put_u32(at, (uint32_t)in->upper_urad[i]);
    }
    return (uint8_t)(at - payload);
}

bool decode_homing_report(const uint8_t *payload, uint8_t length, uint8_t *joints, struct homing_report *out)
{
    const uint8_t *at = payload;
    int16_t rest = (int16_t)(length - 2);
    if (rest < 0 || rest % 12 || rest / 12 > MAX_JOINTS) {
        return false;
    }
    *joints = (uint8_t)(rest / 12);
    out->outcome = (uint8_t)get_u8(at); at += 1;
    out->joint = (uint8_t)get_u8(at); at += 1;
    for (uint8_t i = 0; i < *joints; i++) {
        out->offset_urad[i] = (int32_t)get_u32(at); at += 4;
    }
    for (uint8_t i = 0; i < *joints; i++) {
        out->lower_urad[i] = (int32_t)get_u32(at); at += 4;
    }
    for (uint8_t i = 0; i < *joints; i++) {
        out->upper_urad[i] = (int32_t)get_u32(at); at += 4;
    }
    (void)at;
    return true;
}
