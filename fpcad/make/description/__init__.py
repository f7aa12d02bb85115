"""The hand told in the formats that simulators and robot middleware read. docs/description.md."""

from fpcad.make.description.robot import BASE_LINK, LinkBody, Robot, describe
from fpcad.make.description.write import write_description

__all__ = ["BASE_LINK", "LinkBody", "Robot", "describe", "write_description"]
