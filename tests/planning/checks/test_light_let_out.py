"""Which operations let light out, of which class, and whether anybody lets them: the rule, case by case.

The rule (docs/how-to/laser-safety.md): light is let out by whatever opens a shutter or turns a source on or up; what is
unknown counts as open and on, a power as the highest that it has or gets; above class 2 only a licence lets it.
"""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import pytest
from laser_lab import STRONGEST, UNKNOWN, bench, carry, commanded, observed, search, set_to, with_type

from pico.model.arming import CLASSES, Licence
from pico.model.observation import Observation
from pico.model.operation import Operation, Reason
from pico.planning.checks import emission
from pico.planning.checks.emission import is_dark, let_out, lets_out, licensed, may_shine, uncovers

SETUP = bench()
LIT = {"emission": True, "shutter": "open"}


def at(power: float) -> str:
    """The class of a continuous laser at 633 nm, by the table of docs/how-to/laser-safety.md."""
    return next(name for name, most in zip(CLASSES, (0.39, 1.0, 5.0, 500.0, 1e9), strict=True) if power <= most)


# what is dark


@pytest.mark.parametrize(("tunable", "value", "dark"), [
    ("shutter", "closed", True), ("shutter", "open", False), ("shutter", None, False), ("shutter", False, False),
    ("shutter", 0, False), ("shutter", "Closed", False), ("shutter", "ajar", False),
    ("emission", False, True), ("emission", True, False), ("emission", None, False), ("emission", 0, False),
    ("emission", "off", False), ("emission", "closed", False),
    ("power", 0, True), ("power", 0.0, True), ("power", 1e-9, False), ("power", -1, False), ("power", False, False),
    ("power", "0", False), ("power", None, False), ("power", "closed", False), ("current", 0, True),
    ("current", 2.0, False),
])  # fmt: skip
def test_only_what_surely_means_no_light_is_dark(tunable: str, value: Any, dark: bool) -> None:
    assert is_dark(tunable, value) is dark


# what lets light out

TO = {
    "shutter": ("open", "closed"), "emission": (True, False), "power": (0.5, 0.0),
}  # fmt: skip


@pytest.mark.parametrize("primitive", ["set", "operator"])
@pytest.mark.parametrize("part", ["laser", "bare", "gate", "holder", "cam", "stranger"])
@pytest.mark.parametrize("tunable", ["shutter", "emission", "power", "angle"])
@pytest.mark.parametrize("dark", [False, True])
def test_setting_lets_light_out_of_sources_and_through_any_shutter_unless_the_value_is_dark(
    primitive: str, part: str, tunable: str, dark: bool
) -> None:
    to = TO.get(tunable, (5.0, 0.0))[dark]
    gates = part != "stranger" and (tunable == "shutter" or part in ("laser", "bare"))
    assert lets_out(SETUP, set_to(part, tunable, to, primitive=primitive)) is (gates and not dark)


def test_a_step_by_hand_at_a_laser_that_names_no_tunable_is_no_light() -> None:
    words = Operation(id="h", primitive="operator", component="laser", arguments={"text": "dust it"},
                      reason=Reason(kind="operator"))  # fmt: skip
    assert not lets_out(SETUP, words) and let_out(SETUP, observed(), [words]) == {}


@pytest.mark.parametrize("part", ["laser", "gate", "holder", "cam", "stranger"])
@pytest.mark.parametrize(("primitive", "unsure"), [
    ("scan", True), ("home", True), ("auto_range", True), ("unheard_of", True), ("measure", False), ("verify", False),
    ("move", False), ("stow", False), ("park", False),
])  # fmt: skip
def test_what_a_device_does_to_a_source_or_shutter_and_nobody_can_tell_lets_light_out(
    part: str, primitive: str, unsure: bool
) -> None:
    op = Operation(id="op1", primitive=primitive, component=part, reason=Reason(kind="asked"),
                   arguments={"tunable": "shutter", "to": {"pose": {"x": 1, "y": 1, "yaw": 0}}})  # fmt: skip
    assert lets_out(SETUP, op) is (unsure and part in ("laser", "gate"))


