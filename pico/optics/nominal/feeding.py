"""What was seen of how parts were put down, made up for by the tunables of a goal before light is asked: feed-forward.

Where the goal was met before, hidden errors cancel: the nominal model is asked only for the difference to that bench.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pico.model.goal import Goal
from pico.model.observation import Observation
from pico.model.pose import Pose, angle_between
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.model.vocabulary import measured_in
from pico.optics.nominal.bench import TOLD, Array, Nominal

STEERS = ("tip", "tilt", "stage_x", "stage_y", "stage_z")
"""Tunables that send light elsewhere; others, such as an angle, make up for no displacement."""
SURE = 3.0
"""How many standard deviations of what was seen a part must be displaced by to count as put down otherwise."""
FAR = 2.0
"""How far off a part may stand to be the same bench still, in tolerances of its pose."""
_STEPS, _DONE = 5, 1e-4
Limits = Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class Right:
    """A bench with the light that a goal is to have: where parts stood and what tunables were set to. `met`: the goal
    was met there; else it is so as somebody wrote it down. `tuned`: nothing but light says where the tunables belong,
    so they are brought to where they were even where all parts stand as they stood."""

    state: LabState
    met: bool
    tuned: bool = False


def fed_forward(setup: Setup, seen: Observation, goal: Goal, right: Right, limits: Limits) -> dict[str, float] | None:
    """Return the values of a goal's tunables, within `limits`, that make up for how parts are `seen` to stand otherwise
    than where light was `right`: those that are to be set. Light then comes where it came when the goal was met; where
    it never was, to what it is to reach.

    Empty where parts stand as they stood, but for what the goal tolerates and for what cannot be seen. None where the
    model cannot tell: no light comes there, another bench stands there, nothing that is tuned steers.
    """
    before, now = _then(setup, right.state), _now(setup, seen, right.state)
    steering = [address for address in goal.tunables if address.partition(".")[2] in STEERS]
    numbers = _numbers(setup, goal, len(steering))
    if not steering or not numbers:
        return None
    start = {address: _value(before, address, limits) for address in steering}
    then = _with(now, start)
    was, found = before.numbers(numbers), then.numbers(numbers)
    if was is None or found is None or not _same(setup, before, then if right.tuned else now, numbers):
        return None
    near = np.array([goal.near(number) for number in numbers])
    if bool((np.abs(found - was) <= near).all()):
        return {a: value for a, value in start.items() if right.tuned and _differs(setup, now, a, value)}
    reach = goal.reach or {}
    wanted = was if right.met or not reach.keys() >= set(numbers) else np.array([reach[n] for n in numbers])
    solved = _solved(now, numbers, wanted, start, limits)
    return {address: value for address, value in solved.items() if _differs(setup, now, address, value)}


def _numbers(setup: Setup, goal: Goal, steering: int) -> tuple[str, ...]:
    """Return the numbers by which it is told that light comes where it came: those that the goal reaches, else where it
    meets the detectors, and from where, as far as there are tunables for both."""
    if goal.reach and all(number.partition(".")[2] in TOLD for number in goal.reach):
        return tuple(goal.reach)
    measured = measured_in(setup, goal.texts)
    if any("visibility" in (setup.measurables_of(part)[name].kernel or "") for part, name in measured):
        return ()  # of fringes: where spots are says nothing of how long arms are
    parts = dict.fromkeys(component for component, _ in measured)
    told = ("spot.left", "spot.up", "way.left", "way.up")[: 4 if steering > 2 else 2]
    return tuple(f"{part}.{number}" for part in parts for number in told)


def _then(setup: Setup, then: LabState) -> Nominal:
    poses = {name: place_of(setup, then, name)[1] for name in setup.lab.inventory}
    return Nominal(setup, poses, {name: part.values for name, part in then.components.items()})


def _now(setup: Setup, seen: Observation, then: LabState) -> Nominal:
    """Return the bench as seen; what is displaced by no more than can be seen stands where it stood."""
    poses: dict[str, Pose] = {}
    for name, part in seen.components.items():
        if name in setup.lab.inventory and part.presence == "seen" and part.pose is not None:
            old, sigma = place_of(setup, then, name)[1], part.uncertainty
            still = part.pose.distance(old) <= SURE * sigma.position
            still = still and abs(angle_between(part.pose.yaw, old.yaw)) <= SURE * sigma.yaw
            poses[name] = old if still else part.pose
    return Nominal(setup, poses, seen.known_values)


def _same(setup: Setup, before: Nominal, now: Nominal, numbers: Sequence[str]) -> bool:
    """Whether light meets the same parts, each about where it stood."""
    way = before.on_the_way(numbers)
    if way != now.on_the_way(numbers):
        return False
    for name in way:
        if name in before.poses:
            old, new, near = before.poses[name], now.poses[name], setup.type_of(name).pose.tolerance
            turned = abs(angle_between(old.yaw, new.yaw))
            if old.distance(new) > FAR * near.position or turned > FAR * near.yaw:
                return False
    return True


def _value(bench: Nominal, address: str, limits: Limits) -> float:
    component, _, tunable = address.partition(".")
    low, high = limits[address]
    return min(high, max(low, float(bench.values.get(component, {}).get(tunable, 0.0))))


def _solved(
    now: Nominal, numbers: Sequence[str], wanted: Array, start: Mapping[str, float], limits: Limits
) -> dict[str, float]:
    """Return values by Newton's method on the model, each step the least one in shares of the limits."""
    point = dict(start)
    span = np.array([limits[address][1] - limits[address][0] for address in point])
    for _ in range(_STEPS):
        bench = _with(now, point)
        found = bench.numbers(numbers)
        columns = [bench.by_tunable(numbers, address) for address in point]
        if found is None or any(column is None for column in columns):
            break
        jacobian = np.array(columns).T * span
        weight = 1 / np.maximum(np.abs(jacobian).max(axis=1), 1e-12)
        step = np.linalg.lstsq(jacobian * weight[:, None], (wanted - found) * weight, rcond=1e-3)[0] * span
        for (address, value), by in zip(dict(point).items(), step, strict=True):
            point[address] = min(limits[address][1], max(limits[address][0], value + float(by)))
        if bool((np.abs(step) <= _DONE * span).all()):
            break
    return point


def _with(bench: Nominal, point: Mapping[str, float]) -> Nominal:
    values = {name: dict(own) for name, own in bench.values.items()}
    for address, value in point.items():
        component, _, tunable = address.partition(".")
        values.setdefault(component, {})[tunable] = value
    return replace(bench, values=values)


def _differs(setup: Setup, now: Nominal, address: str, value: float) -> bool:
    component, _, tunable = address.partition(".")
    kind, live = setup.type_of(component).tunables[tunable], now.values.get(component, {}).get(tunable)
    return not isinstance(live, int | float) or abs(live - value) > max(kind.tolerance, kind.resolution)
