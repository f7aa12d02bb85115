"""Drivers: one file for each kind of motor controller, all behind :mod:`fpcad.run.bus`."""
