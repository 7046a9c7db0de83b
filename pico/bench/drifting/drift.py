"""Where a bench has left the last commit: by how much, how surely, and who did it."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

from pico.backends.pushed import PUSHED
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.model.comparing.unstated import Unstated
from pico.model.diff import Change, addresses_of, value_distance
from pico.model.observation import Observation, ObservedComponent, Uncertainty, slot_at
from pico.model.operation import touched_by
from pico.model.pose import Pose, angle_between
from pico.model.primitive import primitive
from pico.model.record import record
from pico.model.setup import Setup

if TYPE_CHECKING:
    from pico.runs.journal import JournalRecord

Who = Literal["operation", "person", "unknown"]
Ends = Callable[[str], Mapping[str, Any] | None]
"""How the bench was observed at the end of a run, by its id; None if nobody knows."""
ALIKE = 0.3
"""Displacements that differ by no more than this are one, that of what measures them [mm]."""


PASSING = ("exposure", "gain", "illumination")
"""Tunables that change no light."""


@record
class Drift:
    """One tunable that has left HEAD: the change from committed to live, as it happened, and `tolerance` in words.

    `age` of the observation [s], and its `uncertainty` for a pose. `by`: who changed it last; `how`: the run that left
    it so, or the last that left it otherwise. `by_hand`: why only a person can bring it back; empty where a robot can.
    """

    change: Change
    tolerance: str = ""
    age: float = 0.0
    uncertainty: Uncertainty | None = None
    by: Who = "unknown"
    how: str = ""
    presence: str = "seen"
    by_hand: str = ""

    @property
    def address(self) -> str:
        """`p2`, or `p1.angle`."""
        own = self.change
        return own.component if own.tunable == "pose" else f"{own.component}.{own.tunable}"


@record
class LightLost:
    """A goal of the lab whose light is lost, or may be: `lost` where it was measured so, and `why`, `at` by the wall.
    `moved`: what has left HEAD, by address, of the parts that its light comes through; where that is nothing, light
    alone is lost."""

    goal: str
    lost: bool
    why: str = ""
    at: str = ""
    moved: tuple[str, ...] = ()


@record
class Drifted:
    """What has left HEAD beyond tolerance (`beyond`) and within, and what the lab's policy ignores, by address; goals
    whose light is lost with that, or without (`light`), as far as the journal knows. `unread`: values of HEAD, by
    address, that no device of the bench reads. `unstated`: what was set here and HEAD does not name.

    `held`: why nothing may be healed now; empty where that is allowed. `cut_short`: see `told_first`.
    """

    head: str
    observed_at: str
    beyond: tuple[Drift, ...] = ()
    within: tuple[Drift, ...] = ()
    ignored: tuple[str, ...] = ()
    held: str = ""
    cut_short: tuple[Diagnostic, ...] = ()
    light: tuple[LightLost, ...] | None = None
    unread: tuple[str, ...] = ()
    unstated: tuple[Unstated, ...] = ()

    def __repr__(self) -> str:
        lost = f"; light lost: {', '.join(one.goal for one in self.light)}" if self.light else ""
        what = f"{addresses_of([d.change for d in self.beyond])} left it" if self.beyond else "nothing left it"
        return f"<drift from {self.head}: {what}{lost}>"


def news(before: Sequence[Drift], now: Sequence[Drift]) -> tuple[list[Drift], list[str]]:
    """Return what has drifted, or drifted on, since an earlier look, and the addresses of what is right again."""
    known = {d.address: d.change for d in before}
    fresh = [d for d in now if d.address not in known or _moved_on(known[d.address], d.change)]
    return fresh, sorted(known.keys() - {d.address for d in now})


def _moved_on(before: Change, now: Change) -> bool:
    return before.text != now.text


def require_heal(setup: Setup) -> None:
    """Raise PicoError (exit code DENIED) unless the lab allows that what drifted is brought back unasked."""
    if not setup.lab.policy.heal:
        hint = "`policy: {heal: true}` in the lab allows it; without --heal `pico drift --watch` only tells"
        raise PicoError(
            error("denied", f"the policy of {setup.lab.name} does not allow to heal", hint=hint), ExitCode.DENIED
        )


def calibration_drift(setup: Setup, beyond: Sequence[Drift]) -> str:
    """Return why drift looks like that of the cameras' calibration and not of the parts; empty where it doesn't.

    What can't move is displaced, or three parts and more are displaced alike: then what measures has moved.
    """
    moved = {d.change.component: _displacement(d.change) for d in beyond if d.change.tunable == "pose"}
    shifts = {name: by for name, by in moved.items() if by is not None}
    fixed = sorted(name for name in shifts if setup.lab.inventory[name].pose is not None)
    if fixed:
        return f"{fixed[0]} is fixed and seems moved: check the calibration, `pico calibrate`"
    if len(shifts) < 3:
        return ""
    dx, dy = (statistics.median(by[axis] for by in shifts.values()) for axis in (0, 1))
    alike = [n for n, by in shifts.items() if abs(by[0] - dx) <= ALIKE and abs(by[1] - dy) <= ALIKE]
    if len(alike) >= 3 and 2 * len(alike) > len(shifts):
        return (
            f"{len(alike)} parts seem moved alike, by ({dx:.2g}, {dy:.2g}) mm: check the calibration, `pico calibrate`"
        )
    return ""


def _displacement(change: Change) -> tuple[float, float] | None:
    base, live = change.before, change.after
    if isinstance(live, Mapping) and isinstance(base, Mapping):
        return live["x"] - base["x"], live["y"] - base["y"]
    return None


def drift(
    setup: Setup, seen: Observation, change: Change, records: Iterable[JournalRecord], ends: Ends = lambda run: None
) -> Drift:
    """Return a change with how surely it was seen, and who made it as far as the journal knows; `ends`: see `who`."""
    part = seen.components.get(change.component) or ObservedComponent(presence="missing")
    kind = setup.type_of(change.component)
    if change.tunable == "pose":
        tolerance = f"{kind.pose.tolerance.position:g} mm, {kind.pose.tolerance.yaw:g}°"
    else:
        tunable = kind.tunables[change.tunable]
        tolerance = f"{tunable.tolerance:g} {tunable.unit}".rstrip() if tunable.datatype == "float" else "none"
    by: Who = "unknown"
    by, how = (by, "") if change.tolerated else who(setup, part, change, records, ends)
    return Drift(
        change=change, tolerance=tolerance, age=part.age, by=by, how=how, presence=part.presence,
        by_hand="" if change.tolerated else by_hand(setup, part, change),
        uncertainty=part.uncertainty if change.tunable == "pose" and part.pose else None,
    )  # fmt: skip


def by_hand(setup: Setup, part: ObservedComponent, change: Change) -> str:
    """Return why no robot can bring one tunable back: no arm may move the part, or none reaches where it stands."""
    from pico.motion.reach import out_of_reach

    kind = setup.type_of(change.component)
    if change.tunable != "pose":
        return "no motor turns it" if kind.tunables[change.tunable].mover == "person" else ""
    if not setup.movable(change.component):
        return "no arm may move it"
    robots = list(setup.lab.robots.values())
    if part.pose is None or any(robot.model != "xarm7" for robot in robots):
        return ""
    return "where it stands no arm reaches it" if out_of_reach(robots, part.pose.x, part.pose.y, kind.geometry) else ""


def who(
    setup: Setup,
    part: ObservedComponent,
    change: Change,
    records: Iterable[JournalRecord],
    ends: Ends = lambda run: None,
) -> tuple[Who, str]:
    """Return who changed a tunable last, and how that is known. `ends`: how the bench was observed at the end of a run.

    `operation` if the last one that moved or pushed it left it as it is now, or failed in a run at whose end it was as
    it is now, or nobody knows how that one ended, or a hand holds it; `person` if a part stands elsewhere than any left
    it; `unknown` for what else can change by itself.
    """
    records = tuple(records)
    if part.presence == "held" and (begun := [r.key for r in records if _intends(r, change)]):
        return "operation", f"run {begun[-1].split('/')[0]}, which picked it"
    touched = [r for r in _touching(records, change) if r.kind in ("done", "failed", "unknown", "resolved")]
    last = touched[-1] if touched else None
    run = last.key.split("/")[0] if last else ""
    cut = _cut_short(records, change)
    if cut or (last and last.kind == "unknown"):
        how = "whose optimization was cut short" if cut else "of which nobody knows how it ended"
        return "operation", f"run {cut or run}, {how}"
    if last and (how := _by_run(setup, change, part, last, ends)):
        return "operation", f"run {run}{how}"
    placed = f"last {'placed' if change.tunable == 'pose' else 'set'} by run {run}, {last.at}" if last else ""
    if change.tunable == "pose":
        home = setup.lab.inventory[change.component].home
        if not last and home and part.pose and slot_at(setup, part.pose) == home:
            return "unknown", "at home, where a new bench has it"
        return "person", placed or "no run placed it"
    return "unknown", placed or "no run set it"


def _by_run(setup: Setup, change: Change, part: ObservedComponent, last: JournalRecord, ends: Ends) -> str:
    """Return how the run of the last operation that touched a tunable left it as it is now, in words; '' if it did
    not."""
    if _as_left(setup, change, part, _after(last, change)):
        return f"{', which pushed it' if change.component in _pushed(last) else ''}, {last.at}"
    if last.kind != "failed":
        return ""
    at_end = ((ends(last.key.split("/")[0]) or {}).get("components") or {}).get(change.component)
    return ", in which an arm lost it" if at_end and _as_left(setup, change, part, at_end) else ""


def _cut_short(records: Sequence[JournalRecord], change: Change) -> str:
    """Return the run that touched a tunable last, where that was an optimization which came to no end: what it set
    besides its first component nobody wrote down."""
    keys = [r.key for r in records if _intends(r, change) and "what" in r.data.get("arguments", {})]
    last = [r for r in _touching(records, change) if r.kind != "intent"][-1:]
    if not last or last[0].key not in keys:
        return ""
    cut = last[0].kind == "started" or (last[0].kind == "resolved" and last[0].data.get("outcome") != "done")
    return last[0].key.split("/")[0] if cut else ""


def _touching(records: Iterable[JournalRecord], change: Change) -> list[JournalRecord]:
    wanted, found = set(), []
    for r in records:
        if _intends(r, change):
            wanted.add(r.key)
        elif r.key in wanted or (change.tunable == "pose" and change.component in _pushed(r)):
            found.append(r)
    return found


def _intends(r: JournalRecord, change: Change) -> bool:
    if r.kind != "intent" or r.data.get("primitive") == "verify":  # which sets back what it set
        return False
    arguments = r.data.get("arguments", {})
    if "what" in arguments or r.component != change.component:
        return (change.component, change.tunable) in touched_by(r.component, arguments)
    moves = primitive(str(r.data.get("primitive"))).changes in ("pose", "anything")
    return arguments.get("tunable") == change.tunable or (change.tunable == "pose" and moves)


def _pushed(record: JournalRecord) -> Mapping[str, Any]:
    """Return the components that an operation moved beside its own, as it left them, by name."""
    found: Mapping[str, Any] = (record.data.get("data") or {}).get(PUSHED) or {}
    return found


def _after(last: JournalRecord, change: Change) -> Mapping[str, Any]:
    """Return a component as an operation left it; of an optimization its tunables, of whatever component."""
    if change.component in (pushed := _pushed(last)):
        return pushed[change.component]  # type: ignore[no-any-return]
    address = f"{change.component}.{change.tunable}"
    found = (last.data.get("data") or {}).get("last") or {}
    if address in found:
        return {"values": {change.tunable: {"value": found[address]}}}
    return last.data.get("after") or {}


def _as_left(setup: Setup, change: Change, part: ObservedComponent, after: Mapping[str, Any]) -> bool:
    kind = setup.type_of(change.component)
    if change.tunable != "pose":
        left = after.get("values", {}).get(change.tunable, {}).get("value")
        live = part.values.get(change.tunable)
        tunable = kind.tunables[change.tunable]
        known = left is not None and live is not None and live.value is not None
        return known and value_distance(tunable, live.value, left) <= tunable.tolerance  # type: ignore[union-attr,arg-type]
    if "pose" not in after or part.pose is None:
        return after.get("presence") == part.presence != "seen"
    pose, tolerance = Pose(**after["pose"]), kind.pose.tolerance
    turned = abs(angle_between(pose.yaw, part.pose.yaw))
    return pose.distance(part.pose) <= tolerance.position and turned <= tolerance.yaw
