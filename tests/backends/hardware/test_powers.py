"""What a power meter's reply becomes on a real bench: a power in the lab's unit, told the wavelength of the light, or
the reason why there is none. Over the wire, with emulators that PICO's own drivers are asked through."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from pico.backends.hardware.instruments import wired
from pico.backends.hardware.measuring import Readers
from pico.backends.hardware.powers import color_at, without_dark
from pico.backends.hardware.settings import Settings
from pico.backends.measured import Reading, measurement
from pico.drivers.registry import Buses
from pico.emulators.behind import Alone
from pico.emulators.registry import EmulatedBench
from pico.manifest.load import load_folder
from pico.model.calibration.results import DarkLevel
from pico.model.measurement import incomparable
from pico.model.observation import Observation, ObservedComponent
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry, Wired, Wiring
from pico.places.bench import BenchPlace
from pico.resources import labs_dir

ENTRY = DeviceEntry(driver="scpi.meter", of="meter", emulator="scpi.meter", address={"visa": ""})
SEEN = Observation(backend="hardware", time=0.0, observed_at="", components={}, robots={})


@pytest.fixture(scope="module")
def lab() -> Setup:
    setup = load_folder(labs_dir() / "mach_zehnder").setup
    assert setup is not None
    return setup


@contextmanager
def meter(lab: Setup, place: BenchPlace, power: Any, entry: DeviceEntry) -> Iterator[tuple[Readers, Alone]]:
    """Readers of a bench whose meter is emulated, with `power` [W] behind it."""
    behind = Alone({"power": power})
    bench, buses = EmulatedBench({"pm": entry}, lambda name, one: behind), Buses()
    entries = {"pm": replace(entry, address=bench.entries["pm"].address)}
    setup = replace(lab, wiring=Wiring(lab=lab.lab.name, devices=entries))
    try:
        instruments = wired(setup, entries, buses, Settings(place))
        yield Readers(setup, place.root, instruments), behind
    finally:
        asyncio.run(buses.close())
        bench.close()


def read(lab: Setup, root: Path, power: Any, **changed: Any) -> Reading:
    place = BenchPlace(root, "hardware")
    with meter(lab, place, power, replace(ENTRY, **changed)) as (readers, _):
        return asyncio.run(readers.read("meter", "power"))


POWER = {"power": Wired(property="power")}


@pytest.mark.parametrize("wiring", [{}, POWER, {"power": Wired(property="power", unit="W")},
                                    {"power": Wired(property="power", scale=1000.0, unit="mW")}])  # fmt: skip
def test_a_power_is_the_same_with_and_without_a_map(wiring: dict[str, Wired], lab: Setup, tmp_path: Path) -> None:
    found = read(lab, tmp_path, 0.001, map=wiring)
    assert found.value == pytest.approx(1.0, rel=1e-3) and found.conditions == {"wavelength": ""}


@pytest.mark.parametrize(("power", "reason"), [
    (9.9e37, "over-range"), (float("inf"), "over-range"), (float("nan"), "no-number"), (9.91e37, "no-number"),
    (-9.9e37, "under-range"),
])  # fmt: skip
@pytest.mark.parametrize("driver", ["scpi.meter", "pymeasure.pm100"])
def test_what_is_no_reading_is_unknown_with_its_reason(
    driver: str, power: float, reason: str, lab: Setup, tmp_path: Path
) -> None:
    found = read(lab, tmp_path, power, map=POWER, driver=driver)
    assert (found.value, found.reason) == (None, reason) and found.unknown
    assert read(lab, tmp_path, power, driver=driver).reason == reason


def test_a_meter_is_told_the_wavelength_of_the_light_and_set_back_where_the_lab_sets_it(
    lab: Setup, tmp_path: Path
) -> None:
    light = color_at(lab, {}, {}, "meter").wavelength
    assert light is not None and 600 < light < 700
    place = BenchPlace(tmp_path, "hardware")
    with meter(lab, place, 0.001, replace(ENTRY, map=POWER)) as (readers, behind):
        asyncio.run(readers.read("meter", "power"))
        assert behind.read("wavelength") == pytest.approx(light, abs=0.01)
    both = {**POWER, "wavelength": Wired(property="wavelength")}
    with meter(lab, place, 0.001, replace(ENTRY, map=both)) as (readers, behind):
        one = readers._bench.tunables["meter.wavelength"]

        async def go() -> tuple[Any, Any]:
            set_to = await one.set(850.0)
            await readers.read("meter", "power")
            return set_to, (await one.read()).value

        assert asyncio.run(go()) == (850.0, 850.0)
        assert asyncio.run(readers.read("meter", "wavelength")).value == 850.0


def test_a_meter_that_stays_at_another_wavelength_is_not_assured_with_the_factor_or_unknown(
    lab: Setup, tmp_path: Path
) -> None:
    infrared = with_light(lab, 1090.0)
    place = BenchPlace(tmp_path, "hardware")

    def of(setup: Setup, entry: DeviceEntry, behind: float = 0.001) -> Reading:
        with meter(setup, place, behind, entry) as (readers, _):
            return asyncio.run(readers.read("meter", "power"))

    assert of(infrared, ENTRY).conditions == {"wavelength": ""}
    beyond = of(with_light(lab, 1550.0), ENTRY)  # the emulated meter refuses what is beyond 1100 nm
    assert (beyond.value, beyond.reason) == (None, "wavelength")
    assert beyond.unknown == "the detector is blind to the light: silicon sees nothing at 1550 nm"
    fixed = of(infrared, replace(ENTRY, settings={"wavelength": False}))
    assert (
        fixed.value == pytest.approx(1.0, rel=1e-3) and "can't be set to the 1090 nm" in fixed.conditions["wavelength"]
    )
    limited = of(infrared, replace(ENTRY, limits={"wavelength": (400.0, 1000.0)}))
    assert (limited.value, limited.reason) == (None, "wavelength")


def with_light(lab: Setup, wavelength: float) -> Setup:
    """Return the lab with sources of another wavelength."""
    catalog = {
        name: replace(
            kind, parameters={**kind.parameters, "wavelength": replace(kind.parameters["wavelength"], value=wavelength)}
        )
        if kind.optics.element == "source"
        else kind
        for name, kind in lab.catalog.items()
    }
    return replace(lab, catalog=catalog)


def test_the_factor_of_another_wavelength_is_told() -> None:
    from pico.backends.hardware.powers import Color, corrected
    from pico.model.catalog import Tunable
    from pico.model.instruments.readout import Readout

    readout = Readout(unit="W", value=0.001, settings={"wavelength": 1064.0})
    responds = Tunable(unit="nm", range=(400.0, 1100.0))
    found, doubt = corrected(readout, Color(532.0), responds)
    assert found is readout and "multiply by about 2," in doubt
    assert corrected(readout, Color(1063.8), responds) == (readout, "")
    assert corrected(readout, Color(532.0), None)[0].unknown == "wavelength"
    assert "unknown" in corrected(readout, Color(why="two lasers"), responds)[1]


def test_light_of_two_wavelengths_is_not_guessed(lab: Setup) -> None:
    sources = [n for n in lab.lab.inventory if lab.type_of(n).optics.element == "source"]
    (laser,) = sources
    kind = replace(lab.type_of(laser), name="green")
    kind = replace(
        kind, parameters={**kind.parameters, "wavelength": replace(kind.parameters["wavelength"], value=532.0)}
    )
    inventory = {**lab.lab.inventory, "green": replace(lab.lab.inventory[laser], type="green")}
    two = replace(lab, lab=replace(lab.lab, inventory=inventory), catalog={**lab.catalog, "green": kind})
    assert color_at(two, {}, {}, "meter").wavelength is None
    assert "green 532 nm" in color_at(two, {}, {}, "meter").why
    assert color_at(two, {laser: {"emission": False}}, {}, "meter").wavelength == 532.0
    assert color_at(two, {laser: {"wavelength": 532.0}}, {}, "meter").wavelength == 532.0
    assert color_at(two, {n: {"emission": False} for n in (laser, "green")}, {}, "meter").why.startswith("no source")
    poses = {"green": Pose(200, 200, 0), laser: Pose(200, 400, 0), "meter": Pose(600, 200, 0)}
    assert color_at(two, {}, poses, "meter").wavelength == 532.0


def test_a_reason_becomes_the_measurements(lab: Setup, tmp_path: Path) -> None:
    seen = replace(SEEN, components={"meter": ObservedComponent(presence="present")})
    known = lab.measurables_of("meter")["power"]

    def of(reading: Reading) -> Any:
        return measurement(lab, tmp_path, seen, known, reading, "meter", "power", [], "")

    over = of(Reading(None, unknown="above its range", reason="over-range"))
    assert (over.value, over.reason, over.unknown) == (None, "over-range", "above its range")
    dark = of(Reading(None, unknown="no light"))
    assert dark.reason == "not-computed"
    assert of(Reading(None, unknown="full", saturated="full")).reason == "saturated"
    good = of(Reading(1.0, saturated="", conditions={"wavelength": ""}))
    assert "wavelength" in good.assured and good.reason is None
    assert incomparable(good, of(Reading(1.0, saturated=""))) == ()  # an earlier record knows nothing of it
    doubtful = of(Reading(1.0, saturated="", conditions={"wavelength": "set to 1550 nm"}))
    assert list(incomparable(good, doubtful)) == ["not assured of the second: wavelength (set to 1550 nm)"]


def test_the_factor_of_a_known_detector_is_that_of_its_curve_and_a_blind_one_is_unknown() -> None:
    from pico.backends.hardware.powers import Color, corrected
    from pico.model.catalog import Tunable
    from pico.model.instruments.readout import Readout

    readout = Readout(unit="W", value=0.001, settings={"wavelength": 500.0})
    responds = Tunable(unit="nm", range=(400.0, 1700.0))
    _, doubt = corrected(readout, Color(633.0), responds, "silicon")
    assert doubt.endswith("multiply by about 0.734, for a head of silicon")
    found, doubt = corrected(readout, Color(1550.0), responds, "silicon")
    assert found.unknown == "wavelength" and "silicon sees nothing at 1550 nm" in found.why and not doubt


def test_what_a_meter_reads_without_light_is_taken_off_with_its_uncertainty() -> None:
    dark = DarkLevel(level=0.25, sigma=0.03, noise=0.1, unit="mW")
    found = without_dark(Reading(1.5, sigma=0.04), dark)
    assert found.value == pytest.approx(1.25) and found.sigma == pytest.approx(0.05)
    blind = Reading(None, unknown="over range", reason="over-range")
    assert without_dark(blind, dark) == blind
