"""What a device is told for a number of the lab, and back: units, sign, scale and offset of a wired tunable."""

from __future__ import annotations

import math

import pytest

from pico.model.wiring import Wired

MRAD_OF_DEG = math.pi / 180 * 1000


@pytest.mark.parametrize(("wired", "unit", "lab", "device"), [
    (Wired(property="angle"), "deg", 90.0, 90.0),
    (Wired(property="angle", scale=2.0), "deg", 90.0, 45.0),
    (Wired(property="angle", scale=-1.0), "deg", 90.0, -90.0),
    (Wired(property="angle", offset=10.0), "deg", 90.0, 80.0),
    (Wired(property="angle", scale=-2.0, offset=10.0), "deg", 90.0, -40.0),
    (Wired(property="angle", unit="deg"), "mrad", MRAD_OF_DEG, 1.0),
    (Wired(property="angle", unit="mrad"), "deg", 1.0, MRAD_OF_DEG),
    (Wired(property="angle", offset=2.0, unit="deg"), "mrad", MRAD_OF_DEG * 3.0, 1.0),
    (Wired(property="angle", scale=0.5, offset=2.0, unit="deg"), "mrad", MRAD_OF_DEG * 3.0, 2.0),
    (Wired(property="angle", scale=-0.5, offset=-2.0, unit="deg"), "mrad", MRAD_OF_DEG * 3.0, -10.0),
    (Wired(property="position", scale=1e-3, unit="mm"), "um", 5.0, 5.0),
    (Wired(property="position", scale=-1e-3, offset=1.0, unit="mm"), "um", 0.0, 1000.0),
])  # fmt: skip
def test_scale_and_offset_are_in_the_unit_of_the_wiring_and_lead_there_and_back(
    wired: Wired, unit: str, lab: float, device: float
) -> None:
    assert wired.to_device(lab, unit) == pytest.approx(device)
    assert wired.to_lab(device, unit) == pytest.approx(lab)


def test_a_scale_of_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="is not 0"):
        Wired(property="angle", scale=0.0)
