/* An image for tests: quintics of random segments on the target's own arithmetic.

   Takes a seed and a count (u32 each), answers with position, velocity, acceleration (i32 each) of
   every segment. tests/firmware/segments.py draws the same ones. */
#include "bytes.h"
#include "mcu.h"
#include "quintic.h"

static uint32_t chance;

static uint32_t draw(void)
{
    chance ^= chance << 13;
    chance ^= chance >> 17;
    chance ^= chance << 5;
    return chance;
}

static int32_t below(uint32_t value, uint32_t bound)
{
    return (int32_t)(value % bound);
}

static struct motion next_segment(void)
{
    struct knot from = {0}, to = {0};
    uint32_t draws[9];
    for (uint8_t i = 0; i < 9; i++) {
        draws[i] = draw();
    }
    int32_t duration = 30000 + below(draws[0], 70000);
    from.position_urad[0] = below(draws[1], 1200000);
    from.velocity_urad_s[0] = below(draws[3], 2000001) - 1000000;
    to.velocity_urad_s[0] = below(draws[4], 2000001) - 1000000;
    from.acceleration_urad_s2[0] = below(draws[5], 24000001) - 12000000;
    to.acceleration_urad_s2[0] = below(draws[6], 24000001) - 12000000;
    int64_t way = (int64_t)(from.velocity_urad_s[0] + to.velocity_urad_s[0]) * duration / 2000000;
    to.position_urad[0] = from.position_urad[0] + (int32_t)way + below(draws[2], 2001) - 1000;
    struct hermite ends;
    struct quintic quintic;
    struct span span = span_of(duration);
    hermite_of(&from, &to, 0, &span, &ends);
    quintic_of(&ends, &quintic);
    uint32_t share = quintic_share(below(draws[7], (uint32_t)duration + 1), duration);
    return quintic_at(&quintic, share, &span, WITH_ACCELERATION);
}

static uint32_t take_number(void)
{
    uint8_t bytes[4];
    for (uint8_t i = 0; i < 4; i++) {
        while (!mcu_take_byte(&bytes[i])) {
            mcu_rest();
        }
    }
    return get_u32(bytes);
}

int main(void)
{
    mcu_start(50);
    for (;;) {
        chance = take_number();
        for (uint32_t left = take_number(); left > 0; left--) {
            struct motion motion = next_segment();
            uint8_t bytes[12];
            put_u32(bytes, (uint32_t)motion.position);
            put_u32(bytes + 4, (uint32_t)motion.velocity);
            put_u32(bytes + 8, (uint32_t)motion.acceleration);
            mcu_put(bytes, sizeof bytes);
        }
    }
}
