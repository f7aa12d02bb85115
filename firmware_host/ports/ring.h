/* A queue of bytes between an interrupt and the main loop: one side puts, the other takes. */
#ifndef RING_H
#define RING_H

#include <stdbool.h>
#include <stdint.h>

/* Holds what may be on the way at once (256 bytes) while a tick keeps the main loop busy. */
#define RING_BYTES 512

struct ring {
    volatile uint16_t head;
    volatile uint16_t tail;
    uint8_t bytes[RING_BYTES];
};

static inline bool ring_put(struct ring *ring, uint8_t byte)
{
    uint16_t next = (uint16_t)((ring->head + 1) % RING_BYTES);
    if (next == ring->tail) {
        return false;
    }
    ring->bytes[ring->head] = byte;
    ring->head = next;
    return true;
}

static inline bool ring_take(struct ring *ring, uint8_t *byte)
{
    if (ring->tail == ring->head) {
        return false;
    }
    *byte = ring->bytes[ring->tail];
    ring->tail = (uint16_t)((ring->tail + 1) % RING_BYTES);
    return true;
}

#endif