def test_a_shutter_without_a_tunable_of_that_name_has_nothing_to_open() -> None:
    fixed = with_type(SETUP, "gate", tunables={})
    op = Operation(id="op1", primitive="unheard_of", component="gate", reason=Reason(kind="asked"))
    assert lets_out(SETUP, op) and not lets_out(fixed, op)
    assert not uncovers(fixed, carry("gate", 300, 600)) and uncovers(SETUP, carry("gate", 300, 600))


@pytest.mark.parametrize("primitive", ["optimize", "teleoperate", "survey"])
@pytest.mark.parametrize(("address", "lets"), [
    ("laser.power", True), ("laser.shutter", True), ("gate.shutter", True), ("bare.emission", True),
    ("cam.exposure", False), ("holder.x", False), ("stranger.power", False),
])  # fmt: skip
@pytest.mark.parametrize("bounds", [(0.1, 0.2), None])
def test_a_search_lets_light_out_where_it_sets_a_source_or_a_shutter(
    primitive: str, address: str, lets: bool, bounds: Any
) -> None:
    assert lets_out(SETUP, search({address: bounds}, primitive)) is lets
    assert lets_out(SETUP, search({"cam.exposure": (1, 2)}, primitive, first=[{address: bounds}])) is lets
    assert lets_out(SETUP, search({"cam.exposure": (1, 2), address: bounds}, primitive)) is lets


BY_HAND = Operation(id="h", primitive="operator", component="gate", reason=Reason(kind="operator"),
                    arguments={"text": "lift it out", "to": {"pose": {"x": 9, "y": 9, "yaw": 0}}})  # fmt: skip


@pytest.mark.parametrize(("op", "does"), [
    (carry("gate", 300, 600), True), (carry("holder", 300, 600), False), (carry("laser", 1, 1), False),
    (BY_HAND, True), (set_to("gate", "shutter", "closed"), False), (set_to("gate", "shutter", "open"), False),
    (set_to("gate", "shutter", "closed", primitive="operator"), False),
    (Operation(id="h", primitive="operator", component="gate", arguments={"text": "wipe"}, reason=Reason(kind="asked")),
     False),
    (Operation(id="m", primitive="move", component="stranger", reason=Reason(kind="asked")), False),
    (Operation(id="s", primitive="stow", component="gate", reason=Reason(kind="asked")), True),
    (Operation(id="p", primitive="park", component="gate", reason=Reason(kind="asked")), False),
])  # fmt: skip
def test_moving_a_shutter_uncovers_what_it_closes(op: Operation, does: bool) -> None:
    assert uncovers(SETUP, op) is does


# which laser may shine


@pytest.mark.parametrize(("emission", "shutter", "presence"), list(itertools.product(
    (True, False, None), ("open", "closed", None), ("seen", "missing", "toppled", "held", "absent")
)))  # fmt: skip
def test_a_laser_is_dark_only_if_it_is_gone_or_read_back_off_or_closed(
    emission: Any, shutter: Any, presence: str
) -> None:
    seen = observed()
    parts = dict(seen.components)
    if presence == "absent":
        del parts["laser"]
    else:
        parts["laser"] = replace(parts["laser"], presence=presence)  # type: ignore[arg-type]
    seen = Observation(backend="sim", components=parts)
    values = {k: v for k, v in {"emission": emission, "shutter": shutter}.items() if v is not None}
    there = presence not in ("missing", "absent")
    assert may_shine(SETUP, seen, "laser", values) is (there and emission is not False and shutter != "closed")


# of which class


@pytest.mark.parametrize("before", [0.0, 0.3, 0.9, 4.0, STRONGEST])
@pytest.mark.parametrize("to", [0.0, 0.3, 0.9, 4.0, STRONGEST])
def test_a_power_counts_as_the_greater_of_before_and_after(before: float, to: float) -> None:
    seen = observed(laser={**LIT, "power": before})
    found = let_out(SETUP, seen, [set_to("laser", "power", to)])
    assert found == ({"laser": at(max(before, to))} if to > 0 else {})


