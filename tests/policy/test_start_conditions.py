"""What must hold before a plan starts, case by case: it is of this lab, bench and fidelity, allowed, and not stale."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest
from judged import require, require_applicable, require_current
from laser_lab import POSES, STRONGEST, UNKNOWN, bench, carry, commanded, observed, set_to, with_type

from pico.backends.device import Capabilities
from pico.diagnostics import Diagnostic, ExitCode, PicoError
from pico.model.arming import Licence
from pico.model.lab import Part, PolicyRule
from pico.model.observation import (
    Observation,
    ObservedComponent,
    ObservedRobot,
    ObservedValue,
    Uncertainty,
    live_state,
)
from pico.model.operation import Operation, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.state import Expectation
from pico.optics.audit.findings import Audit, Finding
from pico.policy import audit
from pico.policy.audit import Lit
from pico.policy.capability import require_able
from pico.policy.freshness import changes_since, edited

SETUP = bench()


def plan(
    *operations: Operation, base: Observation | None = None, setup: Setup = SETUP, diagnostics: Any = (), **target: Any
) -> Plan:  # fmt: skip
    was = live_state(setup, base or observed())
    return Plan(lab=LabRef(name="minimal", digest=setup.digest()), backend="sim", fidelity="kinematic",
                base=Base(state=was.as_json()), target=Target(**target), operations=operations,
                diagnostics=diagnostics)  # fmt: skip


def able(**changes: Any) -> Capabilities:
    usual: dict[str, Any] = {
        "name": "sim", "fidelity": "kinematic", "evidence": "kinematic", "lab_digest": SETUP.digest(),
        "primitives": frozenset({"move", "set", "measure"}), "robots": ("arm1",),
        "measurables": frozenset({"cam.image"}),
    }  # fmt: skip
    return Capabilities(**(usual | changes))


def refused(check: Any, *given: Any) -> tuple[int, list[str]]:
    with pytest.raises(PicoError) as caught:
        check(*given)
    return int(caught.value.exit_code), [d.code for d in caught.value.diagnostics]


def require_fresh(setup: Setup, made: Plan, seen: Observation) -> None:
    if changed := changes_since(setup, made, seen):
        raise PicoError(changed, ExitCode.STALE)


def require_allowed(setup: Setup, made: Plan, seen: Observation) -> None:
    for judge in ("expectations", "licenses", "beams", "rules"):
        require(judge, setup, made, seen)


# whether it can be executed here


@pytest.mark.parametrize("severity", ["error", "warning", "note"])
@pytest.mark.parametrize("code", ["beam-audit", "range"])
@pytest.mark.parametrize("lab", [True, False])
def test_a_plan_with_errors_or_of_another_lab_is_not_executed(severity: Any, code: str, lab: bool) -> None:
    made = plan(
        set_to("cam", "exposure", 3), diagnostics=(Diagnostic("note", "n", "x"), Diagnostic(severity, code, "y"))
    )
    here = able() if lab else able(lab_digest="other")
    if severity == "error":
        exit_code, codes = refused(require_applicable, SETUP, made, here)
        assert codes == [code] and exit_code == (ExitCode.DENIED if code == "beam-audit" else ExitCode.IMPOSSIBLE)
    elif not lab:
        assert refused(require_applicable, SETUP, made, here) == (ExitCode.STALE, ["stale"])
    else:
        require_applicable(SETUP, made, here)


@pytest.mark.parametrize("name", ["sim", "hardware"])
@pytest.mark.parametrize("fidelity", ["kinematic", "physics"])
@pytest.mark.parametrize("primitives", [True, False])
@pytest.mark.parametrize("robots", [True, False])
@pytest.mark.parametrize("measured", [True, False])
def test_a_plan_is_executed_by_the_bench_that_it_was_made_for_with_all_that_it_needs(
    name: str, fidelity: str, primitives: bool, robots: bool, measured: bool
) -> None:
    look = Operation(id="l", primitive="measure", component="cam", arguments={"measurable": "image"},
                     reason=Reason(kind="asked"))  # fmt: skip
    made = plan(carry("holder", 700, 300), carry("holder", 700, 500, "m2"), set_to("cam", "exposure", 3, "s"), look)
    here = able(name=name, fidelity=fidelity, primitives=frozenset({"move", "set", "measure"} if primitives else
                {"move", "measure"}), robots=("arm1",) if robots else ("arm2",),
                measurables=frozenset({"cam.image"} if measured else {"cam.dark"}))  # fmt: skip
    wanted = ["backend"] if name != "sim" else ["fidelity"] if fidelity != "kinematic" else []
    wanted += ([] if primitives else ["capability"]) + ([] if measured else ["unmeasured"])
    wanted += [] if robots else ["capability"]
    if wanted:
        assert refused(require_able, made, here) == (ExitCode.ERROR, wanted)
        assert refused(require_applicable, SETUP, made, here) == (ExitCode.ERROR, wanted)
    else:
        require_applicable(SETUP, made, here)


def test_what_kernels_make_of_a_picture_needs_the_picture() -> None:
    look = Operation(id="l", primitive="measure", component="cam", arguments={"measurable": "image | centroid"},
                     reason=Reason(kind="asked"))  # fmt: skip
    require_able(plan(look), able())
    with pytest.raises(PicoError, match=": sim has nothing that measures it") as caught:
        require_able(plan(look), able(measurables=frozenset({"cam.dark", "laser.monitor"})))
    assert caught.value.diagnostics[0].hint == "of cam it measures: dark"
    with pytest.raises(PicoError, match="has nothing that measures it") as caught:
        require_able(plan(look), able(measurables=frozenset()))
    assert caught.value.diagnostics[0].hint == ""


def test_a_step_by_hand_is_refused_by_a_bench_that_asks_no_person() -> None:
    moved = {"from": {"pose": as_json(POSES["holder"])}, "to": {"pose": as_json(Pose(510, 415, 30))}}
    by_hand = Operation(
        id="h", primitive="operator", component="holder", arguments=moved, reason=Reason(kind="operator")
    )
    with pytest.raises(PicoError, match="only a person can move holder") as caught:
        require_able(plan(by_hand), able(simulated=False))
    assert (
        "do it by hand" in caught.value.diagnostics[0].hint and "--exclude holder" in caught.value.diagnostics[0].hint
    )
    words = replace(by_hand, arguments={"text": "screw it down"})
    with pytest.raises(PicoError, match="holder needs a person: screw it down") as caught:
        require_able(plan(words), able(simulated=False))
    assert caught.value.diagnostics[0].code == "operator"
    require_able(plan(by_hand), able(primitives=frozenset({"operator"})))


# whether it is allowed


OPEN = set_to("laser", "shutter", "open")


@pytest.mark.parametrize("licence", [None, "3R"])
@pytest.mark.parametrize("safe", [True, False])
@pytest.mark.parametrize("rule", ["", "true", "false"])
@pytest.mark.parametrize("expects", ["", "cam.exposure > 0", "cam.exposur > 0"])
@pytest.mark.parametrize("only", [None, ("laser",)])
def test_licence_audit_rules_and_expectations_each_deny_a_plan(
    licence: Any, safe: bool, rule: str, expects: str, only: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def audit_of(*_: Any) -> tuple[Audit, Lit]:
        found = Finding(kind="end", source="laser", laser_class="3R", way=(), where="x", power=4.0, limit=0.39)
        return Audit(findings=() if safe else (found,), lasers={}), Lit({}, {}, ("laser",), frozenset({"laser"}))

    monkeypatch.setattr(audit, "audit_of", audit_of)
    setup = bench(rules=(PolicyRule(name="r", that=rule),) if rule else ())
    expect = (Expectation(that=expects),) if expects else None
    made = plan(OPEN, setup=setup, expect=expect, only=only)
    seen = observed({"laser": Licence(laser_class=licence, by="Ada")} if licence else None, laser={"power": 4.0})
    senseless = expects == "cam.exposur > 0" and not only
    why = ("expression" if senseless else "unarmed" if licence is None else "beam-audit" if not safe
           else "denied" if rule == "false" else None)  # fmt: skip
    if why is None:
        require_allowed(setup, made, seen)
    else:
        exit_code, codes = refused(require_allowed, setup, made, seen)
        assert codes == [why] and (why == "expression" or exit_code == ExitCode.DENIED)


def test_the_strongest_laser_of_the_bench_is_let_out_by_nobody() -> None:
    with pytest.raises(PicoError, match="laser \\(class 3B\\) stays shut"):
        require_allowed(SETUP, plan(OPEN), observed(laser={"power": STRONGEST}))


# whether the bench is as it assumes


def off(dx: float = 0.0, dyaw: float = 0.0, name: str = "holder", **more: Any) -> Observation:
    at = POSES[name]
    part = ObservedComponent(pose=Pose(at.x + dx, at.y, at.yaw + dyaw), **more)
    seen = observed()
    return replace(seen, components={**seen.components, name: part})


@pytest.mark.parametrize("dx", [0.0, 0.5, -0.5, 0.75, -0.75, 40.0])
@pytest.mark.parametrize("dyaw", [0.0, 0.5, -0.5, 0.75, -0.75, 180.0])
@pytest.mark.parametrize("carried", [True, False])
def test_a_part_stands_where_the_plan_assumes_within_its_tolerance(dx: float, dyaw: float, carried: bool) -> None:
    seen = replace(off(dx, dyaw), robots={"arm1": ObservedRobot(joints=())})
    made = plan(*([carry("holder", 700, 300)] if carried else [set_to("cam", "exposure", 3)]))
    if abs(dx) <= 0.5 and abs(dyaw) <= 0.5:
        require_current(SETUP, made, seen)
        require_fresh(SETUP, made, seen)
    else:
        assert refused(require_current, SETUP, made, seen) == (ExitCode.STALE, ["stale"])
        assert refused(require_fresh, SETUP, made, seen) == (ExitCode.STALE, ["stale"])
    there = plan(*made.operations, base=seen)  # a plan that says that it stood there then
    require_fresh(SETUP, there, seen)
    if carried and (abs(dx) > 0.5 or abs(dyaw) > 0.5):
        with pytest.raises(PicoError, match=r"holder was moved by") as caught:
            require_current(SETUP, there, seen)
        assert caught.value.exit_code == ExitCode.STALE
    else:
        require_current(SETUP, there, seen)


@pytest.mark.parametrize("presence", ["seen", "missing", "held", "toppled", "absent"])
def test_a_part_of_the_plan_must_be_seen(presence: Any) -> None:
    seen = observed()
    parts = {n: c for n, c in seen.components.items() if n != "holder"}
    if presence != "absent":
        parts["holder"] = replace(seen.components["holder"], presence=presence)
    now, made = replace(seen, components=parts), plan(set_to("cam", "exposure", 3))
    if presence == "seen":
        require_fresh(SETUP, made, now)
        return
    with pytest.raises(PicoError) as caught:
        require_fresh(SETUP, made, now)
    what = "missing" if presence == "absent" else presence
    assert caught.value.diagnostics[0].summary == f"the plan is stale: holder is {what} now"
    without = plan(set_to("cam", "exposure", 3), base=replace(seen, components={
        n: c for n, c in seen.components.items() if n != "holder"}))  # fmt: skip
    require_fresh(SETUP, without, now)
    with pytest.raises(PicoError, match="holder was not seen then and is now"):
        require_fresh(SETUP, without, seen)


@pytest.mark.parametrize("holding", [None, "holder", "cam"])
@pytest.mark.parametrize("held", [True, False])
@pytest.mark.parametrize("robot", [True, False])
def test_a_hand_holds_what_the_plan_assumes(holding: Any, held: bool, robot: bool) -> None:
    op = carry("holder", 700, 300)
    op = replace(op, arguments={**op.arguments, "from": {**op.arguments["from"], **({"held": True} if held else {})}})
    seen = observed()
    seen = replace(seen, robots={"arm1": ObservedRobot(joints=(), holding=holding)} if robot else {})
    if held == (robot and holding == "holder"):
        require_current(SETUP, plan(op), seen)
    else:
        with pytest.raises(PicoError, match=f"arm1 holds {(robot and holding) or 'nothing'}"):
            require_current(SETUP, plan(op), seen)
        away = replace(op, arguments={**op.arguments, "from": {**op.arguments["from"], "pose": as_json(Pose(1, 2, 3))}})
        with pytest.raises(PicoError) as caught:
            require_current(SETUP, plan(away), seen)
        assert len(caught.value.diagnostics) == 1, "where it was is nothing to compare then"


def test_only_the_first_pick_of_a_part_is_looked_at_and_parts_by_hand_not() -> None:
    seen = replace(observed(), robots={"arm1": ObservedRobot(joints=())})
    again = carry("holder", 700, 300, "m2")
    again = replace(again, arguments={**again.arguments, "from": {"pose": {"x": 1.0, "y": 2.0, "yaw": 3.0}}})
    require_current(SETUP, plan(carry("holder", 600, 300), again), seen)
    by_hand = replace(again, primitive="operator")
    require_current(SETUP, plan(by_hand), seen)
    for lost in (replace(again, component="stranger"), again):
        with pytest.raises(PicoError):
            require_current(SETUP, plan(lost), seen)
    nowhere = replace(seen, components={**seen.components, "stranger": ObservedComponent(pose=Pose(1, 2, 3))})
    with pytest.raises(PicoError, match="stranger is not on the table"):
        require_current(SETUP, plan(replace(again, component="stranger")), nowhere)


@pytest.mark.parametrize(("was", "now", "stale"), [
    (3.0, 3.0, False), (3.0, 3.25, False), (3.0, 3.5, False), (3.0, 3.75, True), (3.0, 2.5, False), (3.0, 2.25, True),
    (3.0, UNKNOWN, True), (3.0, None, False), (3.0, commanded(3.0), False),
])  # fmt: skip
def test_a_value_is_as_the_plan_assumes_within_its_tolerance(was: float, now: Any, stale: bool) -> None:
    kinds = SETUP.type_of("cam").tunables
    setup = with_type(SETUP, "cam", tunables={**kinds, "exposure": replace(kinds["exposure"], tolerance=0.5)})
    made = plan(set_to("cam", "exposure", 3), base=observed(cam={"exposure": was}), setup=setup)
    seen = observed(cam={"exposure": now})
    if stale:
        with pytest.raises(PicoError, match=r"cam\.exposure changed") as caught:
            require_fresh(setup, made, seen)
        assert caught.value.diagnostics[0].address == "cam.exposure"
    else:
        require_fresh(setup, made, seen)


@pytest.mark.parametrize("light", [{"shutter": "open"}, {"emission": False}, {"power": 4.0}, {"emission": UNKNOWN}])
def test_a_plan_that_was_judged_under_other_light_is_stale(light: Any) -> None:
    made = plan(set_to("cam", "exposure", 3))
    assert refused(require_fresh, SETUP, made, observed(laser=light)) == (ExitCode.STALE, ["stale"])


def test_how_far_a_part_was_moved_is_told_in_both_directions() -> None:
    at = POSES["holder"]
    seen = observed()
    part = ObservedComponent(pose=Pose(at.x + 3.0, at.y - 4.0, 350.0))
    seen = replace(seen, components={**seen.components, "holder": part})
    with pytest.raises(PicoError, match=r"holder changed by 5 mm, 10°, tolerance 0\.5 mm, 0\.5°: \(503, 416, 350°\)"):
        require_fresh(SETUP, plan(), seen)


def test_what_comes_with_a_part_is_not_told_beside_it() -> None:
    more = {**SETUP.lab.inventory, "block": Part(type="beam_block", home="storage/a1")}
    catalog = {**SETUP.catalog, "beam_block": replace(SETUP.type_of("holder"), name="beam_block")}
    other = Setup(lab=replace(SETUP.lab, inventory=more), catalog=catalog)
    assert edited(SETUP, other) == ["inventory.block added"] and edited(other, SETUP) == ["inventory.block removed"]


def test_a_value_of_a_part_that_was_seen_badly_counts_all_the_same() -> None:
    home = SETUP.lab.slots["storage/a1"].pose
    seen = observed(cam={"exposure": 3.0})
    badly = replace(seen.components["cam"], pose=home, uncertainty=Uncertainty(position=5.0, yaw=5.0))
    seen = replace(seen, components={**seen.components, "cam": badly})
    made = plan(set_to("cam", "exposure", 3), base=seen)
    require_fresh(SETUP, made, seen)
    brighter = replace(badly, values={"exposure": ObservedValue(value=9.0)})
    now = replace(seen, components={**seen.components, "cam": brighter})
    with pytest.raises(PicoError, match=r"cam\.exposure changed"):
        require_fresh(SETUP, made, now)


def test_a_plan_of_another_lab_is_stale_and_what_was_edited_is_told() -> None:
    other = bench(open_beam=True)
    assert refused(require_fresh, other, plan(), observed()) == (ExitCode.STALE, ["stale"])
    assert edited(SETUP, other) == ["policy.open_beam false → true"]


@pytest.mark.parametrize(("x", "sigma", "stale"), [
    (0.0, 5.0, False), (4.0, 5.0, False), (4.0, 0.1, True), (60.0, 5.0, True), (130.0, 5.0, True)
])  # fmt: skip
@pytest.mark.parametrize("named", ["slot", "pose"])
def test_a_part_that_was_seen_badly_is_still_in_the_slot_that_it_was_in(
    x: float, sigma: float, stale: bool, named: str
) -> None:
    home = SETUP.lab.slots["storage/a1"].pose
    at: Mapping[str, Any] = {"slot": "storage/a1"} if named == "slot" else {"pose": as_json(home)}
    base = replace(observed(), components={n: c for n, c in observed().components.items() if n != "holder"})
    made = plan(set_to("cam", "exposure", 3), base=base)
    made = replace(made, base=Base(state={**made.base.state, "holder": dict(at)}))
    part = ObservedComponent(pose=Pose(home.x + x, home.y, home.yaw), uncertainty=Uncertainty(position=sigma, yaw=5.0))
    if sigma < 1:
        part = replace(part, uncertainty=Uncertainty(position=sigma, yaw=0.1))
    seen = observed()
    seen = replace(seen, components={**seen.components, "holder": part})
    stale = stale and not (named == "slot" and x == 4.0)
    if stale:
        assert refused(require_fresh, SETUP, made, seen) == (ExitCode.STALE, ["stale"])
    else:
        require_fresh(SETUP, made, seen)


def test_a_plan_whose_light_the_guard_ended_says_that_first() -> None:
    said = Diagnostic(
        "warning", "guard", "guard: light of laser was ended at 14:02:03 because estop is not safe", hint="x"
    )
    lit = observed(laser={"emission": True, "shutter": "open"})
    made = plan(base=lit)
    dark = replace(observed(laser={"emission": False, "shutter": "closed"}), problems=(said,))
    with pytest.raises(PicoError) as caught:
        require_current(SETUP, made, dark)
    first, *rest = caught.value.diagnostics
    assert (first.summary, first.severity, first.hint) == (said.summary, "error", "x")
    assert {one.code for one in rest} == {"stale"} and caught.value.exit_code == ExitCode.STALE
    assert refused(require_current, SETUP, made, replace(dark, problems=())) == (ExitCode.STALE, ["stale", "stale"])
    moved = replace(lit, problems=(said,), components={n: p for n, p in lit.components.items() if n != "holder"})
    assert refused(require_current, SETUP, made, moved) == (ExitCode.STALE, ["stale"]), "that is no matter of light"
