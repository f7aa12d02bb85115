#define _XOPEN_SOURCE 700
#define _DEFAULT_SOURCE
#include "terminal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

static bool make_raw(int slave)
{
    struct termios mode;
    if (tcgetattr(slave, &mode) != 0) {
        return false;
    }
    cfmakeraw(&mode);
    return tcsetattr(slave, TCSANOW, &mode) == 0;
}

bool terminal_make(struct terminal *terminal)
{
    terminal->master = posix_openpt(O_RDWR | O_NOCTTY);
    if (terminal->master < 0 || grantpt(terminal->master) || unlockpt(terminal->master)) {
        return false;
    }
    snprintf(terminal->name, sizeof terminal->name, "%s", ptsname(terminal->master));
    terminal->slave = open(terminal->name, O_RDWR | O_NOCTTY);
    terminal->open = true;
    return terminal->slave >= 0 && make_raw(terminal->slave) &&
           fcntl(terminal->master, F_SETFL, O_NONBLOCK) == 0;
}

size_t terminal_read(struct terminal *terminal, uint8_t *bytes, size_t room)
{
    ssize_t count = read(terminal->master, bytes, room);
    if (count < 0) {
        terminal->open = errno == EAGAIN;
        return 0;
    }
    if (count > 0 && terminal->slave >= 0) {
        close(terminal->slave);
        terminal->slave = -1;
    }
    return (size_t)count;
}

size_t terminal_write(struct terminal *terminal, const uint8_t *bytes, size_t count)
{
    ssize_t written = write(terminal->master, bytes, count);
    if (written < 0) {
        terminal->open = terminal->open && errno == EAGAIN;
        return 0;
    }
    return (size_t)written;
}
