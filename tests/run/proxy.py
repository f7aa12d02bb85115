"""A pseudo terminal between host and controller that damages what passes."""

from __future__ import annotations

import os
import pty
import select
import threading
import tty
from collections.abc import Iterator
from contextlib import contextmanager

from tests.run.virtual import Damage


@contextmanager
def damaged_port(port: str, to_device: Damage, to_host: Damage) -> Iterator[str]:
    """Name of a port that leads to `port` through damage in both directions."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    device = os.open(port, os.O_RDWR | os.O_NOCTTY)
    tty.setraw(device)
    stop = threading.Event()
    ways = {master: (device, to_device), device: (master, to_host)}

    def carry() -> None:
        while not stop.is_set():
            ready, _, _ = select.select(list(ways), [], [], 0.02)
            for source in ready:
                target, damage = ways[source]
                os.write(target, damage(os.read(source, 4096)))

    thread = threading.Thread(target=carry)
    thread.start()
    try:
        yield os.ttyname(slave)
    finally:
        stop.set()
        thread.join()
        for descriptor in (master, slave, device):
            os.close(descriptor)
