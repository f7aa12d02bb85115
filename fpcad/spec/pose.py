"""Foundational poses: which links touch the tool where, how it turns, what makes a pose good."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, field_validator

from fpcad.spec.base import Interval, NonNegative, SpecModel, Vector3, rejection
from fpcad.spec.templates import FingerName, JointName, LinkName


class Contact(SpecModel):
    """One finger's contact with the tool and the window it must lie in at the pose."""

    finger: FingerName
    """Finger that touches."""
    link: LinkName = "distal"
    """Link of the finger that touches: `distal` or `proximal`."""
    axial_mm: Interval
    """Window along the tool's axis, in O [mm]."""
    angle_deg: Interval
    """Window about the tool's axis [deg]; 0 is along +y of O, 90 along +z."""


class Turning(SpecModel):
    """How the tool moves when it is wielded: a rotation."""

    kind: Literal["rotation"] = "rotation"
    """Motion of the tool; `rotation` is the only one so far."""
    axis: Vector3 = (0.0, 0.0, 1.0)
    """Direction of the turning axis in O; its length does not matter."""
    pivot_mm: Vector3 = (0.0, 0.0, 0.0)
    """A point of the turning axis in O [mm]."""

    @field_validator("axis")
    @classmethod
    def _has_direction(cls, axis: Vector3) -> Vector3:
        if max(map(abs, axis)) < 1e-6:
            raise rejection("a vector with a component of at least 1e-6")
        return axis


class TurningNormals(SpecModel):
    """Sum of squares of the contact normals' components along the turning axis."""

    term: Literal["turning_normals"]
    """Kind of cost."""
    fingers: tuple[FingerName, ...] = Field(min_length=1)
    """Fingers whose contact forces should act in the turning direction."""
    weight: NonNegative = 1.0
    """Factor of the term."""


class OpposedNormals(SpecModel):
    """Half the squared sum of two contact normals: zero when they pinch exactly."""

    term: Literal["opposed_normals"]
    """Kind of cost."""
    fingers: tuple[FingerName, FingerName]
    """The two fingers that pinch."""
    weight: NonNegative = 1.0
    """Factor of the term."""


class JointUse(SpecModel):
    """Sum of squares of one joint's angles [rad^2] over all fingers."""

    term: Literal["joint_use"]
    """Kind of cost."""
    joint: JointName
    """Joint whose use is discouraged."""
    weight: NonNegative = 0.1
    """Factor of the term."""


CostTerm = Annotated[TurningNormals | OpposedNormals | JointUse, Field(discriminator="term")]


class Pose(SpecModel):
    """A foundational pose: a parallel mechanism made of the tool and some fingers."""

    description: str = ""
    """What the pose is for, in words."""
    contacts: tuple[Contact, ...] = Field(min_length=2)
    """Contacts between tool and fingers, at most one a link."""
    turning: Turning = Turning()
    """How the tool turns about this pose."""
    tip_force_n: NonNegative = 10.0
    """Force at the tool's tip against the turning that the hand must withstand [N]."""
    cost: tuple[CostTerm, ...] = ()
    """Terms whose sum the solver makes small."""
    rest_weight: NonNegative = 0.01
    """Weight of the pull of free fingers to the rest posture [1/rad^2]."""


class InitialContact(SpecModel):
    """Contact coordinates of a known pose, in the order of the pose's contacts."""

    finger: FingerName
    """Finger that touches."""
    axial_mm: float
    """Position along the tool's axis [mm]."""
    angle_deg: float
    """Angle about the tool's axis [deg]."""
    arclength_mm: float
    """Arc length along the link's profile [mm]."""
    finger_angle_deg: float
    """Angle about the link [deg], 0 on the palmar side."""


class InitialPose(SpecModel):
    """A known solution of one pose, or a good guess of it."""

    hand_position_mm: Vector3
    """Position of the hand frame H in O [mm]."""
    hand_rotation_deg: Vector3
    """Roll, pitch and yaw of H in O [deg]: Rz(yaw) Ry(pitch) Rx(roll)."""
    joints_deg: dict[str, Vector3]
    """Joint angles of every finger [deg]."""
    contacts: tuple[InitialContact, ...]
    """Contact coordinates, in the order of the pose's contacts."""


class Initial(SpecModel):
    """The hand that the sampling starts from."""

    design: dict[str, float]
    """Design parameters, in the units of their names."""
    poses: dict[str, InitialPose]
    """One known solution for each pose of the spec."""
