#include "transmission.h"

/* One row of a block times the numbers of its group. */
static int32_t row_times(
    const int32_t *row, const int32_t *values, uint8_t group)
{
    int64_t sum = (int64_t)1 << (GAIN_BITS - 1);
    for (uint8_t k = 0; k < group; k++) {
        sum += (int64_t)row[k] * values[k];
    }
    return (int32_t)(sum >> GAIN_BITS);
}

void motor_rates_of(
    const struct transmission *transmission, uint8_t joints, const int32_t *rate, int32_t *motor)
{
    uint8_t group = transmission->group;
    for (uint8_t i = 0; i < joints; i++) {
        motor[i] = row_times(transmission->gain[i], rate + i / group * group, group);
    }
}

void motors_of(
    const struct transmission *transmission, uint8_t joints, const int32_t *offset,
    const int32_t *joint, int32_t *motor)
{
    motor_rates_of(transmission, joints, joint, motor);
    for (uint8_t i = 0; i < joints; i++) {
        motor[i] += offset[i];
    }
}

void joints_of(
    const struct transmission *transmission, uint8_t joints, const int32_t *offset,
    const int32_t *motor, int32_t *joint)
{
    uint8_t group = transmission->group;
    int32_t turned[MAX_JOINTS];
    for (uint8_t i = 0; i < joints; i++) {
        turned[i] = motor[i] - offset[i];
    }
    for (uint8_t i = 0; i < joints; i++) {
        joint[i] = row_times(transmission->inverse[i], turned + i / group * group, group);
    }
}

int64_t times_gain(int64_t value, int32_t gain)
{
    int64_t high = (value >> GAIN_BITS) * gain;
    int64_t low = (value & (((int64_t)1 << GAIN_BITS) - 1)) * gain;
    return high + (low >> GAIN_BITS);
}
