"""MuJoCo, whose wheels tell type checkers nothing."""

from __future__ import annotations

from importlib import import_module
from typing import Any

mujoco: Any = import_module("mujoco")
