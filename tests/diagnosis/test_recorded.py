"""Which part explains that light is not as it was recorded."""

from __future__ import annotations

import math

from pico.diagnosis.recorded import compared
from pico.model.measurement import Compared


def number(address: str, before: float, now: float, unit: str = "um", sigma: float = 1.0, **more: str) -> Compared:
    return Compared(address=address, before=before, now=now, unit=unit, sigma=sigma, **more)  # type: ignore[arg-type]


def test_numbers_are_quantities_once_each_by_the_surest_that_tells_the_same() -> None:
    numbers = [
        number("cam.centroid.x", 0.0, 9.0, sigma=5.0), number("cam.fit.x", 1.0, 8.0, sigma=2.0),
        number("cam.fit.peak", 90.0, 10.0, "count"), number("cam.fit.angle", 3.0, 60.0, "deg"),
        number("cam.fit.major", 400.0, 900.0), number("cam.fit.minor", 100.0, 400.0),
        Compared(address="cam.fit.y", why="it was not measured now"),
    ]  # fmt: skip
    found = {one.quantity.name: one for one in compared(numbers)}
    assert found.keys() == {"cam.fit.x", "cam.fit.major"}
    assert found["cam.fit.x"].now.value == 8.0 and found["cam.fit.x"].now.sigma == 2.0
    assert found["cam.fit.x"].quantity.shots[0].address == "cam.centroid", "which the ray model knows"
    size = found["cam.fit.major"]
    assert math.isclose(size.now.value - size.then.value, math.log(3)) and size.quantity.number == "size"


def test_a_power_is_told_as_it_was_read_whatever_its_laser_did() -> None:
    told = number("cam.light", 100.0, 100.0, "count/ms", reference="laser.monitor")
    found = {one.quantity.name: one for one in compared([told, number("laser.monitor", 2.0, 1.0, "mW")])}
    for name in ("cam.light", "laser.monitor"):
        assert math.isclose(found[name].now.value - found[name].then.value, -math.log(2)), name


def test_what_is_dark_is_no_quantity() -> None:
    assert not [*compared([number("cam.light", 100.0, 0.0), number("pd.voltage", 0.0, 1.0)])]
