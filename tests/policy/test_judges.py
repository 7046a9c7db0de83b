"""The list of judges of a plan: a plan for each that it alone refuses, what a plan then says, and who else may ask."""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from laser_lab import bench, carry, observed, set_to

from pico.backends.device import Capabilities
from pico.diagnostics import Diagnostic, ExitCode, PicoError, warning
from pico.model.arming import Licence
from pico.model.goal import Claim, Goal
from pico.model.lab import PolicyRule
from pico.model.observation import Observation, live_state
from pico.model.operation import Operation
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.state import Expectation
from pico.model.trace.dose import Dose
from pico.model.wiring import DeviceEntry, Wired, Wiring
from pico.planning.alignment import Alignment
from pico.policy import audit
from pico.policy.audit import audit_key, judge, lit_by
from pico.policy.goals import GoalRecord
from pico.policy.judging.case import PlanCase
from pico.policy.judging.judges import JUDGES, judge_plan, judgment_of, require_permitted

SETUP = bench()
OPEN, ELSE = set_to("laser", "shutter", "open"), set_to("cam", "exposure", 3)
LICENSED = {"laser": Licence(laser_class="3R", by="Ada")}
DOSES = (Dose(sample="W1", component="holder", spent=9.0, power=0.0, budget=10.0),)


def case(
    *operations: Operation, setup: Setup = SETUP, seen: Observation | None = None, base: Observation | None = None,
    diagnostics: tuple[Diagnostic, ...] = (), target: Target | None = None, able: Any = None, backend: str = "sim",
    **more: Any,
) -> PlanCase:  # fmt: skip
    """Return a plan of operations on the bench as it is seen, before an edge that can do it."""
    seen = seen or observed(LICENSED)
    can: dict[str, Any] = {
        "name": backend, "fidelity": "kinematic", "evidence": "kinematic", "lab_digest": setup.digest(),
        "primitives": frozenset({"move", "set"}), "robots": ("arm1",),
    } | (able or {})  # fmt: skip
    plan = Plan(
        lab=LabRef(name="minimal", digest=setup.digest()), backend=backend, fidelity="kinematic",
        base=Base(state=live_state(setup, base or seen).as_json()), target=target or Target(),
        operations=operations or (ELSE,), diagnostics=diagnostics,
    )  # fmt: skip
    return PlanCase(setup, plan.sealed(), seen, Capabilities(**can), **more)


def sampled() -> Setup:
    part = replace(SETUP.lab.inventory["holder"], sample="W1", dose_budget=10.0)
    return replace(SETUP, lab=replace(SETUP.lab, inventory={**SETUP.lab.inventory, "holder": part}))


def wired() -> Setup:
    """The bench, whose exposure a device sets that goes to 2 ms."""
    entry = DeviceEntry(
        driver="scpi.number", of="cam", settings={"unit": "ms", "set": "EXP {value}"}, limits={"value": (0.0, 2.0)},
        map={"exposure": Wired(property="value")},
    )  # fmt: skip
    return replace(SETUP, wiring=Wiring(lab="minimal", devices={"timer": entry}))


def with_lab(**changes: Any) -> Setup:
    return replace(SETUP, lab=replace(SETUP.lab, **changes))


@dataclass
class Refused:
    """A plan that one judge alone refuses: the codes, the exit code, and whether the plan then says so itself."""

    case: Callable[[], PlanCase]
    code: str
    exit_code: ExitCode
    said: bool = False


