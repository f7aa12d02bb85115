"""Hooks of conftest.py files: the mark `real_time` has a test judged fairly on a busy machine."""

from collections.abc import Generator

import pytest

from tests.firmware.lateness import judged_fairly


@pytest.hookimpl(wrapper=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> Generator[None, object, object]:
    if pyfuncitem.get_closest_marker("real_time") is None:
        return (yield)
    called = pyfuncitem.obj
    pyfuncitem.obj = lambda **arguments: judged_fairly(lambda: called(**arguments), pyfuncitem.name)
    try:
        return (yield)
    finally:
        pyfuncitem.obj = called
