/* Times the pieces of work that ports/mcu_timing.c marks, in cycles of an ATmega1284P.

   Usage: time_avr image.elf. A mark with an odd number begins a piece, the next even one ends it. */
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_io.h>
#include <stdio.h>
#include <string.h>

#define MARK_REGISTER 0x3e /* GPIOR0 */
#define PIECES 4

static const char *const NAMES[PIECES] = {
    "a knot, from its first byte to its answer", "a tick", "of it the path's place for all joints",
    "an emergency stop, from its first byte to torque off"};

static struct {
    avr_cycle_count_t began, sum, worst;
    unsigned count;
} pieces[PIECES];
static int last_mark;

static void on_mark(avr_t *avr, avr_io_addr_t address, uint8_t value, void *unused)
{
    (void)unused;
    avr->data[address] = value;
    last_mark = value;
    unsigned piece = (value - 1u) / 2;
    if (piece >= PIECES) {
        return;
    }
    if (value % 2) {
        pieces[piece].began = avr->cycle;
        return;
    }
    avr_cycle_count_t took = avr->cycle - pieces[piece].began;
    pieces[piece].sum += took;
    pieces[piece].count++;
    pieces[piece].worst = took > pieces[piece].worst ? took : pieces[piece].worst;
}

int main(int count, char **arguments)
{
    elf_firmware_t image;
    memset(&image, 0, sizeof image);
    if (count != 2 || elf_read_firmware(arguments[1], &image) != 0) {
        fprintf(stderr, "usage: time_avr image.elf\n");
        return 1;
    }
    avr_t *avr = avr_make_mcu_by_name("atmega1284p");
    avr_init(avr);
    avr->log = LOG_ERROR;
    avr_load_firmware(avr, &image);
    avr->frequency = 18432000;
    avr_register_io_write(avr, MARK_REGISTER, on_mark, NULL);
    for (int state = cpu_Running; last_mark < 0xfe && state != cpu_Done && state != cpu_Crashed;) {
        state = avr_run(avr);
    }
    for (int i = 0; i < PIECES; i++) {
        double per_ms = (double)avr->frequency / 1000;
        printf(
            "%s: %.2f ms on average, %.2f ms at most, %u times\n", NAMES[i],
            pieces[i].count ? (double)pieces[i].sum / pieces[i].count / per_ms : 0.0,
            (double)pieces[i].worst / per_ms, pieces[i].count);
    }
    return last_mark == 0xff ? 0 : 1;
}
