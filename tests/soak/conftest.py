from tests.firmware.real_time import pytest_pyfunc_call

__all__ = ["pytest_pyfunc_call"]
