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
    device_boot(device, device->simulation.setup.boot_nonce);
    return NULL;
}