LONG = replace(OPEN, seconds=5.0)
REFUSED = {
    "errors": Refused(lambda: case(diagnostics=(Diagnostic("error", "range", "x"),)), "range", ExitCode.IMPOSSIBLE),
    "lab": Refused(lambda: case(able={"lab_digest": "other"}), "stale", ExitCode.STALE),
    "capability": Refused(lambda: case(able={"primitives": frozenset({"move"})}), "capability", ExitCode.ERROR),
    "set-points": Refused(lambda: case(setup=wired(), backend="emulated"), "set-point", ExitCode.IMPOSSIBLE, said=True),
    "freshness": Refused(lambda: case(base=observed(cam={"exposure": 1.0}), seen=observed(cam={"exposure": 4.0})),
                         "stale", ExitCode.STALE),
    "expectations": Refused(lambda: case(target=Target(expect=(Expectation(that="cam.exposur > 0"),))),
                            "expression", ExitCode.ERROR, said=True),
    "licenses": Refused(lambda: case(OPEN, seen=observed(laser={"power": 4.0})), "unarmed", ExitCode.DENIED, said=True),
    "beams": Refused(lambda: case(OPEN, seen=observed(LICENSED, laser={"power": 4.0}, without=("cam",))),
                     "beam-audit", ExitCode.DENIED, said=True),
    "dose": Refused(lambda: case(LONG, setup=sampled(), seen=observed(LICENSED, laser={"power": 0.9}), doses=DOSES),
                    "dose", ExitCode.DENIED, said=True),
    "rules": Refused(lambda: case(setup=bench(rules=(PolicyRule(name="never", that="false"),))),
                     "denied", ExitCode.DENIED),
}  # fmt: skip
"""By judge. Not made from the list: one who is taken off it fails here."""


@pytest.mark.parametrize("name", REFUSED)
def test_a_plan_is_refused_by_the_one_judge_who_finds_fault_with_it(name: str) -> None:
    one = REFUSED[name]
    made = one.case()
    assert [j.name for j in JUDGES if j.judge(made).refusals] == [name]
    with pytest.raises(PicoError) as caught:
        require_permitted(made)
    assert {d.code for d in caught.value.diagnostics} == {one.code} and caught.value.exit_code == one.exit_code
    told = judge_plan(made)
    assert (told.errored and name != "errors") == one.said
    assert told.denied == (name == "rules") and told.digest == told.sealed().digest
    if one.said:  # what a client made of it, its edge refuses by its own word already
        with pytest.raises(PicoError) as again:
            require_permitted(replace(made, plan=told))
        assert again.value.diagnostics == caught.value.diagnostics


def test_a_plan_that_nobody_finds_fault_with_passes_and_stays_as_it_is() -> None:
    made = case(OPEN)
    require_permitted(made)
    assert judge_plan(made) is made.plan


@pytest.mark.parametrize("name", REFUSED)
def test_before_the_bench_is_taken_only_those_judge_who_need_not_see_it(name: str) -> None:
    made = replace(REFUSED[name].case(), present=None)
    if name in ("errors", "lab", "capability", "set-points"):
        with pytest.raises(PicoError):
            require_permitted(made)
    else:
        require_permitted(made)


def test_every_judge_that_can_refuse_has_a_plan_here() -> None:
    assert set(REFUSED) == {one.name for one in JUDGES if one.refuses}
    assert [one.name for one in JUDGES if not one.refuses] == ["claims", "goals"]


CLAIM = warning("claim", "the tolerances do not carry it", detail="they leave 2 %", hint="p1.angle to ± 0.1 deg")
CLAIMED = with_lab(claims={"c": Claim(of="cam.power", to="1 %")})
MOVED = carry("holder", 600, 300)


