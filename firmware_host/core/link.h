/* Sessions: who may command, what is answered to whom, and what counts as heard. */
#ifndef LINK_H
#define LINK_H

#include "controller.h"

/* Act on a good frame, with one answer at most. */
void link_take(struct controller *controller, const struct frame *frame);
/* Send a payload to the present session, or to `session`. */
void link_send(
    struct controller *controller, uint8_t kind, uint16_t session, const uint8_t *payload,
    uint8_t length);

#endif
