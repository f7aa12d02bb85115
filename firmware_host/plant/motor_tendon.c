#include "motor_tendon.h"

#include <string.h>

#include "pd.h"

#define STEP ((real)1e-3)              /* [s] */
#define MOTOR_INERTIA ((real)1e-3)     /* rotor through its gear [kg m^2] */
#define MOTOR_FRICTION ((real)0.01)    /* dry [N m] */
#define JOINT_INERTIA ((real)1e-3)     /* [kg m^2] */
#define JOINT_FRICTION ((real)0.01)    /* dry [N m] */
#define JOINT_VISCOUS ((real)0.01)     /* [N m s/rad] */
#define TENDON_STIFFNESS ((real)30)    /* [N m/rad] */
#define TENDON_DAMPING ((real)0.08)    /* [N m s/rad] */
#define STOP_STIFFNESS ((real)200)     /* [N m/rad] */
#define STOP_DAMPING ((real)0.3)       /* [N m s/rad] */
#define TORQUE_PER_AMPERE ((real)1.07) /* [N m/A]: a servo of 2.9 N m at 2.7 A */
#define WEAK_TORQUE 22000              /* [1e-6 N m] */
#define AMBIENT_C ((real)25)
#define HEATING_C ((real)15)           /* in the long run, at 1 A */
#define WARMING_S ((real)200)

static const struct pd SERVO = {
    .stiffness = 20000000, .damping = 400000, .torque_limit = 2900000};

void plant_rest_at(struct plant *plant, const struct hand_setup *setup, const real *start)
{
    memset(plant, 0, sizeof *plant);
    plant->joints = setup->joints;
    plant->group = setup->transmission.group;
    for (uint8_t i = 0; i < plant->joints; i++) {
        plant->joint[i] = start[i];
        plant->lower[i] = (real)setup->homing.lower[i] * (real)1e-6;
        plant->upper[i] = (real)setup->homing.upper[i] * (real)1e-6;
        plant->offset[i] = (real)setup->transmission.offset[i] * (real)1e-6;
        plant->temperature_c[i] = AMBIENT_C;
        for (uint8_t k = 0; k < plant->group; k++) {
            plant->gain[i][k] = (real)setup->transmission.gain[i][k] / (real)(1L << 24);
        }
    }
    for (uint8_t i = 0; i < plant->joints; i++) {
        uint8_t base = (uint8_t)(i / plant->group * plant->group);
        plant->motor[i] = plant->offset[i];
        for (uint8_t k = 0; k < plant->group; k++) {
            plant->motor[i] += plant->gain[i][k] * start[base + k];
        }
    }
    struct motor_readings readings;
    plant_read(plant, &readings);
}

void plant_misplace_zero(struct plant *plant, uint8_t motor, real error)
{
    plant->offset[motor] += error;
    plant->motor[motor] += error;
}

/* Motors as mounted: what they call forwards. */
static real mounting(const struct plant *plant, uint8_t motor)
{
    return plant->reversed[motor] ? (real)-1 : (real)1;
}

static int32_t encoder(const struct plant *plant, uint8_t motor)
{
    real step = plant->encoder_step > 0 ? plant->encoder_step : (real)1e-6;
    real steps = mounting(plant, motor) * plant->motor[motor] / step;
    int32_t whole = (int32_t)(steps < 0 ? steps - (real)0.5 : steps + (real)0.5);
    return (int32_t)((real)whole * step * (real)1e6 + (whole < 0 ? (real)-0.5 : (real)0.5));
}

/* Dry friction takes speed away but never reverses it: things can stick. */
static real with_friction(real rate, real braking)
{
    if (rate > braking) {
        return rate - braking;
    }
    return rate < -braking ? rate + braking : 0;
}

static real servo_torque(const struct plant *plant, const struct motor_goals *goals, uint8_t motor)
{
    if (!plant->torque_on || plant->dead[motor]) {
        return 0;
    }
    struct pd servo = SERVO;
    real allowed = (real)goals->current_ma * TORQUE_PER_AMPERE * (real)1000; /* [1e-6 N m] */
    if (goals->current_ma > 0 && allowed < (real)servo.torque_limit) {
        servo.torque_limit = (int32_t)allowed;
    }
    if (plant->weak[motor]) {
        servo.torque_limit = WEAK_TORQUE;
    }
    real sign = mounting(plant, motor);
    int32_t rate = (int32_t)(sign * plant->motor_rate[motor] * (real)1e6);
    int32_t error = goals->position[motor] - encoder(plant, motor);
    int32_t torque = pd_torque(&servo, error, goals->velocity[motor] - rate);
    return sign * (real)torque * (real)1e-6;
}

