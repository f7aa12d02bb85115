from tests.run.conftest import each_controller

__all__ = ["each_controller"]
