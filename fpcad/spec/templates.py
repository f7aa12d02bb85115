"""The names that each hand template offers to a spec; its kinematics live in the model layer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from pydantic import Field
from pydantic.config import JsonDict


@dataclass(frozen=True)
class TemplateNames:
    """What a spec may refer to by name when it uses a template."""

    fingers: tuple[str, ...]
    joints: tuple[str, ...]
    """Joints of each finger, from the root out."""
    links: tuple[str, ...]
    """Links of each finger that may touch a tool."""
    sites: tuple[str, ...]
    """Points of the palm that primitives may be fixed to."""
    parameters: tuple[str, ...]
    """Design parameters in the order of the design vector; the suffix is the unit."""


TEMPLATES: dict[str, TemplateNames] = {
    "anthropomorphic_4f": TemplateNames(
        fingers=("thumb", "index", "middle", "ring"),
        joints=("mcp_flex", "mcp_abd", "ip_flex"),
        links=("proximal", "distal"),
        sites=("thumb_root", "index_root", "middle_root", "ring_root"),
        parameters=(
            "d1_distal_length_mm",
            "d2_palm_length_mm",
            "d3_palm_half_width_mm",
            "d4_finger_diameter_mm",
            "d5_palm_angle_deg",
            "d6_thumb_roll_deg",
        ),
    ),
}


def _names(kind: str) -> JsonDict:
    """Names of all templates for editors and docs; that one fits its template is checked later."""
    known = [name for template in TEMPLATES.values() for name in getattr(template, kind)]
    return {"enum": [*dict.fromkeys(known)]}


TemplateName = Annotated[str, Field(json_schema_extra={"enum": [*TEMPLATES]})]
FingerName = Annotated[str, Field(json_schema_extra=_names("fingers"))]
JointName = Annotated[str, Field(json_schema_extra=_names("joints"))]
LinkName = Annotated[str, Field(json_schema_extra=_names("links"))]
SiteName = Annotated[str, Field(json_schema_extra=_names("sites"))]
