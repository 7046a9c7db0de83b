"""Of which class a laser is, by power and wavelength: the table of docs/how-to/laser-safety.md, and what is unknown."""

from __future__ import annotations

import math
from typing import Any

import pytest
from laser_lab import STRONGEST, UNKNOWN, bench, commanded, observed, with_type

from pico.model.catalog import Parameter, Tunable
from pico.model.setup import Setup
from pico.optics.audit.lasers import laser_class, lasers_of, shines, unread_power
from pico.optics.audit.limits import above_class_2, class_1, class_of

SETUP = bench()


def limits(nm: float) -> tuple[float, float, float, float]:
    """Of class 1, 2, 3R and 3B [mW], as the table has them; class 2 is that of class 1 where there is none."""
    if nm <= 700:
        return 0.039 if nm <= 450 else 0.39, 1.0, 5.0, 500.0
    first = 0.39 * 10 ** (0.002 * (nm - 700))
    return first, first, 5 * first, 500.0


@pytest.mark.parametrize("nm", [400.0, 532.0, 632.8, 700.0, 700.1, 850.0, 1000.0, 1050.0])
@pytest.mark.parametrize("factor", [0.5, 0.999, 1.0, 1.001, 2.0])
def test_a_laser_is_of_the_lowest_class_whose_limit_it_keeps(nm: float, factor: float) -> None:
    for limit in limits(nm):
        power = limit * factor
        wanted = next((n for n, most in zip(("1", "2", "3R", "3B"), limits(nm), strict=True) if power <= most), "4")
        assert class_of(power, nm) == wanted, (power, nm)
    assert class_1(nm) == pytest.approx(limits(nm)[0])


@pytest.mark.parametrize("nm", [0.0, 179.9, 10600.1, math.nan, math.inf])
@pytest.mark.parametrize("power", [1e-9, 0.1, 1000.0])
def test_where_no_limit_is_known_a_laser_is_of_class_4(nm: float, power: float) -> None:
    assert class_of(power, nm) == "4" and class_1(nm) is None


@pytest.mark.parametrize(("of", "above"), [("1", False), ("2", False), ("3R", True), ("3B", True), ("4", True)])
def test_what_harms_before_anybody_blinks_is_above_class_2(of: Any, above: bool) -> None:
    assert above_class_2(of) is above


@pytest.mark.parametrize("emission", [True, False, None, "on", 1])
@pytest.mark.parametrize("shutter", ["open", "closed", None, "ajar"])
def test_a_laser_shines_where_it_emits_and_is_not_closed(emission: Any, shutter: Any) -> None:
    values = {k: v for k, v in {"emission": emission, "shutter": shutter}.items() if v is not None}
    assert shines(SETUP, "laser", values) is (emission is True and shutter != "closed")
    always = with_type(SETUP, "laser", tunables={})
    assert shines(always, "laser", values) is (shutter != "closed"), "one that cannot be switched is on"
    assert lasers_of(SETUP, ["laser", "cam", "gate"], {"laser": values}) == (
        ("laser",) if emission is True and shutter != "closed" else ()
    )
    lit = {"emission": True}
    assert lasers_of(SETUP, ["second", "laser", "holder"], {"laser": lit, "second": lit}) == ("laser", "second")


def setup(**own: Tunable | tuple[float, str]) -> Setup:
    """The bench with other tunables and parameters (value and unit) of `laser`."""
    kind = SETUP.type_of("laser")
    tunables = {n: t for n, t in kind.tunables.items() if n != "power"}
    tunables |= {n: t for n, t in own.items() if isinstance(t, Tunable)}
    parameters = {n: p for n, p in kind.parameters.items() if n not in ("power", "wavelength")}
    parameters |= {n: Parameter(value=t[0], unit=t[1]) for n, t in own.items() if not isinstance(t, Tunable)}
    return with_type(SETUP, "laser", tunables=tunables, parameters=parameters)


def told(lab: Setup, **values: Any) -> tuple[str, float]:
    of, power = laser_class(lab, "laser", values)
    return of, round(power, 6)


def test_power_and_wavelength_are_read_from_tunable_or_type_and_else_a_helium_neon_laser_of_1_mw() -> None:
    assert told(setup()) == ("2", 1.0) == told(setup(wavelength=(632.8, "nm")))
    assert told(setup(power=(4.0, "mW"))) == ("3R", 4.0) == told(setup(power=(0.004, "W")))
    assert told(setup(power=Tunable(unit="mW", range=(0.0, 9.0))), power=4.0) == ("3R", 4.0)
    assert told(setup(power=Tunable(unit="W", range=(0.0, 9.0))), power=0.004) == ("3R", 4.0)
    assert told(setup(power=Tunable(range=(0.0, 9.0))), power=4.0) == ("3R", 4.0)
    assert told(setup(power=Tunable(unit="mW", range=(0.0, 9.0)), wavelength=(850.0, "nm")), power=0.9) == ("3R", 0.9)
    assert told(setup(power=Tunable(unit="mW", range=(0.0, 9.0)), wavelength=(1.064, "um")), power=0.1) == ("1", 0.1)
    assert told(
        setup(power=Tunable(unit="mW"), wavelength=Tunable(unit="um", range=(0.4, 0.7))), power=0.1, wavelength=0.532
    ) == ("1", 0.1)
    assert told(setup(), power=900.0, wavelength=1064.0) == ("2", 1.0), "it has no such tunables"


@pytest.mark.parametrize("value", [None, True, "full"])
def test_a_power_that_nobody_knows_is_the_highest_of_its_range(value: Any) -> None:
    given = {} if value is None else {"power": value}
    lab = setup(power=Tunable(unit="mW", range=(0.0, STRONGEST)))
    assert told(lab, **given) == ("3B", STRONGEST) and unread_power(lab, "laser", given) == STRONGEST
    watts = setup(power=Tunable(unit="W", range=(0.0, 0.1)))
    assert told(watts, **given) == ("3B", 100.0) and unread_power(watts, "laser", given) == 0.1
    for unit in ("mW", "W"):
        endless = setup(power=Tunable(unit=unit))
        assert told(endless, **given) == ("4", math.inf) and unread_power(endless, "laser", given) is None
    assert unread_power(setup(), "laser", given) is None
    assert unread_power(lab, "laser", {"power": 3}) is None is unread_power(lab, "laser", {"power": 0.0})


@pytest.mark.parametrize(("low", "high", "of"), [
    (500.0, 600.0, "2"), (650.0, 750.0, "3R"), (690.0, 1040.0, "3R"), (900.0, 1000.0, "1"), (1000.0, 1100.0, "1"),
    (350.0, 500.0, "3B"), (100.0, 300.0, "4"), (300.0, 320.0, "3B"), (700.0, 700.0, "2"),
])  # fmt: skip
def test_a_wavelength_that_nobody_knows_is_the_most_dangerous_of_its_range(low: float, high: float, of: str) -> None:
    lab = setup(power=Tunable(unit="mW", range=(0.0, 9.0)), wavelength=Tunable(unit="nm", range=(low, high)))
    assert told(lab, power=0.9) == (of, 0.9)
    assert told(lab, power=0.9, wavelength=532.0) == ("2", 0.9)


def test_what_was_only_commanded_is_not_known() -> None:
    for value in (UNKNOWN, commanded(0.1)):
        values = observed(laser={"power": value}).known_values["laser"]
        assert laser_class(SETUP, "laser", values) == ("3B", STRONGEST)
