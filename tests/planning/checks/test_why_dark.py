"""Why no light reaches a detector: what shuts it off on the way, and what is missing there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from pico.manifest.load import load_folder
from pico.model.observation import Observation, ObservedValue
from pico.model.request import as_stated
from pico.planning.darkness import darkness

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