@pytest.mark.parametrize("emission", [True, False, UNKNOWN, None])
@pytest.mark.parametrize("shutter", ["open", "closed", UNKNOWN, commanded("closed"), None])
@pytest.mark.parametrize("change", ["open", "emit", "power"])
def test_a_laser_is_let_out_where_nothing_is_known_to_keep_it_dark(emission: Any, shutter: Any, change: str) -> None:
    op = {"open": set_to("laser", "shutter", "open"), "emit": set_to("laser", "emission", True),
          "power": set_to("laser", "power", 4.0)}[change]  # fmt: skip
    seen = observed(laser={"emission": emission, "shutter": shutter, "power": 2.0})
    off = emission is False and change != "emit"
    shut = shutter == "closed" and change != "open"
    assert let_out(SETUP, seen, [op]) == ({} if off or shut else {"laser": "3R"})


def test_all_that_operations_do_together_counts_whatever_their_order() -> None:
    ops = [set_to("laser", "emission", True, "a"), set_to("laser", "shutter", "open", "b"),
           set_to("laser", "power", 50.0, "c"), set_to("laser", "power", 0.2, "d"),
           set_to("laser", "shutter", "closed", "e"), set_to("laser", "emission", False, "f")]  # fmt: skip
    seen = observed(laser={"emission": False, "power": 0.2})
    for order in (ops, ops[::-1], [*ops[3:], *ops[:3]]):
        assert let_out(SETUP, seen, order) == {"laser": "3B"}
    assert let_out(SETUP, seen, ops[3:]) == {} == let_out(SETUP, seen, [ops[4], ops[5]])


def test_what_is_raised_before_it_is_shut_was_let_out() -> None:
    seen = observed(laser={**LIT, "power": 0.3})
    for dark in (set_to("laser", "shutter", "closed", "b"), set_to("laser", "emission", False, "b")):
        assert let_out(SETUP, seen, [set_to("laser", "power", 4.0, "a"), dark]) == {"laser": "3R"}


def test_only_the_laser_that_is_touched_is_let_out_by_its_own_shutter() -> None:
    seen = observed(second={**LIT, "power": 50.0}, bare={"emission": True})
    assert let_out(SETUP, seen, [set_to("laser", "shutter", "open")]) == {"laser": "1"}
    assert let_out(SETUP, seen, [set_to("cam", "exposure", 5)]) == {}


def test_a_shutter_on_the_table_lets_out_whatever_may_shine() -> None:
    seen = observed(laser={"shutter": "open", "power": 0.8}, second={"power": 50.0}, bare={"emission": UNKNOWN})
    assert let_out(SETUP, seen, [set_to("gate", "shutter", "open")]) == {"laser": "2", "bare": "3R"}
    assert let_out(SETUP, seen, [carry("gate", 300, 600)]) == {"laser": "2", "bare": "3R"}
    assert let_out(SETUP, seen, [search({"gate.shutter": None})]) == {"laser": "2", "bare": "3R"}
    assert let_out(SETUP, seen, [BY_HAND]) == {"laser": "2", "bare": "3R"}


@pytest.mark.parametrize("order", [1, -1])
def test_a_shutter_on_the_table_lets_out_others_than_the_laser_that_is_set_beside_it(order: int) -> None:
    seen = observed(laser={"shutter": "open", "power": 0.8}, second={**LIT, "power": 50.0}, without=("bare",))
    both = [set_to("laser", "power", 0.9, "p"), set_to("gate", "shutter", "open", "g")][::order]
    assert let_out(SETUP, seen, both) == {"laser": "2", "second": "3B"}
    one = search({"laser.power": (0.1, 0.9), "gate.shutter": None})
    assert let_out(SETUP, seen, [one]) == {"laser": "2", "second": "3B"}


