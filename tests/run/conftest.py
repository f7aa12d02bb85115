import pytest

from tests.firmware.core import core_controller, library
from tests.firmware.real_time import pytest_pyfunc_call
from tests.run import virtual

__all__ = ["each_controller", "pytest_pyfunc_call"]


@pytest.fixture(params=["simulator", "firmware"])
def each_controller(request, monkeypatch):
    """Runs a test on the simulated controller and on the firmware's core."""
    if request.param == "firmware":
        library()
        monkeypatch.setattr(virtual, "maker", core_controller)
