/* Board support for an ATmega1284P at 18.432 MHz, a crystal that divides to 115200 baud exactly. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include "mcu.h"
#include "ring.h"

#ifndef F_CPU
#define F_CPU 18432000UL
#endif

static struct ring received, sent;
static volatile uint8_t ticks_due;

void mcu_start(uint16_t tick_hz)
{
    UBRR0 = (uint16_t)(F_CPU / 16 / 115200 - 1);
    UCSR0B = (uint8_t)(1 << RXEN0 | 1 << TXEN0 | 1 << RXCIE0);
    TCCR1B = (uint8_t)(1 << WGM12 | 1 << CS11); /* counts eighths of the clock up to OCR1A */
    OCR1A = (uint16_t)(F_CPU / 8 / tick_hz - 1);
    TIMSK1 = (uint8_t)(1 << OCIE1A);
    SMCR = 0; /* sleep is idle: clocks and serial line go on */
    sei();
}

ISR(USART0_RX_vect)
{
    ring_put(&received, UDR0); /* what finds no room is lost, and resent */
}

ISR(USART0_UDRE_vect)
{
    uint8_t byte;
    if (ring_take(&sent, &byte)) {
        UDR0 = byte;
    } else {
        UCSR0B &= (uint8_t)~(1 << UDRIE0);
    }
}

ISR(TIMER1_COMPA_vect)
{
    if (ticks_due < MAX_LATE_TICKS) {
        ticks_due++;
    }
}

/* Two-byte indices are not read at once, so the interrupts that change them wait. */
bool mcu_take_byte(uint8_t *byte)
{
    cli();
    bool taken = ring_take(&received, byte);
    sei();
    return taken;
}

void mcu_put(const uint8_t *bytes, uint8_t count)
{
    for (uint8_t i = 0; i < count;) {
        cli();
        if (ring_put(&sent, bytes[i])) {
            i++;
        }
        UCSR0B |= (uint8_t)(1 << UDRIE0);
        sei();
    }
}

bool mcu_take_tick(void)
{
    cli();
    bool due = ticks_due > 0;
    ticks_due = (uint8_t)(ticks_due - due);
    sei();
    return due;
}

/* A closed contact pulls PD2 to ground against a resistor to 5 V, so a broken wire stops too. */
bool mcu_switch_pressed(void)
{
    return (PIND & 1 << PIND2) != 0;
}

void mcu_rest(void)
{
    cli();
    if (received.head == received.tail && ticks_due == 0) {
        SMCR = 1 << SE;
        sei(); /* takes effect after the next instruction, so nothing slips between */
        sleep_cpu();
        SMCR = 0;
    }
    sei();
}
