/* The firmware on a microcontroller: bytes as they come, ticks as they are due. */
#include "commands.h"
#include "controller.h"
#include "mcu.h"
#include "motors.h"

extern const struct hand_setup HAND_SETUP;

static struct controller controller;

static void send(void *context, const uint8_t *bytes, uint8_t count)
{
    (void)context;
    mcu_put(bytes, count);
}

int main(void)
{
    const struct board board = {
        .send = send, .exchange = motors_exchange, .torque_off = motors_torque_off};
    motors_start();
    mcu_start(HAND_SETUP.tick_hz);
    controller_boot(&controller, &HAND_SETUP, &board);
    for (;;) {
        uint8_t byte;
        while (mcu_take_byte(&byte)) {
            controller_receive(&controller, byte);
            /* A long frame must not delay a tick that is due. */
            if (byte == 0) {
                break;
            }
        }
        if (mcu_switch_pressed() && controller.state != STATE_ESTOP) {
            command_estop(&controller, CAUSE_SWITCH);
        }
        if (mcu_take_tick()) {
            controller_tick(&controller);
        }
        mcu_rest();
    }
}
