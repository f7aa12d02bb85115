"""The stages in order; each knows whether what it made is up to date."""

from fpcad.pipeline.run import run_stages
from fpcad.pipeline.stage import Build, Reporter, SilentReporter

__all__ = ["Build", "Reporter", "SilentReporter", "run_stages"]