static real stop_torque(const struct plant *plant, uint8_t joint)
{
    real beyond = 0;
    if (plant->joint[joint] < plant->lower[joint]) {
        beyond = plant->joint[joint] - plant->lower[joint];
    } else if (plant->joint[joint] > plant->upper[joint]) {
        beyond = plant->joint[joint] - plant->upper[joint];
    } else {
        return 0;
    }
    return -STOP_STIFFNESS * beyond - STOP_DAMPING * plant->joint_rate[joint];
}

static real tendon_torque(real slack, real stretch, real rate)
{
    if (stretch > slack) {
        stretch -= slack;
    } else if (stretch < -slack) {
        stretch += slack;
    } else if (slack > 0) {
        return 0;
    }
    return TENDON_STIFFNESS * stretch + TENDON_DAMPING * rate;
}

static void turn_motor(
    struct plant *plant, const struct motor_goals *goals, uint8_t motor, real *tendon)
{
    uint8_t base = (uint8_t)(motor / plant->group * plant->group);
    real stretch = plant->motor[motor] - plant->offset[motor], rate = plant->motor_rate[motor];
    for (uint8_t k = 0; k < plant->group; k++) {
        stretch -= plant->gain[motor][k] * plant->joint[base + k];
        rate -= plant->gain[motor][k] * plant->joint_rate[base + k];
    }
    *tendon = tendon_torque(plant->slack[motor], stretch, rate);
    real torque = servo_torque(plant, goals, motor);
    plant->current_a[motor] = torque / TORQUE_PER_AMPERE;
    real heat = HEATING_C * plant->current_a[motor] * plant->current_a[motor];
    plant->temperature_c[motor] +=
        (heat - (plant->temperature_c[motor] - AMBIENT_C)) * STEP / WARMING_S;
    real free_rate = plant->motor_rate[motor] + (torque - *tendon) / MOTOR_INERTIA * STEP;
    plant->motor_rate[motor] = with_friction(free_rate, MOTOR_FRICTION / MOTOR_INERTIA * STEP);
    if (plant->jammed[motor]) {
        plant->motor_rate[motor] = 0;
    }
}

static void turn_joint(struct plant *plant, uint8_t joint, const real *tendon)
{
    uint8_t base = (uint8_t)(joint / plant->group * plant->group);
    real torque = stop_torque(plant, joint) - JOINT_VISCOUS * plant->joint_rate[joint];
    for (uint8_t k = 0; k < plant->group; k++) {
        torque += plant->gain[base + k][joint - base] * tendon[base + k];
    }
    real free_rate = plant->joint_rate[joint] + torque / JOINT_INERTIA * STEP;
    plant->joint_rate[joint] = with_friction(free_rate, JOINT_FRICTION / JOINT_INERTIA * STEP);
    if (plant->grasped[joint]) {
        plant->joint_rate[joint] = 0;
    }
}

void plant_step(struct plant *plant, const struct motor_goals *goals, uint16_t steps)
{
    plant->torque_on = goals->torque_on;
    while (steps-- > 0) {
        real tendon[MAX_JOINTS];
        for (uint8_t i = 0; i < plant->joints; i++) {
            turn_motor(plant, goals, i, &tendon[i]);
        }
        for (uint8_t i = 0; i < plant->joints; i++) {
            turn_joint(plant, i, tendon);
        }
        for (uint8_t i = 0; i < plant->joints; i++) {
            plant->motor[i] += plant->motor_rate[i] * STEP;
            plant->joint[i] += plant->joint_rate[i] * STEP;
        }
    }
}

void plant_read(struct plant *plant, struct motor_readings *readings)
{
    for (uint8_t i = 0; i < plant->joints; i++) {
        if (!plant->dead[i] && !plant->stuck[i]) {
            plant->last_read[i] = encoder(plant, i);
        }
        readings->answered[i] = !plant->dead[i];
        readings->position[i] = plant->last_read[i];
        readings->current_ma[i] = (int16_t)(plant->current_a[i] * 1000);
        readings->temperature_c[i] = (int8_t)plant->temperature_c[i];
    }
}
