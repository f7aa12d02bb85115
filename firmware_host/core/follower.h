/* Follows queued knots in time, and can leave time behind: it slows down along the path. */
#ifndef FOLLOWER_H
#define FOLLOWER_H

#include <stdbool.h>
#include <stdint.h>

#include "hand_setup.h"
#include "limits.h"
#include "quintic.h"

#ifndef QUEUE_KNOTS
#define QUEUE_KNOTS 64
#endif

#define FULL_RATE ((int32_t)1 << 30)

struct follower {
    const struct hand_setup *setup;
    const int32_t *offset; /* the motors' zeros in use */
    struct knot queue[QUEUE_KNOTS];
    uint16_t first;
    uint16_t queued;
    uint32_t accepted;
    struct quintic segment[MAX_JOINTS];
    struct span span;   /* of the present segment; us 0: its quintics are not made yet */
    int64_t path;       /* place on the path [2^-16 us] */
    int32_t rate;       /* pace along the path [2^-30] */
    bool stopping;
    bool ended;
    int32_t command[MAX_JOINTS];
    int32_t command_velocity[MAX_JOINTS];
    int32_t preload[MAX_JOINTS]; /* goals lie so far beyond the command */
};

/* Forget all knots; the command becomes `position` at rest, without preload. */
void follower_rest_at(struct follower *follower, const int32_t *position);
/* Forget all knots; command and preload stay as they are. */
void follower_forget(struct follower *follower);
/* How far a joint is from where it may be, given the preload: it may stand anywhere between its
   command and the goal beyond it. */
int32_t follower_error(const struct follower *follower, uint8_t joint, int32_t measured);
/* Take a knot, or say why not; `present` is where the joints are. */
struct violation follower_offer(
    struct follower *follower, const struct knot *knot, const int32_t *present);
/* Take the announcement that `count` knots were all; 0 or the reason why not. */
uint8_t follower_end(struct follower *follower, uint32_t count);
void follower_start(struct follower *follower);
void follower_stop(struct follower *follower);
void follower_step(struct follower *follower, int32_t dt_us);

int64_t follower_path_us(const struct follower *follower);
/* Path time ahead. */
int64_t follower_queued_us(const struct follower *follower);
uint16_t follower_free(const struct follower *follower);
/* Whether the path ends soon though its end was not announced. */
bool follower_starving(const struct follower *follower);
bool follower_arrived(const struct follower *follower);

#endif
