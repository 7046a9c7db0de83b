"""A part without a stage is brought to the light by the arm: put down, measured, put down again, until it is near.

Each try is a plan of its own, checked as any, with the shutter closed while the arm works. What an arm puts down does
not stand quite where it was sent; by how much a camera tells better than the eyes over the table. So the next place
is the mean of what each try says, and a try that is near enough is left as it is, for no other one would be the same.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from pico.bench.opened import Opened
from pico.bench.plans import Plans
from pico.diagnostics import PicoError, error
from pico.model.observation import live_state
from pico.model.pose import Pose
from pico.model.setup import EXPOSURE
from pico.model.state import place_of

if TYPE_CHECKING:
    from pico.model.measurement import Measurement
    from pico.model.observation import Observation
    from pico.model.plan import Plan
    from pico.model.setup import Setup
    from pico.model.trace.event import Event
    from pico.model.trace.report import RunReport

NEAR, MOST, REACH = 0.1, 12, 1.0
"""How near to where the spot is in the middle is near enough, measured as the part's own way [mm]; how often it is put
down at most; how far from where it is to stand it may be sent [mm]."""
_STEP = 0.2
"""By how much the part is moved in the nominal ray model, to find how far its spot then goes [mm]."""
_LEAST = 0.1
"""The least that a spot must move, for one of the part's way, to say where it stands."""
_INSIDE = 0.9
"""The share of NEAR within which it is left: the model of the light is not better than that."""


@dataclass(frozen=True)
class Try:
    """Where the arm was sent, from where the part is to stand [mm, to its left] (None: it stood there before); by how
    much it then stood off, by the light [mm], None where that was not seen, and `why`; the `run` that sent it."""

    sent: float | None
    off: float | None
    why: str = ""
    run: str = ""


@dataclass(frozen=True)
class Placed:
    """What became of it: `met`, else `why` not; the tries in order, the first as it stood; `slope`: by how many mm the
    spot moves for one of the part; the pose from which it began."""

    component: str
    detector: str
    met: bool
    why: str
    tries: tuple[Try, ...]
    slope: float
    first: Pose
    near: float = NEAR


