#include "sequence.h"

void sequence_reset(struct sequence *sequence)
{
    *sequence = (struct sequence){0};
}

enum turn sequence_turn(struct sequence *sequence, uint16_t seq)
{
    /* The cast keeps the difference modulo 2^16 where int is wider than 16 bits. */
    uint16_t ahead = (uint16_t)(seq - sequence->expected);
    if (ahead == 0) {
        sequence->gap_reported = false;
        return TURN_NOW;
    }
    if (ahead >= 0x8000) {
        return TURN_REPEAT;
    }
    if (sequence->gap_reported) {
        return TURN_GAP_KNOWN;
    }
    sequence->gap_reported = true;
    return TURN_GAP;
}

void sequence_done(struct sequence *sequence)
{
    sequence->expected++;
}
