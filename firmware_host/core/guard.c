#include "guard.h"

#include "fixed.h"

/* Whether a condition has lasted; counts how long. */
static bool lasts(bool condition, uint8_t *ticks)
{
    if (!condition) {
        *ticks = 0;
    } else if (*ticks < GUARD_TICKS) {
        ++*ticks;
    }
    return *ticks == GUARD_TICKS;
}

uint8_t guard_motors(
    struct guard *guard, const struct hand_setup *setup, const struct motor_readings *readings)
{
    uint8_t cause = CAUSE_NONE;
    for (uint8_t i = 0; i < setup->joints; i++) {
        int16_t current = readings->current_ma[i];
        bool strained = setup->current_ma && (current > setup->current_ma || current < -setup->current_ma);
        bool hot = setup->temperature_c && readings->temperature_c[i] > setup->temperature_c;
        if (lasts(strained, &guard->current_ticks[i])) {
            cause = CAUSE_CURRENT;
        }
        if (lasts(hot, &guard->temperature_ticks[i])) {
            cause = CAUSE_TEMPERATURE;
        }
        if (lasts(!readings->answered[i], &guard->absent_ticks[i])) {
            cause = CAUSE_MOTOR_LOST;
        }
    }
    return cause;
}

uint8_t guard_standstill(
    struct guard *guard, uint8_t joints, const int32_t *reading, const int32_t *goal, const int32_t *told)
{
    uint8_t cause = CAUSE_NONE;
    for (uint8_t i = 0; i < joints; i++) {
        if (reading[i] != guard->still_reading[i]) {
            guard->still_reading[i] = reading[i];
            guard->still_goal[i] = goal[i];
            guard->still_told[i] = told[i];
        } else if (magnitude(goal[i] - guard->still_goal[i]) > STANDSTILL &&
                   magnitude(told[i] - guard->still_told[i]) > STANDSTILL) {
            cause = CAUSE_TRACKING;
        }
    }
    return cause;
}

uint8_t guard_tracking(const struct follower *follower, const int32_t *measured)
{
    for (uint8_t i = 0; i < follower->setup->joints; i++) {
        if (follower_error(follower, i, measured[i]) > follower->setup->tracking_error) {
            return CAUSE_TRACKING;
        }
    }
    return CAUSE_NONE;
}
