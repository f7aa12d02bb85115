/* Runs an ATmega1284P image in simavr, with its serial line on a pseudo terminal whose name goes to
   stdout. Ends when stdin does. Usage: simulate_avr image.elf */
#include <poll.h>
#include <stdbool.h>
#include <simavr/parts/uart_pty.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define INSTRUCTIONS_A_LOOK 20000

static bool host_gone(void)
{
    struct pollfd lifeline = {.fd = STDIN_FILENO, .events = POLLIN};
    char byte;
    return poll(&lifeline, 1, 0) > 0 && read(STDIN_FILENO, &byte, 1) <= 0;
}

int main(int count, char **arguments)
{
    elf_firmware_t image;
    memset(&image, 0, sizeof image);
    if (count != 2 || elf_read_firmware(arguments[1], &image) != 0) {
        fprintf(stderr, "usage: simulate_avr image.elf\n");
        return 1;
    }
    avr_t *avr = avr_make_mcu_by_name("atmega1284p");
    avr_init(avr);
    avr->frequency = 18432000;
    avr->log = LOG_ERROR;
    avr_load_firmware(avr, &image);
    avr->frequency = 18432000;
    uart_pty_t uart;
    uart_pty_init(avr, &uart);
    uart_pty_connect(&uart, '0');
    printf("%s\n", uart.pty.slavename);
    fflush(stdout);
    for (int state = cpu_Running; state != cpu_Done && state != cpu_Crashed && !host_gone();) {
        for (int i = 0; i < INSTRUCTIONS_A_LOOK && state != cpu_Done && state != cpu_Crashed; i++) {
            state = avr_run(avr);
        }
    }
    uart_pty_stop(&uart);
    return 0;
}
