/* A board whose motors are the plant; bytes for the host go into a buffer. */
#ifndef SIMULATED_BOARD_H
#define SIMULATED_BOARD_H

#include "board.h"
#include "controller.h"
#include "motor_tendon.h"
#include "setup_text.h"

#define OUTPUT_BYTES 65536

struct device {
    struct simulation simulation;
    struct board board;
    struct plant plant;
    struct controller controller;
    uint8_t output[OUTPUT_BYTES];
    uint32_t output_used;
    uint32_t lost_bytes; /* that the host did not fetch in time */
};

/* NULL, or a line of what is wrong with the set-up. */
const char *device_make(struct device *device, char *setup);
/* Let one motor or joint fail: jam, death, stuck, weak, heat, reversed (motors); wedge, no_stop (joints).
   False for a kind that is none of these. */
bool device_mishap(struct device *device, const char *kind, uint8_t number);
/* A reset of the controller; the hand stays where it is. */
void device_boot(struct device *device, uint32_t boot_nonce);

#endif
