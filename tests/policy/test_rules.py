"""Rules of a lab: judged before anything moves; what does not hold, or can't be told, denies."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from judged import require, with_rules

from pico.diagnostics import ExitCode, PicoError
from pico.manifest.load import load_folder
from pico.model.lab import PolicyRule
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.operation import Operation, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.setup import Setup
from pico.model.state import home_state, place_of
from pico.policy.beams import open_beams
from pico.resources import labs_dir

WHY = Reason(kind="changed")
AWAY = {"pose": {"x": 520, "y": 420, "yaw": 0}}


def shel(*rules: PolicyRule) -> Setup:
    setup, _ = load_folder(labs_dir() / "shel").require()
    return replace(setup, lab=replace(setup.lab, policy=replace(setup.lab.policy, rules=rules)))


def seen(setup: Setup, person: bool | None = False, **values: ObservedValue) -> Observation:
    """Everything at home, the laser on and its shutter open, unless `values` say otherwise."""
    home = home_state(setup)
    laser = {"emission": ObservedValue(value=True), "shutter": ObservedValue(value="open"), **values}
    parts = {
        n: ObservedComponent(pose=place_of(setup, home, n)[1], values=laser if n == "laser" else {})
        for n in setup.lab.inventory
    }
    return Observation(backend="sim", components=parts, person=person)


def move(name: str = "p2", id: str = "m", after: tuple[str, ...] = ()) -> Operation:
    return Operation(
        id=id, primitive="move", component=name, arguments={"from": {}, "to": AWAY}, robot="arm1", reason=WHY,
        after=after,
    )  # fmt: skip


def shutter(to: str, id: str, after: tuple[str, ...] = ()) -> Operation:
    arguments: dict[str, Any] = {"tunable": "shutter", "from": None, "to": to}
    return Operation(id=id, primitive="set", component="laser", arguments=arguments, reason=WHY, after=after)


def emission(to: bool, id: str = "e") -> Operation:
    arguments: dict[str, Any] = {"tunable": "emission", "from": None, "to": to}
    return Operation(id=id, primitive="set", component="laser", arguments=arguments, reason=WHY)


def plan(setup: Setup, *operations: Operation) -> Plan:
    return Plan(
        lab=LabRef(name="shel", digest=setup.digest()), backend="sim", fidelity="kinematic", base=Base(),
        target=Target(state={"p1": {"slot": "storage/b1", "angle": 12}}), operations=operations,
    )  # fmt: skip


def verdict(that: str, *operations: Operation, person: bool | None = False, **values: ObservedValue) -> Any:
    setup = shel(PolicyRule(name="r", that=that))
    found = with_rules(setup, plan(setup, *(operations or (move(),))), seen(setup, person, **values))
    return found.policy[0]


@pytest.mark.parametrize("that", [
    "operations.all(o, o.mass < 1 && o.robot == 'arm1')",
    "components.laser.parameters.laser_class == '3R' && components.laser.parameters.power <= 2",
    "components[operations[0].component].moves",
    "laser.shutter == 'open' && components.laser.live.shutter == 'open'",
    "components.p1.desired.angle == 12 && lab.table.beam_height == 70",
    "lasers == ['laser'] && operations[0].open_beams == lasers",
    "distance(p1, p2) > 0 && inside(cam, 'beam_line') && plan.target.state.p1.angle == 12",
    "operations.all(o, components[o.component].keep_out == []) && backend == 'sim' && !lab.open_beam",
])  # fmt: skip
def test_rules_see_plan_bench_and_parts(that: str) -> None:
    assert verdict(that) == {"rule": "r", "level": "mandatory", "holds": True, "text": ""}


@pytest.mark.parametrize(("that", "said"), [
    ("components.p1.parameters.laser_class == '3R'", "there is no `laser_class` in it"),
    ("p1.angel > 1", "nothing is called `p1.angel`"),
    ("laser.shuter == 'open'", "did you mean `laser.shutter`?"),
    ("cam.peak > 1", "nobody measured cam.peak"),
])  # fmt: skip
def test_what_cannot_be_told_denies_and_says_why(that: str, said: str) -> None:
    found = verdict(that)
    assert not found["holds"]
    assert "can't be told" in found["text"]
    assert said in found["text"]


def test_a_shutter_that_was_not_read_back_denies() -> None:
    commanded = ObservedValue(value="closed", status="commanded")
    assert "never read back" in verdict("laser.shutter == 'closed'", shutter=commanded)["text"]


def test_somebody_at_the_table_is_seen_and_nobody_telling_denies() -> None:
    rule = "!human_present || operations.all(o, o.robot == '')"
    assert verdict(rule)["holds"]
    assert not verdict(rule, person=True)["holds"]
    assert "nothing tells whether somebody is at the table" in verdict(rule, person=None)["text"]


def test_only_a_mandatory_rule_keeps_a_plan_from_being_run() -> None:
    for level, denied in (("mandatory", True), ("advisory", False)):
        setup = shel(PolicyRule(name="light", that="operations.all(o, o.mass < 0.1)", level=level, message="too heavy"))
        found = with_rules(setup, plan(setup, move()), seen(setup))
        assert found.denied is denied
        assert found.digest == found.sealed().digest
        if denied:
            with pytest.raises(PicoError, match="light: too heavy") as caught:
                require("rules", setup, found, seen(setup))
            assert caught.value.exit_code == ExitCode.DENIED
        else:
            require("rules", setup, found, seen(setup))


def test_a_plan_that_does_nothing_needs_no_permission() -> None:
    setup = shel(PolicyRule(name="never", that="false"))
    assert with_rules(setup, plan(setup), seen(setup)).policy == ()


def test_a_zone_that_a_goal_would_stand_in_is_named() -> None:
    from pico.model.lab import Box2, KeepOut

    setup = shel(PolicyRule(name="r", that="operations.all(o, components[o.component].keep_out == ['vent'])"))
    there = Box2(x=(500, 540), y=(400, 440))
    zones = {"vent": KeepOut(area=there), "far": KeepOut(area=Box2(x=(0, 9), y=(0, 9)))}
    zones |= {"lamp": KeepOut(area=there, z=(300, 400))}
    setup = replace(setup, lab=replace(setup.lab, keep_out=zones))
    assert with_rules(setup, plan(setup, move()), seen(setup)).policy[0]["holds"]


@pytest.mark.parametrize(("operations", "values", "opened"), [
    ((move(),), {}, ["laser"]),
    ((move(),), {"shutter": ObservedValue(value="closed")}, []),
    ((move(),), {"shutter": ObservedValue(value="closed", status="commanded")}, ["laser"]),
    ((move(),), {"emission": ObservedValue(value=False)}, []),
    ((shutter("closed", "c"), move(after=("c",))), {}, []),
    ((shutter("closed", "c"), move()), {}, ["laser"]),
    ((shutter("closed", "c"), move(after=("c",)), shutter("open", "o", ("m",))), {}, []),
    ((shutter("closed", "c"), move(after=("c",)), shutter("open", "o", ("c",))), {}, ["laser"]),
    ((shutter("open", "o"), shutter("closed", "c", ("o",)), move(after=("c",))), {}, []),
    ((move(), shutter("open", "o")), {"shutter": ObservedValue(value="closed")}, ["laser"]),
    ((move(), emission(True)), {"emission": ObservedValue(value=False)}, ["laser"]),
    ((emission(False), move(after=("e",))), {"emission": ObservedValue(value=False)}, []),
    ((emission(False), move(after=("e",))), {}, ["laser"]),
    ((move(),), {"emission": ObservedValue(value=False, status="commanded")}, ["laser"]),
])  # fmt: skip
def test_a_beam_is_closed_only_where_the_order_of_the_plan_says_so(
    operations: tuple[Operation, ...], values: dict[str, ObservedValue], opened: list[str]
) -> None:
    setup = shel()
    assert open_beams(setup, operations, seen(setup, **values), ["laser"])["m"] == opened
