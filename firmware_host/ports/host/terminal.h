/* The controller's side of a pseudo terminal. */
#ifndef TERMINAL_H
#define TERMINAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct terminal {
    int master;
    int slave; /* held until the host speaks, so that its end is noticed from then on */
    bool open;
    char name[64];
};

bool terminal_make(struct terminal *terminal);
/* Bytes that the host wrote; clears `open` when the host has closed the port. */
size_t terminal_read(struct terminal *terminal, uint8_t *bytes, size_t room);
/* Bytes taken of `count`. */
size_t terminal_write(struct terminal *terminal, const uint8_t *bytes, size_t count);

#endif
