#include "dynamixel_packet.h"

#include <string.h>

#include "bytes.h"

#define STATUS 0x55

uint16_t dynamixel_crc(const uint8_t *bytes, uint8_t count)
{
    uint16_t crc = 0;
    while (count-- > 0) {
        crc = (uint16_t)(crc ^ (uint16_t)(*bytes++ << 8));
        for (uint8_t bit = 0; bit < 8; bit++) {
            crc = (uint16_t)(crc & 0x8000 ? crc << 1 ^ 0x8005 : crc << 1);
        }
    }
    return crc;
}

static bool looks_like_header(const uint8_t *at)
{
    return at[0] == 0xff && at[1] == 0xff && at[2] == 0xfd;
}

uint8_t dynamixel_frame(uint8_t *packet, uint8_t id, uint8_t instruction, uint8_t count)
{
    static const uint8_t HEADER[4] = {0xff, 0xff, 0xfd, 0};
    put_bytes(packet, HEADER, sizeof HEADER);
    packet[4] = id;
    packet[7] = instruction;
    uint8_t end = (uint8_t)(DYNAMIXEL_HEAD + count);
    /* What looks like a header within gets a further byte, which the other side takes out again. */
    for (uint8_t i = DYNAMIXEL_HEAD; i + 3 <= end; i++) {
        if (looks_like_header(packet + i)) {
            memmove(packet + i + 4, packet + i + 3, (size_t)(end - i - 3));
            packet[i + 3] = 0xfd;
            end++;
            i = (uint8_t)(i + 3);
        }
    }
    put_u16(packet + 5, (uint16_t)(end - 5));
    put_u16(packet + end, dynamixel_crc(packet, end));
    return (uint8_t)(end + DYNAMIXEL_TAIL);
}

/* Takes stuffing out of parameters; their new length. */
static uint8_t unstuffed(uint8_t *bytes, uint8_t count)
{
    for (uint8_t i = 0; i + 4 <= count; i++) {
        if (looks_like_header(bytes + i) && bytes[i + 3] == 0xfd) {
            memmove(bytes + i + 3, bytes + i + 4, (size_t)(count - i - 4));
            count--;
        }
    }
    return count;
}

bool dynamixel_open(uint8_t *answer, uint8_t length, uint8_t id, uint8_t count)
{
    if (length < DYNAMIXEL_HEAD + 1 + DYNAMIXEL_TAIL || !looks_like_header(answer) ||
        answer[3] != 0 || answer[4] != id || get_u16(answer + 5) != (uint16_t)(length - 7) ||
        answer[7] != STATUS || answer[8] != 0) {
        return false;
    }
    uint8_t end = (uint8_t)(length - DYNAMIXEL_TAIL);
    if (get_u16(answer + end) != dynamixel_crc(answer, end)) {
        return false;
    }
    uint8_t *parameters = answer + DYNAMIXEL_HEAD + 1;
    return unstuffed(parameters, (uint8_t)(end - DYNAMIXEL_HEAD - 1)) == count;
}
