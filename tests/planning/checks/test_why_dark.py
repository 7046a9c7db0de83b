"""Why no light reaches a detector: what shuts it off on the way, and what is missing there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from pico.bench.placing import slope_of
from pico.diagnostics import PicoError
from pico.manifest.catalog import load_catalog
from pico.manifest.load import load_folder
from pico.model.catalog import Parameter
from pico.model.goal import Goal
from pico.model.lab import Lab, Part, Table
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.pose import Pose
from pico.model.request import as_stated
from pico.model.setup import Setup
from pico.optics.beam_table import troubles
from pico.optics.light import light_of
from pico.planning.darkness import darkness, unlit

SETUP, STATE = load_folder(Path(__file__).parents[3] / "labs" / "mach_zehnder").require()
SEEN = as_stated(SETUP, STATE)
DETECTOR = next(n for n in STATE.components if SETUP.type_of(n).optics.element == "detector")
LASER = next(n for n in SETUP.lab.inventory if SETUP.type_of(n).optics.element == "source")
MIRROR = "m1"  # through which all light comes


def told(seen: Observation) -> tuple[str, ...]:
    return darkness(SETUP, seen, STATE, DETECTOR)


def seen_with(name: str, **changes: Any) -> Observation:
    return replace(SEEN, components={**SEEN.components, name: replace(SEEN.components[name], **changes)})


def test_light_that_comes_has_no_reason_to_be_missing() -> None:
    assert (
        told(seen_with(LASER, values={"emission": ObservedValue(value=True), "shutter": ObservedValue(value="open")}))
        == ()
    )


def test_what_is_off_and_what_is_shut_are_both_named() -> None:
    off = {"emission": ObservedValue(value=False), "shutter": ObservedValue(value="closed")}
    assert told(seen_with(LASER, values=off)) == (f"{LASER} is switched off", f"{LASER}.shutter is closed")


def test_a_part_of_the_way_that_is_missing_or_in_storage_is_named() -> None:
    home = SETUP.lab.inventory[MIRROR].home
    assert home is not None
    assert told(seen_with(MIRROR, pose=SETUP.lab.slots[home].pose)) == (f"{MIRROR} is in {home}",)
    assert told(seen_with(MIRROR, pose=None, presence="missing")) == (f"{MIRROR} is missing",)


def a_line(kind: str, pose: Pose, wavelength: float = 632.8, **values: Any) -> tuple[Setup, Observation]:
    """A bench with a laser, a part of a kind, and a meter behind it."""
    at = {"laser": Pose(150, 400), "part": pose, "pm": Pose(800, 400)}
    kinds = {"laser": "hene_laser", "part": kind, "pm": "power_meter"}
    catalog = load_catalog()
    laser = catalog["hene_laser"]
    own = {**laser.parameters, "wavelength": Parameter(value=wavelength, unit="nm")}
    parts = {name: Part(type=kinds[name], pose=at[name]) for name in at}
    lab = Lab(name="light", table=Table(size=(1200, 900)), robots={}, inventory=parts)
    setup = Setup(lab=lab, catalog={**catalog, "hene_laser": replace(laser, parameters=own)})
    known = {"laser": {"emission": True, "shutter": "open"}, "part": values, "pm": {"wavelength": wavelength}}
    seen = {
        n: ObservedComponent(
            presence="seen", pose=at[n], values={t: ObservedValue(value=v) for t, v in known[n].items()}
        )
        for n in at
    }
    return setup, replace(SEEN, components=seen)


INTO = Pose(450, 400)


@pytest.mark.parametrize(
    ("kind", "pose", "wavelength", "values", "why"),
    [
        ("chopper", INTO, 632.8, {"blades": "closed"}, "part.blades is closed"),
        ("shutter", INTO, 632.8, {"shutter": "closed"}, "part.shutter is closed"),
        ("bandpass_filter", INTO, 660, {}, "part passes only 0.01 % of the beam of laser at 660 nm"),
        ("bandpass_filter", Pose(450, 400, 30), 632.8, {}, "part passes only 0.01 % of the beam of laser at 632.8 nm"),
        ("mirror_flip", Pose(450, 400, 45), 632.8, {"flipped": "up"}, "part.flipped is up"),
        ("mirror_flip", Pose(450, 400, 45), 632.8, {}, "part.flipped is unknown, and may be up"),
        ("mirror_fixed", Pose(450, 400, 45), 632.8, {}, "the beam of laser leaves the table, turned by part"),
        ("beam_block", INTO, 632.8, {}, "the beam of laser ends on part"),
    ],
)
def test_what_takes_the_light_out_of_a_way_is_named(
    kind: str, pose: Pose, wavelength: float, values: dict[str, Any], why: str
) -> None:
    setup, seen = a_line(kind, pose, wavelength, **values)
    assert darkness(setup, seen, as_seen(setup, seen), "pm") == (why,)


@pytest.mark.parametrize(
    ("kind", "pose", "wavelength", "values"),
    [
        ("chopper", INTO, 632.8, {"blades": "turning"}),
        ("chopper", INTO, 632.8, {}),
        ("bandpass_filter", INTO, 632.8, {}),
        ("bandpass_filter", Pose(450, 400, 30), 612, {}),
        ("mirror_flip", Pose(450, 400, 45), 632.8, {"flipped": "down"}),
        ("neutral_density_filter", INTO, 632.8, {}),
        ("linear_polarizer", INTO, 632.8, {"angle": 90.0}),
        ("iris", INTO, 632.8, {"opening": 1.0}),
    ],
)
def test_what_lets_light_through_is_not_blamed(
    kind: str, pose: Pose, wavelength: float, values: dict[str, Any]
) -> None:
    setup, seen = a_line(kind, pose, wavelength, **values)
    assert darkness(setup, seen, as_seen(setup, seen), "pm") == ()


def as_seen(setup: Setup, seen: Observation) -> Any:
    from pico.model.observation import live_state

    return live_state(setup, seen)


def test_a_search_behind_a_closed_chopper_is_refused_but_not_behind_what_it_may_open() -> None:
    goal = Goal(tunables={"part.angle": (0, 1)}, maximize="pm.power")
    assert unlit(*a_line("chopper", INTO, blades="closed"), goal) == "no light reaches pm: part.blades is closed"
    assert unlit(*a_line("bandpass_filter", INTO, 660), goal) == ""


@pytest.mark.parametrize("kind", ["shutter", "chopper"])
def test_a_beam_may_end_on_what_is_closed(kind: str) -> None:
    closed = {"shutter": "closed"} if kind == "shutter" else {"blades": "closed"}
    setup, seen = a_line(kind, INTO, **closed)
    poses = {n: p.pose for n, p in seen.components.items() if p.pose}
    found = troubles(setup, light_of(setup, poses, seen.known_values))
    assert [d.summary for d in found if d.code == "beam"] == []


@pytest.mark.parametrize(("slot", "known"), [("a2", True), (None, False)])
def test_a_part_in_storage_is_named_before_an_arm_centers_it(slot: str | None, known: bool) -> None:
    setup, state = load_folder(Path(__file__).parents[3] / "labs" / "minimal").require()
    seen = as_stated(setup, state)
    lens = seen.components["lens"]
    pose = setup.lab.slots[f"storage/{slot}"].pose if slot else Pose(700, 700)
    seen = replace(seen, components={**seen.components, "lens": replace(lens, pose=pose)})
    with pytest.raises(PicoError) as wrong:
        slope_of(setup, seen, "lens", "camera")
    (told,) = wrong.value.diagnostics
    assert ("lens is in storage/a2" in told.summary) is known
    assert ("hardly moves with lens" in told.summary) is not known
