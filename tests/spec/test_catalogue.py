"""The motor catalogue's rows are whole and physically sensible."""

from __future__ import annotations

import pytest

from fpcad.errors import SpecError
from fpcad.spec import motor, motor_types
from fpcad.spec.schema import Spec


def test_the_catalogue_has_the_motors_that_hands_are_built_with() -> None:
    expected = ("XL330-M288", "XC330-M288", "XC330-T288", "STS3215-7.4V", "STS3215-12V")
    assert motor_types() == expected


@pytest.mark.parametrize("name", motor_types())
def test_rows_are_sane(name: str) -> None:
    row = motor(name)
    assert row.type == name
    assert row.maker
    assert 3 < row.supply_v < 25
    assert 0.1 * row.stall_torque_nm < row.continuous_torque_nm < 0.5 * row.stall_torque_nm
    assert 1 < row.no_load_speed_rad_s < 50
    assert 10 < row.mass_g < 200
    assert "estimate" in row.source or "rated torque" in row.source
    assert "://" not in row.source


def test_stall_torque_and_speed_belong_together() -> None:
    power_w = {
        n: motor(n).stall_torque_nm * motor(n).no_load_speed_rad_s / 4 for n in motor_types()
    }
    assert all(0.5 < power < 5 for power in power_w.values()), power_w


def test_the_default_motor_is_in_the_catalogue() -> None:
    assert Spec.model_fields["motors"].default.type in motor_types()


def test_an_unknown_motor_is_told_with_a_near_miss() -> None:
    with pytest.raises(SpecError, match=r'no motor "XL330".*did you mean "XL330-M288"'):
        motor("XL330")
