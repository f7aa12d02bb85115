from tests.firmware.real_time import pytest_pyfunc_call
from tests.run.conftest import each_controller

__all__ = ["each_controller", "pytest_pyfunc_call"]
