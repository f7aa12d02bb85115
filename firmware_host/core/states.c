#include "states.h"

static uint8_t command_of(uint8_t message)
{
    switch (message) {
    case MESSAGE_HOLD:
        return COMMAND_HOLD;
    case MESSAGE_ESTOP:
        return COMMAND_ESTOP;
    case MESSAGE_ARM:
        return COMMAND_ARM;
    case MESSAGE_KNOT:
        return COMMAND_KNOT;
    case MESSAGE_START:
        return COMMAND_START;
    case MESSAGE_END:
        return COMMAND_END;
    case MESSAGE_CLEAR:
        return COMMAND_CLEAR;
    case MESSAGE_HOME:
        return COMMAND_HOME;
    case MESSAGE_CALIBRATE:
        return COMMAND_CALIBRATE;
    default:
        return COMMAND_COUNT;
    }
}

uint8_t state_after(uint8_t state, uint8_t message)
{
    uint8_t command = command_of(message);
    if (state > STATE_ESTOP || command == COMMAND_COUNT) {
        return REFUSED;
    }
    return STATE_TABLE[state][command];
}
