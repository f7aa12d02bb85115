/* What commands do. Each either happens whole or leaves everything as it is. */
#ifndef COMMANDS_H
#define COMMANDS_H

#include "controller.h"

/* Carry out one sequenced command; false: it is refused, and controller->refusal says why. */
bool command_perform(struct controller *controller, const struct frame *frame);
void command_hold(struct controller *controller);
/* Torque off at once; the cause is the host or the hand's own switch. */
void command_estop(struct controller *controller, uint8_t cause);
/* Break off a search for zeros: none are known, torque is off. */
void command_stop_homing(struct controller *controller);
/* Slow down along the path, latched. */
void command_stop(struct controller *controller, uint8_t state, uint8_t cause);

#endif
