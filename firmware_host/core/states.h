/* Which command leads from which state to which; the table itself is generated. */
#ifndef STATES_H
#define STATES_H

#include <stdint.h>

#include "state_table.h"

/* The state after a command (message type), or REFUSED. */
uint8_t state_after(uint8_t state, uint8_t message);

#endif
