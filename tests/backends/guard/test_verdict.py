"""The truth table of the guard: when light must end, and of which lasers."""

from __future__ import annotations

from itertools import product
from typing import get_args

import pytest

from pico.backends.hardware.guard.verdict import MOTION, InputState, LaserState, verdict
from pico.model.arming import CLASSES, LaserClass
from pico.model.wiring import SafetyKind

KINDS: tuple[SafetyKind, ...] = get_args(SafetyKind)
ENDS_ALWAYS = {"door", "emergency_stop", "key", "interlock"}
SHUTTERS: tuple[tuple[bool | None, ...], ...] = ((), (True,), (False,), (None,), (True, False), (None, True))


@pytest.mark.parametrize("kind", KINDS)
def test_an_unsafe_input_ends_light_unless_it_is_proven_dark(kind: SafetyKind) -> None:
    for emission, shutters, of, presence, why in product(
        (True, False, None), SHUTTERS, CLASSES, (None, *CLASSES), ("", "is not safe")
    ):
        state = LaserState(emission=emission, shutters=shutters, of=of)
        dark = emission is False or any(shutter is False for shutter in shutters)
        counts = kind in ENDS_ALWAYS or (
            kind == "curtain" and presence is not None and CLASSES.index(of) >= CLASSES.index(presence)
        )
        trip = verdict({"it": InputState(kind=kind, why=why)}, {"laser": state}, presence)
        assert (trip is not None) is (bool(why) and counts and not dark), (emission, shutters, of, presence, why)
        if trip is not None:
            assert trip.lasers == ("laser",) and trip.stops_arms is (kind in MOTION)
            assert trip.said == f"it ({kind.replace('_', ' ')}) is not safe"


@pytest.mark.parametrize("emission", [True, False, None])
@pytest.mark.parametrize("shutters", SHUTTERS)
def test_a_silent_device_of_a_laser_ends_its_light_alone(
    emission: bool | None, shutters: tuple[bool | None, ...]
) -> None:
    silent = LaserState(emission=emission, shutters=shutters, silent={"a.shutter": "has not answered for 0.7 s"})
    trip = verdict({}, {"a": silent, "b": LaserState(emission=True)})
    assert (trip is None) is silent.is_dark
    if trip is not None:
        assert trip.lasers == ("a",) and not trip.stops_arms
        assert trip.said == "a.shutter has not answered for 0.7 s"


def test_every_input_and_every_laser_counts() -> None:
    lit, dark = LaserState(emission=True, of="2"), LaserState(emission=False, of="4")
    inputs = {
        "veil": InputState(kind="curtain", why="is not safe"), "door": InputState(kind="door"),
        "lock": InputState(kind="interlock", why="is not known to be safe"),
    }  # fmt: skip
    trip = verdict(inputs, {"a": lit, "b": dark, "c": LaserState(emission=None, shutters=(None,), of="3B")}, "3B")
    assert trip is not None and trip.lasers == ("a", "c")
    assert [cause.name for cause in trip.causes] == ["lock", "veil"] and trip.stops_arms
    assert verdict(inputs, {"b": dark}, "3B") is None and verdict({}, {"a": lit}) is None


@pytest.mark.parametrize("of", CLASSES)
def test_any_class_is_guarded(of: LaserClass) -> None:
    trip = verdict({"door": InputState(kind="door", why="is not safe")}, {"a": LaserState(emission=True, of=of)})
    assert trip is not None and trip.lasers == ("a",)