def test_a_laser_that_is_shut_while_a_shutter_is_carried_stays_dark_only_if_nothing_opens_it() -> None:
    seen = observed(laser={"shutter": "open", "power": 50.0})
    close = set_to("laser", "shutter", "closed", "c")
    moved = carry("gate", 300, 600, after=("c",))
    assert let_out(SETUP, seen, [close, moved]) == {}
    assert let_out(SETUP, seen, [set_to("laser", "emission", False, "c"), moved]) == {}
    assert let_out(SETUP, seen, [moved]) == {"laser": "3B"}
    assert let_out(SETUP, seen, [set_to("cam", "shutter", "closed", "c"), moved]) == {"laser": "3B"}
    assert let_out(SETUP, seen, [close, moved, set_to("laser", "shutter", "open", "o")]) == {"laser": "3B"}
    assert let_out(SETUP, seen, [set_to("laser", "shutter", "closed", "c", primitive="operator"), moved]) == {
        "laser": "3B"
    }, "what a person is asked for is not done yet"
    unread = observed(laser={"shutter": "open", "power": 50.0}, without=("second",))
    assert let_out(SETUP, unread, [close, moved]) == {}


@pytest.mark.parametrize(("bounds", "of"), [((0.1, 0.3), "1"), ((0.1, 0.9), "2"), ((0.1, 4.0), "3R"),
                                            ((4.0, 0.1), "3R"), ((1.0, 99.0), "3B"), (None, "4")])  # fmt: skip
@pytest.mark.parametrize("primitive", ["optimize", "teleoperate", "survey"])
def test_a_search_counts_as_the_most_that_it_may_set(bounds: Any, of: str, primitive: str) -> None:
    seen = observed(laser={**LIT, "power": 0.05})
    assert let_out(SETUP, seen, [search({"laser.power": bounds}, primitive)]) == {"laser": of}
    other = [search({"cam.exposure": (1, 2)}, primitive, first=[{"laser.power": bounds}])]
    assert let_out(SETUP, seen, other) == {"laser": of}
    assert let_out(SETUP, observed(laser={**LIT, "power": 400.0}), other) == {"laser": of if of == "4" else "3B"}


@pytest.mark.parametrize("primitive", ["scan", "home", "unheard_of"])
def test_what_ends_nobody_knows_where_counts_as_the_top_of_its_range(primitive: str) -> None:
    seen = observed(laser={**LIT, "power": 0.05})
    op = Operation(id="op1", primitive=primitive, component="laser", arguments={"tunable": "power"},
                   reason=Reason(kind="asked"))  # fmt: skip
    assert let_out(SETUP, seen, [op]) == {"laser": at(STRONGEST)}
    said = replace(op, arguments={"tunable": "power", "to": 0.1})
    assert let_out(SETUP, seen, [said]) == {"laser": at(STRONGEST)}, "whatever it says of where it ends"
    bare = replace(op, arguments={})
    assert let_out(SETUP, observed(laser={**LIT, "power": 4.0}), [bare]) == {"laser": "3R"}
    shut = observed(laser={"shutter": "closed", "power": 4.0})
    op = Operation(id="op1", primitive=primitive, component="laser", arguments={"tunable": "shutter"},
                   reason=Reason(kind="asked"))  # fmt: skip
    assert let_out(SETUP, shut, [op]) == {"laser": "3R"}


@pytest.mark.parametrize("unread", [UNKNOWN, None, commanded(0.2)])
def test_a_power_that_was_not_read_back_counts_as_the_highest_that_it_may_have(unread: Any) -> None:
    seen = observed(laser={**LIT, "shutter": "closed", "power": unread})
    assert let_out(SETUP, seen, [set_to("laser", "shutter", "open")]) == {"laser": at(STRONGEST)}


# by whose leave


def licence(of: str, **more: Any) -> dict[str, Licence]:
    return {"laser": Licence(laser_class=of, **more)}  # type: ignore[arg-type]


