"""Checks of any robot's description package, ours or another's. docs/description.md.

Nothing here knows how fpcad makes a hand: it reads the files as a stranger would.
"""

from fpcad.check_description.report import Report, Row, check_description

__all__ = ["Report", "Row", "check_description"]
