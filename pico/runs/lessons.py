"""What recorded runs tell a twin: planned against seen poses and times, looks at what stood still.

Pure: runs in, data out. `pico.runs.learning` makes of them what the twin injects.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from pico.model.observation import ObservedComponent, observed_from_json
from pico.model.pose import Pose, angle_between
from pico.model.primitive import primitive
from pico.model.setup import Setup
from pico.model.trace.learned import work
from pico.model.trace.run import TraceEvent
from pico.runs.document import RecordedRun
from pico.runs.operations import operations

LOOKED = ("stereo", "known height", "in hand")
"""How a pose is known that a camera saw just then."""
SEEN = ("", *LOOKED)
"""The same where a simulator knows poses exactly, too."""
ENDS = ("done", "failed", "unknown")


@dataclass(frozen=True, slots=True)
class Off:
    """By how much a part was seen off its goal that an arm had put down, or off where the look before saw it: x, y
    [mm], yaw [deg]; and how surely it was seen, one standard deviation each."""

    component: str
    x: float
    y: float
    yaw: float
    position: float = 0.0
    turn: float = 0.0


@dataclass(slots=True)
class Lessons:
    """All of that: `placed`; `times`, pairs of measured and planned seconds by `work`; `looked`,
    steps from look to look, by part; `stood`, where each part was seen last."""

    placed: list[Off] = field(default_factory=list)
    times: dict[str, list[tuple[float, float]]] = field(default_factory=lambda: defaultdict(list))
    looked: dict[str, list[Off]] = field(default_factory=lambda: defaultdict(list))
    stood: dict[str, Pose] = field(default_factory=dict)


def lessons(setup: Setup, runs: Iterable[RecordedRun]) -> Lessons:
    """Return what runs tell, in the order in which they were; of parts that the bench still has."""
    found = Lessons()
    for run in sorted(runs, key=lambda run: run.document.order):
        _operations(setup, run, found)
        _looks(setup, run, found)
    return found


def _operations(setup: Setup, run: RecordedRun, found: Lessons) -> None:
    """Take in how each operation ended: those that were done, and placements that missed."""
    events = {(e.run or "", e.operation, e.attempt, e.kind): e for e in run.trace}
    for op in operations(run.trace):
        key = op.run, op.id, op.attempt
        end = next((e for kind in ENDS if (e := events.get((*key, kind)))), None)
        missed = op.outcome == "failed" and (op.error or {}).get("code") == "misplaced"
        if end is None or not (op.outcome == "done" or missed):
            continue
        if primitive(op.primitive).carries and op.component in setup.lab.inventory:
            found.placed += _placement(op.component, op.arguments, end.data)
        meant = events.get((*key, "intent"))
        robot = meant.data.get("robot") if meant else None
        kind = work(setup, op.primitive, op.component, robot, op.arguments)
        anew = op.data.get("stood")  # set right on the way, for which no plan has seconds
        if op.outcome == "done" and kind and op.seconds and op.planned and not anew:
            found.times[kind].append((op.seconds, op.planned))


def _placement(component: str, arguments: Mapping[str, Any], end: Mapping[str, Any]) -> list[Off]:
    """Return how far off a part came to stand when it was put down, each time."""
    goal, after = _pose(arguments.get("to", {}).get("pose")), observed_from_json(end.get("after"))
    if goal is None or after is None or after.pose is None or after.presence != "seen" or after.how not in SEEN:
        return []
    earlier = [pose for data in end.get("data", {}).get("stood", ()) if (pose := _pose(data))]
    return [_off(component, pose, goal, after) for pose in (*earlier, after.pose)]


def _looks(setup: Setup, run: RecordedRun, found: Lessons) -> None:
    """Take in every look at a part that nothing had moved since the look before."""
    meant = {(e.run, e.operation): str(e.data.get("primitive", "")) for e in run.trace if e.kind == "intent"}
    for event in (*run.trace, *(e for e in run.measurements if e.kind == "observation")):
        name, part = event.component or "", _seen(event)
        if name not in setup.lab.inventory or (part is None and event.kind not in ENDS):
            continue
        if event.kind in ENDS and _moves(meant.get((event.run, event.operation), "")):
            found.stood.pop(name, None)
        before = found.stood.get(name)
        if part is None or part.pose is None or part.presence != "seen" or part.how not in LOOKED:
            continue
        if before is not None and part.pose != before:  # the same pose to the last digit is the same look
            found.looked[name].append(_off(name, part.pose, before, part))
        found.stood[name] = part.pose


def _seen(event: TraceEvent) -> ObservedComponent | None:
    data = event.data.get("before") if event.kind == "started" else event.data.get("after")
    try:
        return observed_from_json(event.data if event.kind == "observation" else data)
    except (KeyError, TypeError, ValueError):  # written by another program
        return None


def _moves(name: str) -> bool:
    """Return whether a primitive may move its part."""
    kind = primitive(name)
    return kind.changes in ("pose", "anything") or kind.name == "teleoperate"


def _off(component: str, pose: Pose, goal: Pose, seen: ObservedComponent) -> Off:
    turned = angle_between(goal.yaw, pose.yaw)
    sigma = seen.uncertainty
    return Off(component, pose.x - goal.x, pose.y - goal.y, turned, sigma.position, sigma.yaw)


def _pose(data: Any) -> Pose | None:
    try:
        return Pose(**data)
    except TypeError:
        return None
