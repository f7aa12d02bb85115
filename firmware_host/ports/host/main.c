/* The firmware as a process: set-up on stdin up to a line `end`, its port's name on stdout.

   Stdin stays open as a lifeline. When it ends, or the host closes the port, the joints come to rest
   by the controller's own rules, then the process ends. */
#define _GNU_SOURCE /* ppoll, for waits below a millisecond */
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "simulated_board.h"
#include "terminal.h"

#define SETUP_BYTES 65536
/* When this process was starved for longer, the clock slips instead of jumping: a real board's
   would not have seen a gap between a frame's arrival and its reading. */
#define LONGEST_GAP_S 0.05
#define LAST_MOTION_S 3.0

struct process {
    struct device device;
    struct terminal terminal;
    FILE *record;
    bool mute, noisy;
    uint32_t boots;
};

static struct process process;

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static bool read_setup(char *text)
{
    size_t used = 0;
    while (used + 1 < SETUP_BYTES && read(STDIN_FILENO, text + used, 1) == 1) {
        text[++used] = 0;
        if (used >= 5 && strcmp(text + used - 5, "\nend\n") == 0) {
            text[used - 4] = 0;
            return true;
        }
    }
    return false;
}

static void happen(const struct mishap *mishap)
{
    const char *kind = mishap->kind;
    if (strcmp(kind, "silence") == 0) {
        process.mute = true;
    } else if (strcmp(kind, "garbage") == 0) {
        process.noisy = true;
    } else if (strcmp(kind, "reset") == 0) {
        device_boot(&process.device, process.device.simulation.setup.boot_nonce + ++process.boots);
    } else if (!device_mishap(&process.device, kind, (uint8_t)mishap->joint)) {
        fprintf(stderr, "fpcad-firmware: unknown mishap %s\n", kind);
    }
}

static void let_mishaps_happen(void)
{
    struct simulation *simulation = &process.device.simulation;
    for (int i = 0; i < simulation->mishap_count; i++) {
        struct mishap *mishap = &simulation->mishaps[i];
        if (mishap->kind[0] && mishap->at_s * 1e6 <= (double)process.device.controller.time_us) {
            happen(mishap);
            mishap->kind[0] = 0;
        }
    }
}

static void exchange(void)
{
    struct device *device = &process.device;
    uint8_t bytes[4096];
    size_t count = terminal_read(&process.terminal, bytes, sizeof bytes);
    for (size_t i = 0; i < count && !process.mute; i++) {
        controller_receive(&device->controller, bytes[i]);
    }
    if (process.mute || process.noisy) {
        for (uint32_t i = 0; i < device->output_used; i++) {
            device->output[i] = (uint8_t)rand();
        }
    }
    if (process.mute) {
        device->output_used = 0;
    }
    uint32_t sent =
        (uint32_t)terminal_write(&process.terminal, device->output, device->output_used);
    device->output_used -= sent;
    memmove(device->output, device->output + sent, device->output_used);
}

/* time [s], state, path rate, commands and positions of the joints [rad] */
static void write_record(void)
{
    const struct controller *controller = &process.device.controller;
    double row[3 + 2 * MAX_JOINTS] = {
        (double)controller->time_us * 1e-6, controller->state,
        (double)controller->follower.rate / FULL_RATE};
    uint8_t joints = process.device.simulation.setup.joints;
    for (uint8_t i = 0; i < joints; i++) {
        row[3 + i] = controller->follower.command[i] * 1e-6;
        row[3 + joints + i] = process.device.plant.joint[i];
    }
    fwrite(row, sizeof row[0], 3u + 2u * joints, process.record);
}

static void tick(void)
{
    controller_tick(&process.device.controller);
    if (process.record != NULL) {
        write_record();
    }
    let_mishaps_happen();
}

/* Waits for bytes or for time to pass; false once the host is found gone. */
static bool wait_for_host(double seconds)
{
    struct pollfd ends[2] = {
        {.fd = process.terminal.master, .events = POLLIN}, {.fd = STDIN_FILENO, .events = POLLIN}};
    struct timespec patience = {.tv_nsec = seconds > 0 ? (long)(seconds * 1e9) : 0};
    char byte;
    ppoll(ends, 2, &patience, NULL);
    bool cut = ends[1].revents && read(STDIN_FILENO, &byte, 1) <= 0;
    return process.terminal.open && !cut;
}

static bool moving(void)
{
    const struct controller *controller = &process.device.controller;
    return controller->state == STATE_RUNNING || controller->follower.rate > 0;
}

static void serve(void)
{
    const struct simulation *simulation = &process.device.simulation;
    double period = 1 / (simulation->setup.tick_hz * simulation->clock_rate);
    double due = now_s(), gone_at = 0;
    while (gone_at == 0 || (moving() && now_s() - gone_at < LAST_MOTION_S)) {
        double wait = due - now_s();
        if (gone_at == 0 && !wait_for_host(wait)) {
            gone_at = now_s();
        } else if (gone_at != 0 && wait > 0) {
            struct timespec rest = {.tv_nsec = (long)(wait * 1e9)};
            nanosleep(&rest, NULL);
        }
        exchange();
        double now = now_s();
        due = now - due > LONGEST_GAP_S ? now : due;
        for (; due <= now; due += period) {
            tick();
        }
    }
}

int main(void)
{
    static char setup[SETUP_BYTES];
    if (!read_setup(setup)) {
        fprintf(stderr, "fpcad-firmware: the set-up on stdin does not end with a line `end`\n");
        return 1;
    }
    const char *fault = device_make(&process.device, setup);
    if (fault != NULL || !terminal_make(&process.terminal)) {
        fprintf(stderr, "fpcad-firmware: %s\n", fault ? fault : "no pseudo terminal to be had");
        return 1;
    }
    const char *record = process.device.simulation.record;
    if (record[0] && (process.record = fopen(record, "wb")) == NULL) {
        perror(record);
        return 1;
    }
    let_mishaps_happen();
    printf("%s\n", process.terminal.name);
    fflush(stdout);
    serve();
    return process.record != NULL && fclose(process.record) != 0;
}
