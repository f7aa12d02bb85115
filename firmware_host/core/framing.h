/* Frames on the wire: COBS with a zero delimiter around a header, a payload and a CRC-32. */
#ifndef FRAMING_H
#define FRAMING_H

#include <stdbool.h>
#include <stdint.h>

#include "messages.h"

#define FRAME_HEADER_BYTES 6
#define FRAME_CRC_BYTES 4
#define FRAME_MAX_DATA (FRAME_HEADER_BYTES + MAX_PAYLOAD + FRAME_CRC_BYTES)
/* COBS costs one byte below 254; the delimiter is not counted. */
#define FRAME_MAX_BLOCK (FRAME_MAX_DATA + 1)
#define FRAME_MAX_WIRE (FRAME_MAX_BLOCK + 1)

struct frame {
    uint8_t version;
    uint8_t kind;
    uint16_t seq;
    uint16_t session;
    uint8_t length;
    const uint8_t *payload;
};

struct frame_reader {
    uint8_t block[FRAME_MAX_BLOCK];
    uint8_t used;
    bool overlong;
    uint16_t bad_frames;
};

/* Bytes written to `wire` (FRAME_MAX_WIRE of room), delimiter included. */
uint8_t frame_encode(const struct frame *frame, uint8_t *wire);

/* Takes one byte. True when it completes a good frame, which lives in the reader's block until
   the next byte is taken. */
bool frame_reader_take(struct frame_reader *reader, uint8_t byte, struct frame *frame);

#endif
