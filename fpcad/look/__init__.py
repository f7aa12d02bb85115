"""Looking at a run: tables, analysis, figures and pages, all read from its build folder."""

from fpcad.look.run import Run, load

__all__ = ["Run", "load"]
