/* The core as a shared library, so that tests run it in their own time. */
#ifndef BENCH_H
#define BENCH_H

#include "simulated_board.h"

/* What tests look at; tests/firmware/core.py has the same fields. */
struct view {
    uint64_t time_us;
    int64_t path_us;
    double rate;
    uint16_t queued;
    uint16_t free;
    uint16_t bad_frames;
    uint8_t state;
    uint8_t cause;
    uint8_t torque_on;
    int32_t command[MAX_JOINTS];
    int32_t command_velocity[MAX_JOINTS];
    int32_t preload[MAX_JOINTS];
    int32_t measured[MAX_JOINTS];
    double position[MAX_JOINTS];
    int16_t current_ma[MAX_JOINTS];
};

struct device *bench_new(const char *setup, const char **fault);
void bench_delete(struct device *device);
void bench_receive(struct device *device, const uint8_t *bytes, uint32_t count);
uint32_t bench_take_output(struct device *device, uint8_t *bytes, uint32_t room);
void bench_tick(struct device *device);
void bench_look(const struct device *device, struct view *view);
void bench_set_state(struct device *device, uint8_t state);
/* Kinds of device_mishap; 0 when there is no such kind. */
uint8_t bench_mishap(struct device *device, const char *kind, uint8_t number);
void bench_keep_knots(struct device *device, uint16_t count);
/* Segments of one joint: rows t0 p v a t1 p v a elapsed; results: rows p v a. */
void bench_quintic(const int64_t *rows, int32_t *results, uint32_t count);
/* Segments as above without elapsed, against one joint's limits (4 numbers), its motor's (4),
   the gain between them and its zero; results: reason. */
void bench_violation(
    const int64_t *rows, const int32_t *limits, uint8_t *reasons, uint32_t count);
/* A payload decoded and encoded again; its length, or 255 when it is refused. */
uint8_t bench_recode(uint8_t kind, const uint8_t *payload, uint8_t length, uint8_t *out);
uint8_t bench_frame(
    uint8_t kind, uint16_t seq, uint16_t session, const uint8_t *payload, uint8_t length,
    uint8_t *wire);
uint8_t bench_state_after(uint8_t state, uint8_t message);

#endif