@pytest.mark.parametrize("of", CLASSES)
@pytest.mark.parametrize("held", [None, *CLASSES])
@pytest.mark.parametrize("whose", ["laser", "second"])
def test_above_class_2_a_laser_needs_a_licence_of_its_own_for_its_class(of: Any, held: Any, whose: str) -> None:
    given = {whose: Licence(laser_class=held)} if held else None
    enough = whose == "laser" and held is not None and CLASSES.index(of) <= CLASSES.index(held)
    may = of in ("1", "2") or enough
    assert licensed(observed(given), "laser", of) is may
    power = {"1": 0.3, "2": 0.9, "3R": 4.0, "3B": 99.0, "4": 900.0}[of]
    opening, seen = [set_to("laser", "shutter", "open")], observed(given, laser={"power": power})
    refused = emission.refused(SETUP, seen, opening)
    assert emission.unlicensed(SETUP, seen, opening) == ({} if may else {"laser": of})
    assert [(d.severity, d.code, d.address) for d in refused] == ([] if may else [("error", "unarmed", "laser")])
    if not may:
        assert f"laser (class {of}) stays shut: " in refused[0].summary and "laser arm laser" in refused[0].hint


def test_why_a_laser_stays_shut_is_told_by_what_it_lacks() -> None:
    assert emission.why_not(observed(), "laser", "3B") == "nobody has armed it"
    by = observed(licence("3R", by="Ada"))
    assert emission.why_not(by, "laser", "3B") == "Ada armed it for class 3R only"
    assert emission.why_not(observed(licence("3R")), "laser", "3B") == "it is no more than 3R"
    withheld = observed(licence("2", by="Ada", withheld="the bench is not commissioned"))
    assert emission.why_not(withheld, "laser", "3R") == "the bench is not commissioned"


def test_a_shutter_that_alone_closes_an_unlicensed_laser_is_not_moved_away() -> None:
    seen = observed(laser={"shutter": "open", "power": 4.0}, gate={"shutter": "closed"})
    opening = set_to("laser", "power", 4.0)
    assert [d.address for d in emission.uncovered(SETUP, seen, [carry("gate", 300, 600)])] == ["laser"]
    assert emission.uncovered(SETUP, seen, [opening]) == []
    assert len(emission.uncovered(SETUP, seen, [opening, carry("gate", 300, 600, "m2")])) == 1
    armed = observed(licence("3R"), laser={"shutter": "open", "power": 4.0})
    assert emission.uncovered(SETUP, armed, [carry("gate", 300, 600)]) == []


@pytest.mark.parametrize("of", CLASSES)
@pytest.mark.parametrize("most", CLASSES)
@pytest.mark.parametrize("given", [None, "waiver", "there", "unattended"])
def test_where_nobody_is_there_a_laser_emits_up_to_the_stated_class_by_an_arming_given_for_that(
    of: Any, most: Any, given: str | None
) -> None:
    licences = {
        None: None, "waiver": licence("4"), "there": licence("4", by="Ada"),
        "unattended": licence("4", by="Ada", unattended=True),
    }[given]  # fmt: skip
    may = CLASSES.index(of) <= CLASSES.index(most) and given != "there"
    assert (emission.emits_alone(observed(licences), "laser", of, most) == []) is may
    power = {"1": 0.3, "2": 0.9, "3R": 4.0, "3B": 99.0, "4": 900.0}[of]
    seen = observed(licences, laser={"power": power})
    found = emission.above(SETUP, seen, [set_to("laser", "shutter", "open")], most)
    assert [(d.severity, d.code, d.address) for d in found] == ([] if may else [("error", "unattended", "laser")])
    assert emission.above(SETUP, seen, [set_to("cam", "exposure", 3)], most) == []
    if found:
        beyond = CLASSES.index(of) > CLASSES.index(most)
        assert (f"states {most} at the most" in found[0].summary) is beyond


def test_a_plan_warns_of_each_laser_that_it_leaves_shut() -> None:
    found = emission.left_shut(observed(), {"second": "3B", "laser": "3R"})
    assert [(d.severity, d.code, d.address) for d in found] == [
        ("warning", "unarmed", "laser"), ("warning", "unarmed", "second")
    ]  # fmt: skip
    assert found[0].summary == "laser (class 3R) stays dark: nobody has armed it" and "arm laser" in found[0].hint
