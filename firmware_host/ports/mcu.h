/* What one file of board support brings: a serial line, a tick, and rest between them. */
#ifndef MCU_H
#define MCU_H

#include <stdbool.h>
#include <stdint.h>

#define MAX_LATE_TICKS 10

/* Clocks, serial line (115200 baud, 8N1, received by interrupt) and `tick_hz` interrupts a second. */
void mcu_start(uint16_t tick_hz);
bool mcu_take_byte(uint8_t *byte);
/* Queues bytes for the line; waits while the queue is full. */
void mcu_put(const uint8_t *bytes, uint8_t count);
/* Whether a tick is due; late ones are made up for, MAX_LATE_TICKS at most. */
bool mcu_take_tick(void);
/* Whether the emergency switch is pressed, or its wire is broken. */
bool mcu_switch_pressed(void);
/* Sleep until an interrupt, unless there is something to do already. */
void mcu_rest(void);

#endif
