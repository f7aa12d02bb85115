#include "simulated_board.h"

#include <string.h>

static void send(void *context, const uint8_t *bytes, uint8_t count)
{
    struct device *device = context;
    if (device->output_used + count > OUTPUT_BYTES) {
        device->lost_bytes += count;
        return;
    }
    memcpy(device->output + device->output_used, bytes, count);
    device->output_used += count;
}

bool device_mishap(struct device *device, const char *kind, uint8_t number)
{
    struct plant *plant = &device->plant;
    const struct {
        const char *name;
        bool *of_motor;
    } switches[] = {
        {"jam", plant->jammed}, {"death", plant->dead}, {"stuck", plant->stuck},
        {"weak", plant->weak}, {"reversed", plant->reversed}, {"grasp", plant->grasped}};
    for (size_t i = 0; i < sizeof switches / sizeof switches[0]; i++) {
        if (strcmp(kind, switches[i].name) == 0) {
            switches[i].of_motor[number] = true;
            return true;
        }
    }
    if (strcmp(kind, "heat") == 0) {
        plant->temperature_c[number] = 90;
    } else if (strcmp(kind, "slack") == 0) {
        plant->slack[number] = 0.06;
    } else if (strcmp(kind, "wedge") == 0) {
        plant->upper[number] -= 0.5;
    } else if (strcmp(kind, "no_stop") == 0) {
        plant->upper[number] += 100;
    } else {
        return false;
    }
    return true;
}

static void exchange(
    void *context, const struct motor_goals *goals, struct motor_readings *readings)
{
    struct device *device = context;
    plant_step(&device->plant, goals, (uint16_t)(1000 / device->simulation.setup.tick_hz));
    plant_read(&device->plant, readings);
}

static void torque_off(void *context)
{
    ((struct device *)context)->plant.torque_on = false;
}

void device_boot(struct device *device, uint32_t boot_nonce)
{
    device->simulation.setup.boot_nonce = boot_nonce;
    controller_boot(&device->controller, &device->simulation.setup, &device->board);
}

const char *device_make(struct device *device, char *setup)
{
    memset(device, 0, sizeof *device);
    const char *fault = setup_from_text(setup, &device->simulation);
    if (fault != NULL) {
        return fault;
    }
    device->board = (struct board){device, send, exchange, torque_off};
    plant_rest_at(&device->plant, &device->simulation.setup, device->simulation.start_rad);
    device->plant.encoder_step = device->simulation.encoder_step;
    for (uint8_t i = 0; i < device->simulation.setup.joints; i++) {
        plant_misplace_zero(&device->plant, i, device->simulation.zero_error[i]);
    }
    device_boot(device, device->simulation.setup.boot_nonce);
    return NULL;
}
