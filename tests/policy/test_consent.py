"""What is asked about before it runs: what moves, and what lets light out."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from pico.manifest.load import load_folder
from pico.model.operation import Operation, Reason
from pico.policy.consent import asked_about, lights
from pico.resources import labs_dir


def op(primitive: str, component: str, tunable: str = "", to: Any = None) -> Operation:
    arguments = {"tunable": tunable, "to": to} if tunable else {}
    return Operation(
        id="op1", primitive=primitive, component=component, arguments=arguments, reason=Reason(kind="asked")
    )


@pytest.mark.parametrize(
    ("operation", "asked", "light"),
    [
        (op("move", "p2"), True, ()),
        (op("park", "arm1"), True, ()),
        (op("operator", "cam"), True, ()),
        (op("home", "p1", "angle"), True, ()),
        (op("set", "p1", "angle", 3.0), True, ()),
        (op("polish", "p1"), True, ()),
        (op("set", "p1", "nothing", 3.0), True, ()),
        (op("set", "laser", "shutter", "open"), True, ("laser.shutter",)),
        (op("set", "laser", "emission", True), True, ("laser.emission",)),
        (op("set", "laser", "shutter", "closed"), False, ()),
        (op("set", "laser", "emission", False), False, ()),
        (op("set", "cam", "exposure", 3.0), False, ()),
        (op("measure", "cam"), False, ()),
    ],
)
def test_what_moves_or_lets_light_out_is_asked_about(operation: Operation, asked: bool, light: tuple[str, ...]) -> None:
    setup, _ = load_folder(labs_dir() / "shel").require()
    assert (asked_about(setup, [operation]), lights(setup, [operation])) == (asked, light)
    assert asked_about(setup, []) is False


def test_light_that_was_out_before_and_is_only_shut_for_a_while_is_no_news() -> None:
    setup, _ = load_folder(labs_dir() / "shel").require()

    def told(before: str | None) -> tuple[str, ...]:
        shut, again = op("set", "laser", "shutter", "closed"), op("set", "laser", "shutter", "open")
        return lights(setup, [replace(shut, arguments={**shut.arguments, "from": before}), op("move", "p2"), again])

    assert told("open") == ()
    assert told(None) == told("closed") == ("laser.shutter",)
