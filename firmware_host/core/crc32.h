/* CRC-32 of zip and Ethernet: reflected 0xEDB88320, start and end inverted. */
#ifndef CRC32_H
#define CRC32_H

#include <stdint.h>

uint32_t crc32(const uint8_t *bytes, uint16_t count);

#endif
