"""From a device's number to the lab's: by the units of both, angles by whole turns."""

from __future__ import annotations

import pytest

from pico.model.instruments.conversion import conversion
from pico.model.wiring import Wired


def test_an_identity_map_changes_no_physical_quantity() -> None:
    made = conversion(Wired(property="power"), "W", "mW")
    assert made.to_lab(0.001) == pytest.approx(1.0)
    assert made.to_device(1.0) == pytest.approx(0.001)
    assert made.spread(1e-5) == pytest.approx(0.01)


def test_scale_and_offset_are_in_the_unit_that_is_stated_or_in_the_devices() -> None:
    assert conversion(Wired(property="p", scale=2.0, offset=0.1, unit="V"), "V", "V").to_lab(1.0) == pytest.approx(2.1)
    stated = conversion(Wired(property="angle", scale=0.01, offset=-1.8, unit="mm"), "deg", "mm")
    assert stated.to_lab(180.0) == pytest.approx(0.0)
    assert stated.to_device(0.0) == pytest.approx(180.0)
    assert conversion(Wired(property="x", offset=0.5), "mm", "um").to_lab(1.0) == pytest.approx(1500.0)


@pytest.mark.parametrize("zero", [12.5, -12.5, 90.0, 180.0, 359.9, 0.1, 300.0])
@pytest.mark.parametrize("angle", [0.0, 5.0, 12.4, 90.0, 179.9, 355.0, 360.0])
def test_every_angle_of_a_rotator_can_be_set_wherever_its_zero_is(zero: float, angle: float) -> None:
    wired = Wired(property="angle", offset=zero)
    made = conversion(wired, "deg", "deg", limits=(0.0, 360.0), range=(0.0, 360.0), period=180.0)
    told = made.to_device(angle)
    assert 0.0 <= told <= 360.0
    assert (told + zero - angle) % 360 == pytest.approx(0, abs=1e-9) or (told + zero - angle) % 360 == pytest.approx(
        360
    )
    read = made.to_lab(told)
    assert 0.0 <= read <= 360.0
    assert (read - angle + 180) % 360 - 180 == pytest.approx(0, abs=1e-9)


def test_an_offset_of_12_5_asks_for_352_5_on_the_wire() -> None:
    made = conversion(Wired(property="angle", offset=12.5), "deg", "deg", limits=(0, 360), range=(0, 360), period=180)
    assert made.to_device(5.0) == pytest.approx(352.5)
    assert made.to_lab(352.5) == pytest.approx(5.0)
    assert made.to_device(12.5) == 0.0


def test_a_half_turn_serves_where_a_whole_one_does_not_and_else_the_limit_is_told() -> None:
    wired = Wired(property="angle", offset=12.5)
    half = conversion(wired, "deg", "deg", limits=(0, 180), range=(0, 360), period=180)
    assert half.to_device(5.0) == pytest.approx(172.5)
    fixed = conversion(wired, "deg", "deg", limits=(0, 180), range=(0, 360))
    assert fixed.to_device(5.0) == pytest.approx(-7.5)  # the driver refuses it
    tilt = conversion(Wired(property="tilt", offset=1.0), "mrad", "mrad", limits=(-5, 5))
    assert tilt.to_device(-6.0) == pytest.approx(-7.0)
