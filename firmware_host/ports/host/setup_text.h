/* Reads a set-up from lines `name numbers`, as fpcad/run/firmware_setup.py writes them. */
#ifndef SETUP_TEXT_H
#define SETUP_TEXT_H

#include "hand_setup.h"

#define MAX_MISHAPS 16

struct mishap {
    char kind[16];
    double at_s;
    int joint;
};

struct simulation {
    struct hand_setup setup;
    double start_rad[MAX_JOINTS];
    double clock_rate;
    double encoder_step;
    double zero_error[MAX_JOINTS]; /* by which motors' zeros are off the design's [rad] */
    struct mishap mishaps[MAX_MISHAPS];
    int mishap_count;
    char record[4096]; /* file for what the joints did; empty: none */
};

/* NULL, or a line of what is wrong. `text` is changed. */
const char *setup_from_text(char *text, struct simulation *out);

#endif
