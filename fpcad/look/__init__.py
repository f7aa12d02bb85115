"""Looking at a run: tables, analysis, figures and pages, all read from its build folder."""

from fpcad.look.analysis import cluster_table, front_hypervolume, hypervolume, sensitivity
from fpcad.look.curves import efficiency, range_shares
from fpcad.look.run import Run, load

__all__ = [
    "Run",
    "cluster_table",
    "efficiency",
    "front_hypervolume",
    "hypervolume",
    "load",
    "range_shares",
    "sensitivity",
]
