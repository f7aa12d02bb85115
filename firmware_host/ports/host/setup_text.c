#define _POSIX_C_SOURCE 200809L
#include "setup_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "follower.h"

/* Where a line's integers go: `count` of them, 1 for a scalar. */
struct target {
    const char *name;
    void *at;
    uint8_t bytes;
    int count;
};

static bool put_integer(const struct target *target, int index, const char *word)
{
    char *end;
    /* The hash fills 64 bits; all else is signed and fits. */
    uint64_t value = word[0] == '-' ? (uint64_t)strtoll(word, &end, 10) : strtoull(word, &end, 10);
    memcpy((char *)target->at + index * target->bytes, &value, target->bytes);
    return *end == 0;
}

static const char *take_integers(const struct target *target, char **rest)
{
    static char message[80];
    for (int i = 0; i < target->count; i++) {
        char *word = strtok_r(NULL, " ", rest);
        if (word == NULL || !put_integer(target, i, word)) {
            snprintf(message, sizeof message, "%s: too few numbers, or none", target->name);
            return message;
        }
    }
    return NULL;
}

static const char *take_gains(int32_t gains[MAX_JOINTS][MAX_GROUP], const struct hand_setup *setup, char **rest)
{
    for (uint8_t i = 0; i < setup->joints; i++) {
        struct target row = {"gain", gains[i], 4, setup->transmission.group};
        const char *fault = take_integers(&row, rest);
        if (fault != NULL) {
            return fault;
        }
    }
    return NULL;
}

static void take_reals(double *out, int count, char *word, char **rest)
{
    for (int i = 0; i < count && word != NULL; i++) {
        out[i] = atof(word);
        word = strtok_r(NULL, " ", rest);
    }
}

static const char *take_other(struct simulation *out, const char *name, char **rest)
{
    if (strcmp(name, "gain") == 0) {
        return take_gains(out->setup.transmission.gain, &out->setup, rest);
    }
    if (strcmp(name, "inverse") == 0) {
        return take_gains(out->setup.transmission.inverse, &out->setup, rest);
    }
    char *word = strtok_r(NULL, " ", rest);
    if (word == NULL) {
        return "a line without a value";
    }
    if (strcmp(name, "start_rad") == 0) {
        take_reals(out->start_rad, out->setup.joints, word, rest);
    } else if (strcmp(name, "zero_error") == 0) {
        take_reals(out->zero_error, out->setup.joints, word, rest);
    } else if (strcmp(name, "clock_rate") == 0) {
        out->clock_rate = atof(word);
    } else if (strcmp(name, "encoder_step") == 0) {
        out->encoder_step = atof(word);
    } else if (strcmp(name, "record") == 0) {
        snprintf(out->record, sizeof out->record, "%s", word);
    } else if (strcmp(name, "mishap") == 0 && out->mishap_count < MAX_MISHAPS) {
        struct mishap *mishap = &out->mishaps[out->mishap_count++];
        char *at = strtok_r(NULL, " ", rest), *joint = strtok_r(NULL, " ", rest);
        snprintf(mishap->kind, sizeof mishap->kind, "%s", word);
        mishap->at_s = at == NULL ? 0 : atof(at);
        mishap->joint = joint == NULL ? 0 : atoi(joint);
    } else {
        return "an unknown name";
    }
    return NULL;
}

static const char *take_line(struct simulation *out, char *line)
{
    struct hand_setup *s = &out->setup;
    struct joint_limits *l = &s->limits, *m = &s->motor_limits;
    const struct target targets[] = {
        {"joints", &s->joints, 1, 1},
        {"homed", &s->homed, 1, 1},
        {"protocol", &s->protocol, 1, 1},
        {"tick_hz", &s->tick_hz, 2, 1},
        {"buffer_knots", &s->buffer_knots, 2, 1},
        {"boot_nonce", &s->boot_nonce, 4, 1},
        {"configuration", &s->configuration, 8, 1},
        {"build", s->build, 1, 16},
        {"silence_us", &s->silence_us, 4, 1},
        {"tracking_error", &s->tracking_error, 4, 1},
        {"current_ma", &s->current_ma, 2, 1},
        {"temperature_c", &s->temperature_c, 1, 1},
        {"hold_ma", &s->hold_ma, 2, 1},
        {"lower", l->lower, 4, s->joints},
        {"upper", l->upper, 4, s->joints},
        {"velocity", l->velocity, 4, s->joints},
        {"acceleration", l->acceleration, 4, s->joints},
        {"motor_lower", m->lower, 4, s->joints},
        {"motor_upper", m->upper, 4, s->joints},
        {"motor_velocity", m->velocity, 4, s->joints},
        {"motor_acceleration", m->acceleration, 4, s->joints},
        {"homing_lower", s->homing.lower, 4, s->joints},
        {"homing_upper", s->homing.upper, 4, s->joints},
        {"homing_speed", &s->homing.speed, 4, 1},
        {"homing_ma", &s->homing.current_ma, 2, 1},
        {"preload_limit", &s->preload.limit, 4, 1},
        {"preload_rate", &s->preload.rate, 4, 1},
        {"group", &s->transmission.group, 1, 1},
        {"offset", s->transmission.offset, 4, s->joints},
    };
    char *rest;
    const char *name = strtok_r(line, " ", &rest);
    for (size_t i = 0; name != NULL && i < sizeof targets / sizeof targets[0]; i++) {
        if (strcmp(name, targets[i].name) == 0) {
            return take_integers(&targets[i], &rest);
        }
    }
    return name == NULL ? NULL : take_other(out, name, &rest);
}

static const char *check(const struct hand_setup *setup)
{
    if (setup->joints < 1 || setup->joints > MAX_JOINTS) {
        return "joints: out of range";
    }
    if (setup->transmission.group < 1 || setup->transmission.group > MAX_GROUP ||
        setup->joints % setup->transmission.group) {
        return "group: must divide the joints";
    }
    if (setup->buffer_knots < 2 || setup->buffer_knots > QUEUE_KNOTS) {
        return "buffer_knots: out of range";
    }
    return setup->tick_hz < 10 || 1000000 % setup->tick_hz ? "tick_hz: must divide 1e6" : NULL;
}

const char *setup_from_text(char *text, struct simulation *out)
{
    char *rest;
    memset(out, 0, sizeof *out);
    out->clock_rate = 1;
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        const char *fault = take_line(out, line);
        if (fault != NULL) {
            return fault;
        }
        if (out->setup.joints > MAX_JOINTS || out->setup.transmission.group > MAX_GROUP) {
            return "joints or group: too many";
        }
    }
    return check(&out->setup);
}