def test_claims_are_told_of_a_plan_to_a_state_of_a_lab_that_has_any(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = list[Any]()
    monkeypatch.setattr("pico.diagnosis.claims.uncarried", lambda *given: (asked.append(given), [("c", CLAIM)])[1])
    made = case(MOVED, setup=CLAIMED, target=Target(revision="e1"))
    assert judge_plan(made).diagnostics == (CLAIM,) and asked == [(CLAIMED, made.plan.target_state, "e1")]
    require_permitted(made)
    assert not judge_plan(case(MOVED, target=Target(revision="e1"))).diagnostics
    assert not judge_plan(case(ELSE, setup=CLAIMED, target=Target(cause="single"))).diagnostics
    assert not judge_plan(case(MOVED, setup=CLAIMED, target=Target(title="the bench before a run"))).diagnostics
    assert len(asked) == 1


def test_claims_that_are_known_are_not_reckoned_again_and_of_a_plan_that_does_nothing_only_these_are_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("pico.diagnosis.claims.uncarried", lambda *_: [("c", CLAIM)])
    known = dict[tuple[str, str], Any]()

    def recall(kind: str, key: str, read: Any, find: Any) -> Any:
        if (kind, key) in known:
            return read(known[kind, key])
        if find is not None:
            known[kind, key] = as_json(find())
        return find and find()

    made = case(MOVED, setup=CLAIMED, target=Target(revision="e1"), recall=recall)
    still = replace(made, plan=replace(made.plan, operations=()))
    other = replace(still, plan=replace(still.plan, target=Target(revision="e2")))
    assert not judge_plan(still).diagnostics
    assert judge_plan(made).diagnostics == (CLAIM,) and [kind for kind, _ in known] == ["claims"]
    assert judge_plan(made).diagnostics == judge_plan(still).diagnostics == (CLAIM,)
    assert not judge_plan(other).diagnostics


def test_of_the_light_of_a_plan_that_does_nothing_only_what_is_known_is_told() -> None:
    asked = list[tuple[str, bool]]()

    def recall(kind: str, key: str, read: Any, find: Any) -> Any:
        asked.append((kind, find is not None))
        return find and find()

    seen = observed(LICENSED, laser={"power": 4.0, "shutter": "open"}, without=("cam",))
    made = case(MOVED, seen=seen, recall=recall)
    assert made.light[0].findings and asked == [("audit", True)]
    still = replace(made, plan=replace(made.plan, operations=()))
    assert not still.light[0].findings and asked[1:] == [("audit", False)]


def test_verdicts_on_rules_stand_before_what_a_plan_keeps_of_its_own_policy() -> None:
    made = case(setup=bench(rules=(PolicyRule(name="r", that="true"),)))
    own, old = {"rule": "shutter", "text": "closed"}, {"rule": "r", "level": "mandatory", "holds": False}
    told = judge_plan(replace(made, plan=replace(made.plan, policy=(old, own))))
    assert [entry.get("holds") for entry in told.policy] == [True, None] and told.policy[1] == own


def test_a_goal_that_a_plan_spoils_is_told_and_one_that_it_does_not_touch_is_not() -> None:
    goal = Goal(tunables={"gate.shutter": (0, 1)}, maximize="cam.power")
    known = GoalRecord(lambda: None, lambda _: [Alignment("g", "aligned", at="2026-11-24T12:00:00Z", seconds=3.0)])
    setup = with_lab(goals={"g": goal})
    made = case(set_to("gate", "shutter", "closed"), setup=setup, goals=known)
    (lost,) = judge_plan(made).spoils or ()
    assert (lost.goal, lost.why, lost.seconds) == ("g", "gate.shutter changes", 3.0)
    require_permitted(made)
    kept = case(ELSE, setup=setup, goals=known)
    assert judge_plan(kept) is kept.plan


def test_of_a_bench_that_nobody_asked_what_it_can_do_nothing_is_said() -> None:
    for name in ("lab", "capability"):
        made = replace(REFUSED[name].case(), able=None)
        require_permitted(made)
        assert judge_plan(made) is made.plan


def test_a_plan_that_does_nothing_gives_no_dose() -> None:
    spent = (replace(DOSES[0], spent=99.0, power=1.0),)
    made = case(setup=sampled(), seen=observed(LICENSED, laser={"power": 0.9, "shutter": "open"}), doses=spent)
    still = replace(made, plan=replace(made.plan, operations=()))
    require_permitted(still)
    with pytest.raises(PicoError):
        require_permitted(made)


def test_what_a_plan_says_already_is_not_said_twice() -> None:
    made = case(OPEN, seen=observed(laser={"power": 4.0}))
    told = judge_plan(made)
    assert judge_plan(replace(made, plan=told)) is told
    warned = warning("beam", "the planner's own word on the beam", address="laser")
    first = case(OPEN, seen=observed(LICENSED, laser={"power": 4.0}, without=("cam",)), diagnostics=(warned,))
    assert [d.code for d in judge_plan(first).diagnostics] == ["beam-audit"], "the audit knows better"


def test_rules_see_what_the_other_judges_say() -> None:
    rule = PolicyRule(name="clean", that="plan.diagnostics.size() == 0", level="advisory")
    setup = bench(rules=(rule,))
    dark = judge_plan(case(OPEN, setup=setup))
    bright = judge_plan(case(OPEN, setup=setup, seen=observed(laser={"power": 4.0})))
    assert [entry["holds"] for entry in (*dark.policy, *bright.policy)] == [True, False]


def test_the_light_of_one_bench_is_traced_once_for_all_judges_and_for_every_digit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from pico.optics.audit import audit as tracing

    real, traced = tracing.audit, list[Any]()
    monkeypatch.setattr(tracing, "audit", lambda *given: (traced.append(given), real(*given))[1])
    monkeypatch.setattr(audit, "_VERDICTS", {})
    rule = PolicyRule(name="clean", that="audit.passes && audit.findings.size() == 0", level="advisory")
    made = case(OPEN, setup=bench(rules=(rule,)))
    judge_plan(made)
    require_permitted(replace(made))  # as an edge has it: the same plan, a case of its own
    assert len(traced) == 1
    lit = lit_by(made.setup, made.plan, made.seen)
    beside = {**lit.poses, "cam": replace(lit.poses["cam"], x=lit.poses["cam"].x + 1)}
    assert audit_key(made.setup, lit) != audit_key(made.setup, replace(lit, poses=beside))
    near = {**lit.poses, "cam": replace(lit.poses["cam"], x=lit.poses["cam"].x + 1e-9)}
    judge(made.setup, replace(lit, poses=near))
    assert len(traced) == 2
    monkeypatch.setattr(audit, "MOST", 1)
    judge(made.setup, lit)
    judge(made.setup, replace(lit, poses=near))
    assert len(traced) == 3 and len(audit._VERDICTS) == 1


JUDGING = {
    "incapacities": {"policy/capability.py"},  # as `require_able`, for what is asked for by itself
    "staleness": {"bench/saved_plans.py"},
    "expression_faults": {"policy/expectations.py"},
    "told_of": set[str](),
    "audit_of": {"policy/judging/case.py"},
    "verdicts": set[str](),
    "uncarried": {"diagnosis/claims.py", "bench/commits.py"},  # of a manifest, and of a commit
    "judge_goals": set[str](),
}
"""What judges a plan, and who asks for it beside the list: not a client or an edge that starts one."""


def test_what_judges_a_plan_is_asked_through_the_list_alone() -> None:
    root, asking = Path(audit.__file__).parent.parent, {name: set[str]() for name in JUDGING}
    for path in root.rglob("*.py"):
        text = path.read_text()
        if not any(name in text for name in JUDGING):
            continue
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(("pico.policy", "pico.diagnosis")):
                called = {alias.name for alias in node.names}
            else:
                called = {getattr(node.func, "id", "")} if isinstance(node, ast.Call) else set[str]()
            own = {"told_of", "audit_of", "verdicts"} if isinstance(node, ast.Call) else set[str]()  # imported above
            for name in (called & JUDGING.keys()) - own:
                asking[name].add(str(path.relative_to(root)))
    assert {name: paths - {"policy/judging/judges.py"} for name, paths in asking.items()} == JUDGING


def test_one_judge_is_asked_by_name() -> None:
    assert judgment_of("licenses", case(OPEN, seen=observed(laser={"power": 4.0}))).refusals
    assert not judgment_of("rules", case(carry("holder", 600, 300))).refusals
