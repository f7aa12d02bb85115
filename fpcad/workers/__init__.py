"""Tasks spread over processes and machines, with results in the order of the tasks.

A task that raises, kills its process or hangs is handed over with its reason, and the others go on.
"""

from fpcad.workers.in_process import InProcess
from fpcad.workers.interface import Failed, Opener, TaskFailure, Workers, raise_failure
from fpcad.workers.pool import ProcessPool, available_cores

__all__ = [
    "Failed",
    "InProcess",
    "Opener",
    "ProcessPool",
    "TaskFailure",
    "Workers",
    "available_cores",
    "raise_failure",
]
