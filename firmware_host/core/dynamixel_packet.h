/* Packets of Dynamixel's protocol 2.0: header, id, length, instruction, stuffed parameters, CRC-16. */
#ifndef DYNAMIXEL_PACKET_H
#define DYNAMIXEL_PACKET_H

#include <stdbool.h>
#include <stdint.h>

#define DYNAMIXEL_HEAD 8 /* up to and with the instruction */
#define DYNAMIXEL_TAIL 2

uint16_t dynamixel_crc(const uint8_t *bytes, uint8_t count);
/* Frames `count` parameters that stand behind DYNAMIXEL_HEAD bytes of `packet`, which has a third
   more room for stuffing; returns the packet's length. */
uint8_t dynamixel_frame(uint8_t *packet, uint8_t id, uint8_t instruction, uint8_t count);
/* Opens an answer in place: true when it is whole, from `id`, without error and holds `count` bytes,
   which then stand behind its first DYNAMIXEL_HEAD + 1. */
bool dynamixel_open(uint8_t *answer, uint8_t length, uint8_t id, uint8_t count);

#endif
