/* Board support for Arm's MPS2 with the AN385 image (Cortex-M3, 25 MHz), which QEMU runs. */
#include "mcu.h"
#include "ring.h"

#define CLOCK_HZ 25000000u
#define REGISTER(address) (*(volatile uint32_t *)(address))

#define UART_DATA REGISTER(0x40004000)
#define UART_STATE REGISTER(0x40004004)
#define UART_CONTROL REGISTER(0x40004008)
#define UART_INTERRUPT REGISTER(0x4000400c)
#define UART_DIVIDER REGISTER(0x40004010)
#define UART_TRANSMIT_FULL 1u
#define UART_RECEIVE_FULL 2u
#define UART_RECEIVE_INTERRUPT 2u
#define UART_ENABLE 0xbu /* both ways, interrupts on receipt */

#define SYSTICK_CONTROL REGISTER(0xe000e010)
#define SYSTICK_RELOAD REGISTER(0xe000e014)
#define SYSTICK_ENABLE 7u /* core clock, interrupt */
#define INTERRUPT_ENABLE REGISTER(0xe000e100)

extern uint32_t DATA_IN_FLASH[], DATA_START[], DATA_END[], BSS_START[], BSS_END[], STACK_TOP[];
int main(void);

static struct ring received;
static volatile uint8_t ticks_due;

void mcu_start(uint16_t tick_hz)
{
    UART_DIVIDER = CLOCK_HZ / 115200;
    UART_CONTROL = UART_ENABLE;
    INTERRUPT_ENABLE = 1u; /* interrupt 0: bytes from the serial line */
    SYSTICK_RELOAD = CLOCK_HZ / tick_hz - 1;
    SYSTICK_CONTROL = SYSTICK_ENABLE;
}

bool mcu_take_byte(uint8_t *byte)
{
    return ring_take(&received, byte);
}

void mcu_put(const uint8_t *bytes, uint8_t count)
{
    for (uint8_t i = 0; i < count; i++) {
        while (UART_STATE & UART_TRANSMIT_FULL) {
        }
        UART_DATA = bytes[i];
    }
}

bool mcu_take_tick(void)
{
    __asm__ volatile("cpsid i" ::: "memory");
    bool due = ticks_due > 0;
    ticks_due = (uint8_t)(ticks_due - due);
    __asm__ volatile("cpsie i" ::: "memory");
    return due;
}

bool mcu_switch_pressed(void)
{
    return false; /* the simulated board has none */
}

void mcu_rest(void)
{
    /* With interrupts held back, one that comes after the question still ends the sleep. */
    __asm__ volatile("cpsid i");
    if (received.head == received.tail && ticks_due == 0) {
        __asm__ volatile("wfi");
    }
    __asm__ volatile("cpsie i");
}

static void on_serial(void)
{
    UART_INTERRUPT = UART_RECEIVE_INTERRUPT;
    while (UART_STATE & UART_RECEIVE_FULL) {
        ring_put(&received, (uint8_t)UART_DATA); /* what finds no room is lost, and resent */
    }
}

static void on_tick(void)
{
    if (ticks_due < MAX_LATE_TICKS) {
        ticks_due++;
    }
}

static void on_reset(void)
{
    for (uint32_t *to = DATA_START, *from = DATA_IN_FLASH; to < DATA_END;) {
        *to++ = *from++;
    }
    for (uint32_t *to = BSS_START; to < BSS_END;) {
        *to++ = 0;
    }
    main();
}

static void on_fault(void)
{
    for (;;) { /* on a real board a watchdog resets here, and the host hears of it */
    }
}

__attribute__((section(".vectors"), used)) const void *const VECTORS[17] = {
    STACK_TOP, (void *)on_reset, (void *)on_fault, (void *)on_fault, (void *)on_fault,
    (void *)on_fault, (void *)on_fault, 0, 0, 0, 0, (void *)on_fault, (void *)on_fault, 0,
    (void *)on_fault, (void *)on_tick, (void *)on_serial,
};
