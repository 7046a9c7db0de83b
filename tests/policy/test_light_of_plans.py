"""Which bench the beam audit judges a plan on, and what it then refuses; what it says of a bench is a stand-in here."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest
from judged import require
from laser_lab import POSES, STRONGEST, UNKNOWN, bench, carry, commanded, observed, search, set_to, with_type

from pico.diagnostics import ExitCode, PicoError
from pico.model.catalog import Tunable
from pico.model.operation import Operation, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.audit.findings import Audit, Finding, told
from pico.policy import audit
from pico.policy.audit import Lit, audit_of, lit_by, told_of
from pico.policy.driven import fine_steps

SETUP = bench()
OPEN, CLOSE = set_to("laser", "shutter", "open"), set_to("laser", "shutter", "closed")
LIT: Mapping[str, Any] = {"emission": True, "shutter": "open", "power": 4.0}


def plan(*operations: Operation, state: Mapping[str, Any] | None = None, **target: Any) -> Plan:
    return Plan(lab=LabRef(name="minimal", digest=""), backend="sim", fidelity="kinematic", base=Base(),
                target=Target(state=state or {}, **target), operations=operations)  # fmt: skip


def finding(source: str = "laser", of: Any = "3R", kind: Any = "end", **more: Any) -> Finding:
    return Finding(
        kind=kind, source=source, laser_class=of, way=(), where="ends on a wall", power=4.0, limit=0.39, **more
    )


class Judge:
    """Keeps the benches that it is asked about, and finds the same of each."""

    def __init__(self, *found: Finding, knows: Callable[[Lit], bool] = lambda lit: True) -> None:
        self.asked, self._found, self._knows = list[Lit](), found, knows

    def __call__(self, setup: Setup, lit: Lit) -> Audit | None:
        self.asked.append(lit)
        unjudged = (f"part{len(self.asked) % 2}",)
        return Audit(findings=self._found, lasers={}, unjudged=unjudged) if self._knows(lit) else None


# which bench is judged


def test_the_bench_is_judged_as_the_plan_leaves_it() -> None:
    lit = lit_by(SETUP, plan(OPEN, carry("holder", 700, 300), set_to("cam", "exposure", 7)), observed())
    assert lit.poses["holder"] == Pose(700, 300, 0) and lit.poses["cam"] == POSES["cam"]
    assert lit.values["cam"]["exposure"] == 7 and lit.values["laser"]["shutter"] == "open"
    assert lit.lasers == ("laser",) and lit.opened == {"laser"} and not lit.enclosed
    assert lit_by(bench(enclosed=True), plan(OPEN), observed()).enclosed is True


@pytest.mark.parametrize("presence", ["seen", "missing", "held", "toppled"])
def test_only_parts_that_are_seen_stand_in_the_light(presence: Any) -> None:
    seen = observed()
    part = replace(seen.components["holder"], presence=presence)
    seen = replace(seen, components={**seen.components, "holder": part, "stranger": part})
    found = lit_by(SETUP, plan(OPEN), seen)
    assert ("holder" in found.poses) is (presence == "seen") and "stranger" not in found.poses
    assert "stranger" not in found.values
    unseen = replace(seen, components={**seen.components, "holder": replace(part, presence="seen", pose=None)})
    assert "holder" not in lit_by(SETUP, plan(OPEN), unseen).poses


@pytest.mark.parametrize(("dx", "dyaw", "settled"), [
    (0.0, 0.0, True), (0.5, 0.0, True), (0.6, 0.0, False), (0.0, 0.5, True), (0.0, 0.6, False), (0.0, -0.5, True),
    (0.0, -0.6, False), (0.4, 0.6, False), (0.6, 0.4, False),
])  # fmt: skip
def test_what_stands_within_its_tolerance_of_its_goal_counts_as_there(dx: float, dyaw: float, settled: bool) -> None:
    assert SETUP.type_of("holder").pose.tolerance.position == SETUP.type_of("holder").pose.tolerance.yaw == 0.5
    seen, goal = observed(), POSES["holder"]
    there = Pose(goal.x + dx, goal.y, goal.yaw + dyaw)
    part = replace(seen.components["holder"], pose=there)
    seen = replace(seen, components={**seen.components, "holder": part})
    state = {"holder": {"pose": {"x": goal.x, "y": goal.y, "yaw": goal.yaw}}}
    assert lit_by(SETUP, plan(OPEN, state=state), seen).poses["holder"] == (goal if settled else there)
    assert lit_by(SETUP, plan(OPEN), seen).poses["holder"] == there, "the state says nothing of it"


@pytest.mark.parametrize(("now", "wanted", "counts"), [
    (3.0, 3.25, 3.25), (3.0, 3.75, 3.0), (3.75, 3.0, 3.75), (3.25, 3.0, 3.0), (3.0, None, 3.0), (3.0, "x", 3.0),
    (3.0, 3.5, 3.5), (3.5, 3.0, 3.0),
])  # fmt: skip
def test_a_value_within_its_tolerance_of_its_goal_counts_as_that(now: float, wanted: Any, counts: float) -> None:
    kinds = SETUP.type_of("cam").tunables
    setup = with_type(SETUP, "cam", tunables={**kinds, "exposure": replace(kinds["exposure"], tolerance=0.5)})
    state = {"cam": {} if wanted is None else {"exposure": wanted}}
    found = lit_by(setup, plan(OPEN, state=state), observed(cam={"exposure": now, "unheard": 1.0}))
    assert found.values["cam"] == {"exposure": counts, "unheard": 1.0}


def test_a_flag_is_never_within_a_tolerance() -> None:
    state = {"laser": {"emission": False, "power": True}}
    found = lit_by(SETUP, plan(OPEN, state=state), observed(laser={"emission": True}))
    assert found.values["laser"]["emission"] is True and found.values["laser"]["power"] == 0.3


@pytest.mark.parametrize("before", [0.3, 4.0, 50.0])
@pytest.mark.parametrize("to", [0.0, 0.3, 4.0, 50.0])
def test_light_that_is_let_out_at_some_time_counts_whatever_follows(before: float, to: float) -> None:
    power = set_to("laser", "power", to)
    seen = observed(laser={**LIT, "power": before})
    found = lit_by(SETUP, plan(power, CLOSE), seen)
    assert found.values["laser"]["power"] == (max(before, to) if to > 0 else 0.0)
    back = lit_by(SETUP, plan(power, set_to("laser", "power", 0.0)), seen)
    assert back.values["laser"]["power"] == (max(before, to) if to > 0 else 0.0)
    assert lit_by(SETUP, plan(OPEN, CLOSE), observed()).values["laser"]["shutter"] == "open"
    assert lit_by(SETUP, plan(CLOSE, OPEN), observed()).values["laser"]["shutter"] == "open"
    assert lit_by(SETUP, plan(CLOSE), seen).lasers == ()


def test_a_power_of_which_nothing_was_known_counts_as_what_it_is_raised_to() -> None:
    setup = with_type(SETUP, "laser", tunables={
        **SETUP.type_of("laser").tunables, "power": replace(SETUP.type_of("laser").tunables["power"], range=None)
    })  # fmt: skip
    seen = observed(laser={**LIT, "power": None})
    for to in (0.4, 4.0):
        assert lit_by(setup, plan(set_to("laser", "power", to)), seen).values["laser"]["power"] == to


@pytest.mark.parametrize("emission", [True, False, UNKNOWN, commanded(True), commanded(False), None])
@pytest.mark.parametrize("shutter", ["open", "closed", UNKNOWN, commanded("closed"), None])
def test_a_laser_shines_unless_it_was_read_back_dark(emission: Any, shutter: Any) -> None:
    seen = observed(laser={"emission": emission, "shutter": shutter})
    shines = emission is not False and shutter != "closed"
    judged = Judge()
    _, lit = audit_of(SETUP, plan(set_to("cam", "exposure", 2)), seen, judged)
    assert lit.lasers == (("laser",) if shines else ()) and bool(judged.asked) is shines
    assert lit.opened == set(), "it lets nothing out"


@pytest.mark.parametrize(("power", "counts"), [(UNKNOWN, STRONGEST), (commanded(0.1), STRONGEST), (None, STRONGEST),
                                               (0.1, 0.1)])  # fmt: skip
def test_a_power_that_was_not_read_back_is_judged_at_its_highest(power: Any, counts: float) -> None:
    lit = lit_by(SETUP, plan(OPEN), observed(laser={"power": power}))
    assert lit.values["laser"]["power"] == counts
    assert audit_of(SETUP, plan(OPEN), observed(laser={"power": power}), Judge())[0].lasers == {
        "laser": "1" if counts < 1 else "3B"
    }


def test_a_bench_that_stays_dark_is_not_judged_at_all() -> None:
    judged = Judge(finding())
    for operations, seen in (
        ((set_to("cam", "exposure", 2), carry("holder", 700, 300)), observed()),
        ((carry("holder", 700, 300),), observed(laser=LIT, without=("laser",))),
    ):
        found, lit = audit_of(SETUP, plan(*operations), seen, judged)
        assert (found, lit) == (Audit(lasers={}), Lit({}, {}, ())) and judged.asked == []
    found, lit = audit_of(SETUP, plan(CLOSE), observed(), judged)
    assert found.findings == () and lit.lasers == () and judged.asked == []
    missing = observed(laser=LIT)
    parts = {n: c for n, c in missing.components.items() if n != "laser"}
    assert (
        audit_of(SETUP, plan(set_to("cam", "exposure", 2)), replace(missing, components=parts), judged)[1].lasers == ()
    )


# which lasers a plan lets out


@pytest.mark.parametrize(("operations", "opened"), [
    ((OPEN,), {"laser"}), ((CLOSE,), set()), ((set_to("cam", "exposure", 2),), set()),
    ((set_to("laser", "power", 3.0),), {"laser"}), ((set_to("gate", "shutter", "open"),), {"laser", "second"}),
    ((set_to("gate", "shutter", "closed"),), set()), ((search({"laser.power": (1, 2)}),), {"laser", "second"}),
    ((search({"cam.exposure": (1, 2)}, "survey"),), {"laser", "second"}),
    ((search({"cam.exposure": (1, 2)}, "teleoperate"),), {"laser", "second"}),
    ((Operation(id="s", primitive="scan", component="cam", arguments={"tunable": "exposure"},
                reason=Reason(kind="asked")),), {"laser", "second"}),
    ((set_to("cam", "exposure", 2), OPEN, CLOSE), {"laser"}),
])  # fmt: skip
def test_a_plan_answers_for_the_lasers_that_it_opens_or_searches_with(operations: Any, opened: set[str]) -> None:
    lit = lit_by(SETUP, plan(*operations), observed(laser=LIT, second=LIT))
    assert lit.lasers == (("laser", "second") if CLOSE not in operations or OPEN in operations else ("second",))
    assert lit.opened == opened


@pytest.mark.parametrize("opens", [True, False])
@pytest.mark.parametrize("of", ["1", "2", "3R", "3B", "4"])
@pytest.mark.parametrize("enclosed", [True, False])
@pytest.mark.parametrize("kind", ["end", "carried"])
def test_a_finding_refuses_a_plan_that_opens_that_laser_or_carries_through_it(
    opens: bool, of: Any, enclosed: bool, kind: Any
) -> None:
    lit = Lit({}, {}, ("laser", "second"), frozenset({"laser"} if opens else ()), enclosed)
    found = told_of(plan(), Audit(findings=(finding(of=of, kind=kind), finding("second", "1")), lasers={}), lit)
    refused = of in ("3R", "3B", "4") and not enclosed and (opens or kind == "carried")
    assert [(d.severity, d.address) for d in found] == [("error" if refused else "warning", "laser"),
                                                        ("warning", "second")]  # fmt: skip
    assert found[0].code == "beam-audit"


def test_findings_of_carried_parts_come_first_and_none_is_lost() -> None:
    three = (finding(), finding("second", kind="carried"), finding("second", kind="damage"))
    found = told_of(plan(), Audit(findings=three, lasers={}), Lit({}, {}, (), frozenset({"laser"})))
    assert [(d.address, d.severity) for d in found] == [("second", "error"), ("laser", "error"), ("second", "warning")]


@pytest.mark.parametrize(("target", "drawn"), [
    ({"revision": "e1"}, "`pico plan e1 --picture"), ({}, "`pico plan --picture"),
    ({"cause": "single"}, "`pico beam --picture"),
])  # fmt: skip
def test_a_finding_says_what_draws_it(target: Any, drawn: str) -> None:
    (found,) = told_of(plan(**target), Audit(findings=(finding(path=((0, 0), (1, 1))),), lasers={}), Lit({}, {}, ()))
    assert drawn in found.hint


def test_a_plan_that_opens_a_dangerous_beam_is_denied_and_an_empty_one_never(monkeypatch: pytest.MonkeyPatch) -> None:
    def judged(*_: Any) -> tuple[Audit, Lit]:
        return Audit(findings=found, lasers={}), Lit({}, {}, ("laser",), frozenset({"laser"}))

    monkeypatch.setattr(audit, "audit_of", judged)
    found = (finding(),)
    with pytest.raises(PicoError, match="is not safe") as caught:
        require("beams", SETUP, plan(OPEN), observed())
    assert caught.value.exit_code == ExitCode.DENIED and len(caught.value.diagnostics) == 1
    found = (finding(of="2"), finding("second"))
    require("beams", SETUP, plan(OPEN), observed())
    monkeypatch.undo()
    away = observed(laser=LIT, without=("cam",))
    with pytest.raises(PicoError, match="leaves the table"):
        require("beams", SETUP, plan(OPEN), away)
    require("beams", SETUP, plan(), away)


def test_the_laser_of_the_bench_is_judged_by_its_light() -> None:
    with pytest.raises(PicoError, match="leaves the table"):
        away = observed(laser={"power": 4.0}, without=("cam",))
        require("beams", SETUP, plan(OPEN), away)
    require("beams", SETUP, plan(OPEN), observed(laser={"power": 0.1}))


def test_a_verdict_counts_for_the_settings_poses_and_lasers_that_it_is_of() -> None:
    """Nothing but the power, a pose or the lasers differs between two benches that are judged one after the other."""
    poses = {name: pose for name, pose in POSES.items() if name != "cam"}
    away = Lit(poses, {"laser": {**LIT, "power": 4.0}}, ("laser",))
    others = (
        replace(away, values={"laser": {**LIT, "power": 0.1}}), replace(away, poses=POSES), replace(away, lasers=()),
    )  # fmt: skip
    first = audit.judge(SETUP, away)
    assert [f.kind for f in first.findings] == ["end"] and audit.judge(SETUP, replace(away)) is first
    for one in others:
        assert "leaves the table" not in str(audit.judge(SETUP, one).findings), one
    assert audit.judge(SETUP, away) is first, "what is the same is traced once"
    assert len({audit.audit_key(SETUP, one) for one in (away, *others)}) == 4


# what is searched


def points(judged: Judge) -> list[tuple[Any, ...]]:
    return [(lit.values["laser"].get("power"), lit.values["cam"].get("exposure")) for lit in judged.asked]


@pytest.mark.parametrize("primitive", ["optimize", "teleoperate", "survey", "scan"])
def test_of_a_tunable_that_is_searched_five_values_are_judged(primitive: str) -> None:
    judged = Judge(finding())
    if primitive == "scan":
        op = Operation(id="s", primitive="scan", component="laser", arguments={"tunable": "power"},
                       reason=Reason(kind="asked"))  # fmt: skip
        low, high = 0.0, STRONGEST
    else:
        low, high = 1.0, 3.0
        op = search({"laser.power": (low, high)}, primitive)
    found, _ = audit_of(SETUP, plan(op), observed(laser=LIT), judged)
    step = (high - low) / 4
    assert [one for one, _ in points(judged)] == [4.0, *(low + n * step for n in range(5))]
    assert len(found.findings) == 1 and found.findings[0].hint == "", "as the plan leaves it, too"


def test_a_finding_of_a_search_alone_says_where() -> None:
    judged = Judge(finding(hint="block it"), knows=lambda lit: lit.values["laser"]["power"] == 2.5)
    found, _ = audit_of(SETUP, plan(search({"laser.power": (1, 4)})), observed(laser={**LIT, "power": 4.0}), judged)
    (said,) = told(found, refused=frozenset(), drawn="")
    assert said.hint.startswith("the search can reach this at laser.power at 2.5: narrow its bounds")
    assert "; block it" in said.hint


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
def test_the_corners_that_up_to_four_tunables_span_are_judged(count: int) -> None:
    names = [("laser", "power"), ("cam", "exposure"), ("cam", "a"), ("cam", "b"), ("cam", "c")][:count]
    bounds = {f"{c}.{t}": (float(n + 1), float(n + 5)) for n, (c, t) in enumerate(names)}
    judged = Judge()
    audit_of(SETUP, plan(search(bounds)), observed(laser=LIT, cam={"exposure": 0.5}), judged)
    corners = 2**count if 1 < count <= 4 else 0
    assert len(judged.asked) == 1 + 5 * count + corners
    if corners:
        spanned = [tuple(lit.values[c][t] for c, t in names) for lit in judged.asked[-corners:]]
        assert sorted(spanned) == sorted(itertools.product(*bounds.values()))
    assert all(lit.lasers == ("laser",) for lit in judged.asked)


def test_what_has_no_bounds_or_no_range_has_no_values_between() -> None:
    for op in (
        search({"cam.exposure": None}), set_to("cam", "exposure", 3),
        Operation(id="s", primitive="scan", component="cam", arguments={"tunable": "nothing"},
                  reason=Reason(kind="asked")),
        Operation(id="s", primitive="scan", component="stranger", arguments={"tunable": "power"},
                  reason=Reason(kind="asked")),
        Operation(id="s", primitive="scan", component="laser", arguments={"tunable": "shutter"},
                  reason=Reason(kind="asked")),
        Operation(id="s", primitive="home", component="laser", arguments={"tunable": "power"},
                  reason=Reason(kind="asked")),
    ):  # fmt: skip
        judged = Judge()
        audit_of(SETUP, plan(op), observed(laser=LIT), judged)
        assert len(judged.asked) == 1, op


def test_verdicts_are_put_together_and_what_the_judge_does_not_know_is_left_out() -> None:
    judged = Judge(finding(), finding("second"), finding())
    found, _ = audit_of(SETUP, plan(OPEN, search({"cam.exposure": (1, 2)}, id="op2")), observed(), judged)
    assert [f.source for f in found.findings] == ["laser", "second"] and found.unjudged == ("part0", "part1")
    found, _ = audit_of(SETUP, plan(OPEN), observed(), Judge(finding(), knows=lambda lit: False))
    assert found.findings == () and found.lasers == {"laser": "1"} and found.unjudged == ()


# what is carried


@pytest.mark.parametrize("power", [0.3, 0.9, 4.0, 50.0])
@pytest.mark.parametrize("closed", ["before", "after", "never", "already"])
@pytest.mark.parametrize("allowed", [True, False])
def test_no_part_is_carried_while_a_laser_above_class_2_may_be_open(power: float, closed: str, allowed: bool) -> None:
    setup = bench(open_beam=allowed)
    close = set_to("laser", "shutter", "closed", "c", after=("m1",) if closed == "after" else ())
    moved = carry("holder", 700, 300, after=("c",) if closed == "before" else ())
    operations = (moved,) if closed in ("never", "already") else (close, moved)
    seen = observed(laser={**LIT, "power": power, "shutter": "closed" if closed == "already" else "open"})
    found, lit = audit_of(setup, plan(*operations), seen, Judge())
    wrong = power > 1.0 and closed in ("after", "never")
    assert [(f.kind, f.source, f.component, f.laser_class) for f in found.findings] == (
        [("carried", "laser", "holder", "3R" if power < 5 else "3B")] if wrong else []
    )
    assert [d.severity for d in told_of(plan(*operations), found, lit)] == (["error"] if wrong else [])
    if wrong:
        assert found.findings[0].power == power and "while arm1 carries it" in found.findings[0].where
        assert found.findings[0].path[0] == (180.0, 420.0) and len(found.findings[0].path) >= 2


def test_each_part_and_laser_is_told_once_and_what_no_arm_carries_not() -> None:
    seen = observed(laser=LIT, second={**LIT, "power": 50.0})
    ops = (carry("holder", 700, 300), carry("cam", 900, 300, "m2"), carry("holder", 500, 420, "m3"))
    found, _ = audit_of(SETUP, plan(*ops), seen, Judge())
    assert sorted((f.source, f.component) for f in found.findings) == [
        ("laser", "cam"), ("laser", "holder"), ("second", "cam"), ("second", "holder")
    ]  # fmt: skip
    by_hand = Operation(id="h", primitive="operator", component="holder", reason=Reason(kind="operator"),
                        arguments={"to": {"pose": {"x": 1, "y": 2, "yaw": 0}}})  # fmt: skip
    assert audit_of(SETUP, plan(by_hand, set_to("cam", "exposure", 3)), seen, Judge())[0].findings == ()


def test_a_laser_that_shines_only_at_first_or_only_later_counts_while_parts_are_carried() -> None:
    close = set_to("laser", "shutter", "closed", "c", after=("m1",))
    found, _ = audit_of(SETUP, plan(carry("holder", 700, 300), close), observed(laser=LIT), Judge())
    assert [f.source for f in found.findings] == ["laser"]
    unplaced = observed(laser=LIT)
    nowhere = replace(unplaced.components["laser"], pose=None)
    unplaced = replace(unplaced, components={**unplaced.components, "laser": nowhere})
    found, _ = audit_of(SETUP, plan(carry("holder", 700, 300)), unplaced, Judge())
    assert [(f.source, f.path) for f in found.findings] == [("laser", ())], "it shines, wherever it stands"
    later = (OPEN, carry("holder", 700, 300, after=("op1",)))
    found, _ = audit_of(SETUP, plan(*later), observed(laser={"power": 4.0}), Judge())
    assert [f.source for f in found.findings] == ["laser"]


# what is driven while light may be on


ANGLE = Tunable(unit="mrad", range=(-70.0, 70.0), mover="motor", tolerance=0.05)
STEERING = with_type(SETUP, "holder", tunables={"tip": ANGLE, "tilt": ANGLE, "angle": ANGLE})
TURN = set_to("holder", "tip", 3.0)
BY_HAND = replace(TURN, primitive="operator")
HOME = Operation(id="op1", primitive="home", component="holder", reason=Reason(kind="asked"))
LATE = replace(set_to("laser", "shutter", "open", "op2"), after=("op1",))
SHUT: Mapping[str, Any] = {**LIT, "shutter": "closed"}
WHOLE = (-70.0, 70.0)


@pytest.mark.parametrize(
    ("operations", "laser", "tip", "spans"),
    [
        ((TURN,), LIT, 1.0, {"tip": (1.0, 3.0)}),
        ((TURN,), LIT, 5.0, {"tip": (3.0, 5.0)}),
        ((TURN, set_to("holder", "tip", -2.0, "op3")), LIT, 1.0, {"tip": (-2.0, 3.0)}),
        ((TURN,), LIT, UNKNOWN, {"tip": WHOLE}),
        ((TURN,), LIT, commanded(1.0), {"tip": WHOLE}),
        ((TURN,), LIT, None, {"tip": WHOLE}),
        ((TURN,), SHUT, 1.0, {}),
        ((TURN, LATE), SHUT, 1.0, {}),
        ((TURN, OPEN), SHUT, 1.0, {"tip": (1.0, 3.0)}),
        ((TURN,), {**LIT, "power": STRONGEST}, 1.0, {}),
        ((set_to("holder", "angle", 3.0),), LIT, 1.0, {}),
        ((HOME,), LIT, 1.0, {"tip": WHOLE, "tilt": WHOLE}),
        ((HOME,), SHUT, 1.0, {}),
        ((BY_HAND,), LIT, 1.0, {"tip": (1.0, 3.0)}),
        ((BY_HAND,), SHUT, 1.0, {}),
        ((search({"holder.tip": (-4, 4)}),), LIT, 1.0, {"tip": (-4.0, 4.0)}),
        ((search({"holder.tip": None}, "teleoperate"),), LIT, 1.0, {"tip": WHOLE}),
        ((search({"holder.angle": (-4, 4)}),), LIT, 1.0, {}),
        ((search({"holder.tip": (-4, 4)}), set_to("holder", "tip", 9.0, "op3")), LIT, 1.0, {"tip": (-4.0, 9.0)}),
    ],
)
def test_up_to_class_3r_what_is_driven_in_light_spans_what_it_passes(
    operations: tuple[Operation, ...], laser: Any, tip: Any, spans: Any
) -> None:
    lit = lit_by(STEERING, plan(*operations), observed(laser=laser, holder={"tip": tip, "tilt": 0.0}))
    assert lit.spans.get("holder", {}) == spans


@pytest.mark.parametrize(("power", "opened"), [(0.9, {"laser"}), (4.0, {"laser"}), (STRONGEST, set())])
def test_who_drives_a_mirror_in_light_answers_for_that_laser_up_to_class_3r(power: float, opened: set[str]) -> None:
    """Above, a mirror counts over its full range when the laser is opened."""
    for one in (TURN, HOME, BY_HAND):
        seen = observed(laser={**LIT, "power": power}, holder={"tip": 1.0, "tilt": 0.0})
        assert lit_by(STEERING, plan(one), seen).opened == opened
        assert not lit_by(STEERING, plan(one), observed(holder={"tip": 1.0, "tilt": 0.0})).opened
    assert not lit_by(STEERING, plan(set_to("cam", "exposure", 7)), seen).opened


def test_what_is_driven_in_light_is_judged_on_its_way_and_a_verdict_counts_for_that_way() -> None:
    judged, seen = Judge(), observed(laser=LIT, holder={"tip": 1.0, "tilt": 0.0})
    audit_of(STEERING, plan(TURN), seen, judged)
    first, *others = judged.asked
    assert first.spans == {"holder": {"tip": (1.0, 3.0)}}
    assert [one.values["holder"]["tip"] for one in others] == [1.0, 1.5, 2.0, 2.5, 3.0]
    assert not any(one.spans for one in others)
    assert audit.audit_key(STEERING, first) != audit.audit_key(STEERING, replace(first, spans={}))


@pytest.mark.parametrize(("low", "high", "steps"), [(0.0, 0.0, 0), (-1.0, 1.0, 1), (-70.0, 70.0, 40), (0.0, 1e4, 80)])
def test_a_mirror_is_turned_on_trial_in_steps_of_half_a_pupil_at_a_meter(low: float, high: float, steps: int) -> None:
    kind = SimpleNamespace(tunables={"tip": Tunable(unit="mrad")})
    setup: Any = SimpleNamespace(type_of=lambda name: kind)
    assert fine_steps(setup, "m1", "tip", low, high) == steps
