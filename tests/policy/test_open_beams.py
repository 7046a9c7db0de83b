"""Which beams may be open while an operation runs: against every order in which a plan may be carried out."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from laser_lab import UNKNOWN, bench, carry, commanded, observed, set_to

from examples import examples
from pico.model.observation import Observation
from pico.model.operation import Operation, Reason
from pico.policy.beams import open_beams

SETUP = bench()
KINDS = ("open", "close", "other", "lens", "near")


def op(kind: str, id: str, after: tuple[str, ...] = ()) -> Operation:
    """An operation that opens or closes `laser`, one of another laser, one that moves a part, one like a closing."""
    found = {
        "open": set_to("laser", "shutter", "open"), "close": set_to("laser", "shutter", "closed"),
        "other": set_to("second", "shutter", "closed"), "lens": carry("holder", 500, 700),
        "near": set_to("laser", "power", "closed"),
    }[kind]  # fmt: skip
    return replace(found, id=id, after=after)


def orders(operations: Sequence[Operation]) -> list[Sequence[Operation]]:
    """Every order that keeps what comes after what."""
    found = []
    for order in itertools.permutations(operations):
        place = {one.id: n for n, one in enumerate(order)}
        if all(place[a] < place[one.id] for one in order for a in one.after if a in place):
            found.append(order)
    return found


def may_be_open(operations: Sequence[Operation], at: Operation, closed: bool) -> bool:
    """Whether some order has the shutter of `laser` open when an operation is carried out; an operation that opens or
    closes the beam takes all its time for it."""
    for order in orders(operations):
        open_now = not closed
        for one in order:
            if one.component == "laser" and one.arguments.get("tunable") == "shutter":
                if one is at and (open_now or one.arguments["to"] == "open"):
                    return True
                open_now = one.arguments["to"] == "open"
            if one is at and open_now:
                return True
    return False


@st.composite
def plans(draw: st.DrawFn) -> list[Operation]:
    count = draw(st.integers(1, 5))
    made = []
    for n in range(count):
        after = draw(st.lists(st.sampled_from([f"o{m}" for m in range(n)] or ["gone"]), max_size=2, unique=True))
        made.append(op(draw(st.sampled_from(KINDS)), f"o{n}", tuple(after)))
    return draw(st.permutations(made))


@given(plans(), st.booleans())
@settings(max_examples=examples(300))
def test_a_beam_counts_as_closed_where_it_is_in_every_order(operations: list[Operation], closed: bool) -> None:
    seen = observed(laser={"shutter": "closed" if closed else "open", "power": 4.0})
    found = open_beams(SETUP, operations, seen, ["laser"])
    for one in operations:
        if one.component != "laser":
            assert (found[one.id] == ["laser"]) is may_be_open(operations, one, closed), (one.id, operations)


MOVE = op("lens", "m")


@pytest.mark.parametrize("order", list(itertools.permutations(range(4))))
@pytest.mark.parametrize("closed", [True, False])
def test_an_opening_that_is_closed_again_before_leaves_the_beam_closed(order: Sequence[int], closed: bool) -> None:
    chain = [op("open", "o", ("x",)), op("close", "c", ("o",)), op("lens", "m", ("c",)), op("other", "x")]
    seen = observed(laser={"shutter": "closed" if closed else "open"})
    assert open_beams(SETUP, [chain[n] for n in order], seen, ["laser"])["m"] == []
    broken = [replace(chain[n], after=()) if chain[n].id == "c" else chain[n] for n in order]
    assert open_beams(SETUP, broken, seen, ["laser"])["m"] == ["laser"], "it may be opened last"


@pytest.mark.parametrize("emission", [True, False, UNKNOWN, commanded(False), None])
@pytest.mark.parametrize("shutter", ["open", "closed", UNKNOWN, commanded("closed"), None])
def test_only_what_was_read_back_closes_a_beam(emission: Any, shutter: Any) -> None:
    seen = observed(laser={"emission": emission, "shutter": shutter})
    shut = emission is False or shutter == "closed"
    assert open_beams(SETUP, [MOVE], seen, ["laser"]) == {"m": [] if shut else ["laser"]}
    lit = [set_to("laser", "emission", True, "e"), MOVE]
    assert open_beams(SETUP, lit, seen, ["laser"])["m"] == ([] if shutter == "closed" else ["laser"])
    unlit = [set_to("laser", "emission", False, "e"), set_to("second", "emission", True, "f"), MOVE]
    assert open_beams(SETUP, unlit, seen, ["laser"])["m"] == ([] if shut else ["laser"])


@pytest.mark.parametrize("to", ["open", "ajar", None, False])
def test_a_shutter_that_is_set_to_anything_but_closed_opens(to: Any) -> None:
    seen = observed()
    assert open_beams(SETUP, [set_to("laser", "shutter", to, "o"), MOVE], seen, ["laser"])["m"] == ["laser"]
    shut = [set_to("laser", "shutter", "closed", "o"), replace(MOVE, after=("o",))]
    assert open_beams(SETUP, shut, observed(laser={"shutter": "open"}), ["laser"])["m"] == []
    scan = Operation(id="o", primitive="scan", component="laser", arguments={"tunable": "shutter", "to": "closed"},
                     reason=Reason(kind="asked"))  # fmt: skip
    scanned = [scan, replace(MOVE, after=("o",))]
    assert open_beams(SETUP, scanned, observed(laser={"shutter": "open"}), ["laser"])["m"] == ["laser"]


def test_each_laser_is_judged_by_its_own_shutter_and_one_that_is_not_there_is_open() -> None:
    seen = observed(laser={"shutter": "open"}, bare={"emission": True})
    assert open_beams(SETUP, [MOVE], seen, ["laser", "second", "bare"]) == {"m": ["laser", "bare"]}
    assert open_beams(SETUP, [MOVE], seen, []) == {"m": []} and open_beams(SETUP, [], seen, ["laser"]) == {}
    nobody = Observation(backend="sim", components={})
    assert open_beams(SETUP, [MOVE], nobody, ["laser"]) == {"m": ["laser"]}


def test_a_laser_without_a_shutter_of_its_own_is_closed_by_the_one_in_its_beam() -> None:
    from laser_lab import POSES

    seen = observed(bare={"emission": True}, gate={"shutter": "closed"})
    assert open_beams(SETUP, [MOVE], seen, ["bare"]) == {"m": ["bare"]}, "the shutter stands in another beam"
    before = {**seen.components, "gate": replace(seen.components["gate"], pose=replace(POSES["bare"], x=300.0))}
    seen = replace(seen, components=before)
    assert open_beams(SETUP, [MOVE], seen, ["bare"]) == {"m": []}
    opening = [set_to("gate", "shutter", "open", "o"), MOVE]
    assert open_beams(SETUP, opening, seen, ["bare"])["m"] == ["bare"]
    away = [carry("gate", 300, 700, "g"), MOVE]
    assert open_beams(SETUP, away, seen, ["bare"])["m"] == ["bare"], "it is carried off"
    own = observed(laser={"shutter": "open"}, gate={"shutter": "closed"})
    assert open_beams(SETUP, [MOVE], own, ["laser"]) == {"m": ["laser"]}, "a shutter of its own is what counts"
