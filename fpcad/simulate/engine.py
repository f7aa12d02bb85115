"""MuJoCo, imported at first use: an extra that only simulating needs."""

from __future__ import annotations

from types import ModuleType

from fpcad.errors import ToolchainError


def mujoco() -> ModuleType:
    """The mujoco module; :class:`ToolchainError` with advice where it is not installed."""
    try:
        import mujoco
    except ModuleNotFoundError as error:
        raise ToolchainError(
            f"simulating needs the Python package {error.name}: `pip install fpcad[physics]`"
        ) from error
    # Else it writes MUJOCO_LOG.TXT wherever it runs; states that are no numbers end a trial anyway.
    mujoco.set_mju_user_warning(lambda _: None)  # pyright: ignore[reportAttributeAccessIssue]
    return mujoco
