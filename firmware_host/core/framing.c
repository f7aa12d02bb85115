#include "framing.h"

#include "bytes.h"
#include "crc32.h"

_Static_assert(FRAME_MAX_DATA < 254, "a frame must fit in one COBS run");

static uint8_t cobs_encode(const uint8_t *data, uint8_t count, uint8_t *out)
{
    uint8_t used = 1, start = 0;
    for (uint8_t i = 0; i < count; i++) {
        if (data[i] == 0) {
            out[start] = (uint8_t)(used - start);
            start = used++;
        } else {
            out[used++] = data[i];
        }
    }
    out[start] = (uint8_t)(used - start);
    return used;
}

/* In place: a decoded byte is never written before the byte that it comes from has been read. */
static bool cobs_decode(uint8_t *block, uint8_t count, uint8_t *decoded)
{
    uint8_t at = 0, used = 0;
    while (at < count) {
        uint8_t code = block[at];
        if (code > count - at) {
            return false;
        }
        for (uint8_t i = 1; i < code; i++) {
            block[used++] = block[at + i];
        }
        at = (uint8_t)(at + code);
        if (at < count) {
            block[used++] = 0;
        }
    }
    *decoded = used;
    return true;
}

uint8_t frame_encode(const struct frame *frame, uint8_t *wire)
{
    uint8_t data[FRAME_MAX_DATA];
    uint8_t *at = put_u8(put_u8(data, frame->version), frame->kind);
    at = put_u16(put_u16(at, frame->seq), frame->session);
    at = put_bytes(at, frame->payload, frame->length);
    at = put_u32(at, crc32(data, (uint16_t)(at - data)));
    uint8_t used = cobs_encode(data, (uint8_t)(at - data), wire);
    wire[used] = 0;
    return (uint8_t)(used + 1);
}

static bool decode(uint8_t *block, uint8_t count, struct frame *frame)
{
    uint8_t length;
    if (!cobs_decode(block, count, &length) || length < FRAME_HEADER_BYTES + FRAME_CRC_BYTES) {
        return false;
    }
    uint8_t body = (uint8_t)(length - FRAME_CRC_BYTES);
    if (crc32(block, body) != get_u32(block + body)) {
        return false;
    }
    *frame = (struct frame){
        .version = block[0],
        .kind = block[1],
        .seq = get_u16(block + 2),
        .session = get_u16(block + 4),
        .length = (uint8_t)(body - FRAME_HEADER_BYTES),
        .payload = block + FRAME_HEADER_BYTES,
    };
    return true;
}

bool frame_reader_take(struct frame_reader *reader, uint8_t byte, struct frame *frame)
{
    if (byte != 0) {
        if (reader->used == FRAME_MAX_BLOCK) {
            reader->overlong = true;
        } else {
            reader->block[reader->used++] = byte;
        }
        return false;
    }
    uint8_t used = reader->used;
    bool overlong = reader->overlong;
    reader->used = 0;
    reader->overlong = false;
    if (used == 0) {
        return false;
    }
    if (overlong || !decode(reader->block, used, frame)) {
        reader->bad_frames++;
        return false;
    }
    return true;
}
