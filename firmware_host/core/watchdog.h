/* Notices that the host has fallen silent. */
#ifndef WATCHDOG_H
#define WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>

struct watchdog {
    uint64_t fed_us;
    uint32_t patience_us;
};

static inline void watchdog_feed(struct watchdog *watchdog, uint64_t now_us)
{
    watchdog->fed_us = now_us;
}

static inline bool watchdog_barks(const struct watchdog *watchdog, uint64_t now_us)
{
    return now_us - watchdog->fed_us > watchdog->patience_us;
}

#endif