class Placing:
    """Parts on one bench that the arm centres on the light."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened

    def plan(self, component: str, across: float = 0.0) -> Plan:
        """Return the plan that puts a part down `across` [mm] to its left of where it is to stand."""
        goal = shifted(self._nominal(component), across)
        words = {"x": f"{goal.x:.4f}", "y": f"{goal.y:.4f}", "yaw": f"{goal.yaw:.4f}"}
        return Plans(self.opened).single(component, "move", words)

    def center(
        self, component: str, detector: str, *, most: int = MOST, near: float = NEAR,
        show: Callable[[Event], None] = lambda _: None, say: Callable[[str], None] = lambda _: None,
        tell: Callable[[Try], None] = lambda _: None,
    ) -> Placed:  # fmt: skip
        """Put a part down by the arm until its spot is in the middle of a camera, across the table, within `near` [mm]
        of the part's way, `most` times at most. Raises PicoError where the arm may not move it, or its light tells
        nothing. `tell` hears of each try; a signal ends it after the try that goes on."""
        opened, seen = self.opened, self.opened.observe()
        self._require(component, detector)
        slope = slope_of(opened.setup, seen, component, detector)
        pose = seen.components[component].pose
        assert pose is not None  # it was moved in the ray model
        before = seen.components[detector].values.get(EXPOSURE)
        tries, why = [self._measured(detector, slope, None, show, say)], ""
        tell(tries[0])
        while not (why := _over(tries, near, most)):
            sent = next_place(tries, across(self._nominal(component), pose))
            report, came = self._run(self.plan(component, sent), show, say)
            if came or report.outcome != "done":
                why = "it was stopped" if came else f"{component} could not be put down: run {report.run}"
                break
            tries.append(replace(self._measured(detector, slope, sent, show, say), run=report.run))
            tell(tries[-1])
        self._expose(detector, before.value if before else None)
        return Placed(component, detector, why == MET, why, tuple(tries), slope, pose, near)

    def _nominal(self, component: str) -> Pose:
        """Return where the manifest wants a part, where it stands near there; else where it stands."""
        seen, setup = self.opened.observe(), self.opened.setup
        pose = seen.components[component].pose
        assert pose is not None
        wanted = place_of(setup, self.opened.state, component)[1]
        return wanted if wanted.distance(pose) <= REACH else pose

    def _require(self, component: str, detector: str) -> None:
        setup = self.opened.setup
        if component not in setup.lab.inventory or not setup.movable(component):
            raise PicoError(
                error("goal", f"no arm may move `{component[:40]}`", hint="`pico catalog parts` lists parts")
            )
        if detector not in setup.lab.inventory or "centroid" not in setup.measurables_of(detector):
            raise PicoError(error("goal", f"`{detector[:40]}` does not measure a centroid", hint="a camera does"))

    def _measured(
        self, detector: str, slope: float, sent: float | None, show: Callable[[Event], None],
        say: Callable[[str], None],
    ) -> Try:  # fmt: skip
        found = self._taken(detector, show, say)
        if found is not None and "not saturated" in found.not_assured and self.opened.setup.ranges(detector):
            suited, _ = self._run(Plans(self.opened).single(detector, "auto_range", {"tunable": EXPOSURE}), show, say)
            found = self._taken(detector, show, say)
            if wrong := next((d for d in suited.diagnostics if d.severity == "error"), None):
                return Try(sent, None, f"{wrong.summary}: {wrong.hint}" if wrong.hint else wrong.summary)
        if found is None or not isinstance(found.value, dict):
            return Try(sent, None, (found.unknown if found else None) or f"{detector} was not measured")
        return Try(sent, float(found.value["x"]) * 1e-3 / slope)

    def _taken(
        self, detector: str, show: Callable[[Event], None], say: Callable[[str], None]
    ) -> Measurement | None:  # fmt: skip
        plan = Plans(self.opened).single(detector, "measure", {"measurable": "centroid"})
        report, _ = self._run(plan, show, say)
        return report.measurements.get(f"{detector}.centroid")

    def _expose(self, detector: str, before: object) -> None:
        live = self.opened.observe().components[detector].values.get(EXPOSURE)
        if before is not None and live is not None and live.value != before:
            self._run(
                Plans(self.opened).single(detector, "set", {EXPOSURE: str(before)}), lambda _: None, lambda _: None
            )

    def _run(
        self, plan: Plan, show: Callable[[Event], None], say: Callable[[str], None]
    ) -> tuple[RunReport, tuple[int, ...]]:
        from pico.bench.moves import Moves
        from pico.bench.running.attending import attend

        if plan.errored:
            raise PicoError([d for d in plan.diagnostics if d.severity == "error"])
        run = Moves(self.opened).run(plan, holder="pico optimize")
        came = attend(run, show, say)
        return run.report, came


MET = "it is near enough"


def _over(tries: Sequence[Try], near: float, most: int) -> str:
    """Return why nothing more is tried, empty while something is."""
    last = tries[-1]
    if last.off is not None and abs(last.off) <= _INSIDE * near:
        return MET
    if last.off is None and all(t.off is None for t in tries[-2:]):
        return last.why
    return f"it was put down {most} times" if len(tries) > most else ""


def next_place(tries: Sequence[Try], first: float) -> float:
    """Return where the arm is to be sent next: the mean of what each try says, the first one, of which nobody knows
    where it was sent, only where there is no other; `first`: where it was seen to stand then."""
    known = [t.sent - t.off for t in tries if t.off is not None and t.sent is not None]
    if not known:
        known = [first - t.off for t in tries if t.off is not None] or [0.0]
    return max(-REACH, min(REACH, sum(known) / len(known)))


def shifted(pose: Pose, left: float) -> Pose:
    """Return a pose so far to its own left [mm]."""
    turned = math.radians(pose.yaw)
    return Pose(pose.x - left * math.sin(turned), pose.y + left * math.cos(turned), pose.yaw)


def across(pose: Pose, other: Pose) -> float:
    """Return how far another pose is to the left of one [mm]."""
    turned = math.radians(pose.yaw)
    return (other.y - pose.y) * math.cos(turned) - (other.x - pose.x) * math.sin(turned)


def slope_of(setup: Setup, seen: Observation, component: str, detector: str) -> float:
    """Return by how much the light on a detector moves to the left for a part that does, by the nominal ray model from
    where things are seen to stand; raises PicoError where no light comes there, or hardly moves."""
    from pico.optics.light import light_of

    live = live_state(setup, seen)
    poses = {n: p.pose for n, p in seen.components.items() if p.pose and p.presence == "seen" and n in live.components}
    if component not in poses or detector not in poses:
        raise PicoError(error("missing", f"{component} and {detector} must stand on the table"))

    def middle(left: float) -> float:
        moved = {**poses, component: shifted(poses[component], left)}
        found = light_of(setup, moved, seen.known_values, lit=lambda _: True).at(detector)
        power = sum(a.power for a in found)
        if power <= 0:
            _require_standing(setup, seen, component, detector)
            text = f"by the plan of the bench no light comes to {detector}"
            raise PicoError(error("dark", text, hint="`pico beam` shows where it goes", address=detector))
        return float(sum(a.power * a.center[0] for a in found) / power)

    slope = (middle(_STEP) - middle(-_STEP)) / (2 * _STEP)
    if abs(slope) < _LEAST:
        _require_standing(setup, seen, component, detector)
        text = f"the light on {detector} hardly moves with {component}: {slope:.2g} mm for 1 mm"
        raise PicoError(error("goal", text, hint="another detector", address=component))
    return slope


def _require_standing(setup: Setup, seen: Observation, component: str, detector: str) -> None:
    """Raise PicoError if one of the two is in a slot, where it is out of the light."""
    from pico.planning.darkness import gone

    for name in (component, detector):
        if why := gone(setup, seen, name):
            hint = f"bring it there first: `pico move {name} x=... y=...`, or `pico apply` of a state with it"
            raise PicoError(error("goal", f"{why}, and the light does not come through it", hint=hint, address=name))
