"""Beams are shut around what is done in them."""

from __future__ import annotations

from dataclasses import replace

from drafts import LIT, begun, lit, op, setting, waits

from pico.model.lab import Policy
from pico.planning.passes.interlocks import interlocked

MOVES = (op("a", robot="arm1"), op("b", "a", robot="arm1"), op("arm1", "b", robot="arm1", primitive="park"))
SHUT = {"a": ("laser shutter closed",), "b": ("a",), "arm1": ("b",)}


def test_a_shutter_closes_before_the_first_move_and_opens_after_the_last() -> None:
    found = waits(interlocked(replace(begun(lit()), operations=MOVES)).operations)
    assert found == {**SHUT, "laser shutter closed": (), "laser shutter open": ("b", "arm1")}


def test_one_that_the_plan_sets_anyway_is_set_once() -> None:
    asked = setting("laser", "shutter", "closed", "b")
    found = waits(interlocked(replace(begun(lit()), operations=(*MOVES, asked))).operations)
    assert found == {**SHUT, "laser shutter closed": ()}  # at once, though it waited


def test_one_that_is_closed_is_left_so_and_none_where_the_beam_may_stay_open() -> None:
    closed = begun(lit(), values={"laser": {**LIT["laser"], "shutter": "closed"}})
    beside = (setting("a", "angle", 5.0),)
    for draft in (
        replace(closed, operations=MOVES),
        replace(begun(lit(policy=Policy(open_beam=True))), operations=MOVES),
        replace(begun(lit()), operations=beside),
    ):
        assert interlocked(draft) == draft


def test_a_laser_that_nobody_lets_emit_stays_shut() -> None:
    found = waits(interlocked(replace(begun(lit(strong=True)), operations=MOVES)).operations)
    assert "laser shutter open" not in found and found["a"] == ("laser shutter closed",)
