"""fpcad: from one YAML file to a tool-wielding robotic hand on the wire.

The command line is `fpcad`; from Python, :func:`load_spec` reads a design and
`fpcad.pipeline.run_stages` makes it.
"""

from fpcad.errors import FpcadError, SpecError
from fpcad.spec import Spec, load_spec

__all__ = ["FpcadError", "Spec", "SpecError", "load_spec"]
