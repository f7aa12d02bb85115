/* The controller's end of the reliable link: frames in order, each once, or a refusal for good. */
#ifndef SEQUENCE_H
#define SEQUENCE_H

#include <stdbool.h>
#include <stdint.h>

enum turn {
    TURN_NOW,      /* the next in line: perform it */
    TURN_REPEAT,   /* done before; its acknowledgement was lost */
    TURN_GAP,      /* frames are missing: report it */
    TURN_GAP_KNOWN /* the gap has been reported */
};

struct sequence {
    uint16_t expected;
    bool gap_reported;
};

void sequence_reset(struct sequence *sequence);
enum turn sequence_turn(struct sequence *sequence, uint16_t seq);
void sequence_done(struct sequence *sequence);

#endif
