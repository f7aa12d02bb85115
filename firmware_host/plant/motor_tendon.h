/* A simulated hand for ports without motors: geared servos that pull joints through tendons.

   Each motor is an inertia with friction under a PD controller with limited torque; it turns joints
   through springs (tendons) and the differential; joints have inertia, friction and end stops. What
   is read are the motors' encoders, so a stretched tendon is not seen, as on the real hand. */
#ifndef MOTOR_TENDON_H
#define MOTOR_TENDON_H

#include "board.h"
#include "hand_setup.h"

/* double on a host, float on a microcontroller: the plant is no part of the firmware. */
#ifndef PLANT_REAL
#define PLANT_REAL double
#endif
typedef PLANT_REAL real;

struct plant {
    uint8_t joints;
    uint8_t group;
    real gain[MAX_JOINTS][MAX_GROUP];
    real offset[MAX_JOINTS]; /* where the zeros truly are */
    bool reversed[MAX_JOINTS]; /* motors that turn the other way than the design says */
    real lower[MAX_JOINTS]; /* end stops of the joints [rad] */
    real upper[MAX_JOINTS];
    real joint[MAX_JOINTS]; /* [rad] */
    real joint_rate[MAX_JOINTS];
    real motor[MAX_JOINTS];
    real motor_rate[MAX_JOINTS];
    real current_a[MAX_JOINTS];
    real temperature_c[MAX_JOINTS];
    real encoder_step; /* [rad]; 0: one count of 1e-6 rad */
    bool torque_on;
    bool jammed[MAX_JOINTS]; /* motors that cannot turn */
    bool dead[MAX_JOINTS];   /* motors that neither pull nor answer */
    bool stuck[MAX_JOINTS];  /* encoders that stand still */
    bool weak[MAX_JOINTS];   /* motors that hardly overcome their friction */
    bool grasped[MAX_JOINTS]; /* joints that a person's hand holds still */
    real slack[MAX_JOINTS];  /* either way, in which a motor's tendons do not pull [rad] */
    int32_t last_read[MAX_JOINTS];
};

/* Joints at rest at `start` [rad], tendons slack of any stretch, torque off. */
void plant_rest_at(struct plant *plant, const struct hand_setup *setup, const real *start);
/* The hand is put together otherwise than designed: this motor's zero lies `error` rad off. */
void plant_misplace_zero(struct plant *plant, uint8_t motor, real error);
/* Advance by `steps` steps of 1 ms towards goals that hold for all of them. */
void plant_step(struct plant *plant, const struct motor_goals *goals, uint16_t steps);
void plant_read(struct plant *plant, struct motor_readings *readings);

#endif
