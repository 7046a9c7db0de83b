"""What the nominal bench says of a goal before anything is measured: how its tunables move the light that it wants, and
how far off the best is likely to be, by how well the parts on the way are put down."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.model.catalog import Tunable
from pico.model.goal import Goal
from pico.model.observation import Observation, with_value
from pico.model.pose import Pose, angle_between
from pico.model.quantities import convert
from pico.model.setup import Setup
from pico.model.vocabulary import measured_in
from pico.optimize.problem import Nominal
from pico.planning.nominal_arms import nominal_arms, seen_by
from pico.planning.nominal_bench import STEERS, Astray, NominalBench, places

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

MOVES = ("tip", "tilt", "stage_x", "stage_y", "stage_z", "pinhole_y", "pinhole_z")
"""Tunables that move light, or what it is to pass."""
_FLAT, _DEGENERATE = 1e-2, 1e-7
"""By how little the logarithm of the power may fall over the bounds of a tunable for that not to move light aside; and
along a way of several tunables, of the steepest, for them to be one too many."""
_LEFT = {False: 0.3, True: 0.02}
"""What a goal that is met is likely to leave, as later ones upset it a little: of the width over which light falls, or
of what a camera sees where a spot is to be reached."""
_SURE = 5.0
_USUAL = 4.0
"""By how much the logarithm of a power falls until it is dark, where the detector's noise is not known."""
_ROOM = 2.0
"""How far a mirror is searched, as a multiple of three standard deviations of what is likely to be wrong."""
REACH = 5.0
"""How far it is searched at least, and if nothing is known of what may be wrong, unless its trim is larger [mrad]."""
_AIMED = 3
"""How often the nominal beam is brought nearer to where it is wanted; once would do if light were linear."""
_FOLLOWED = 8
"""In how many steps parts are moved in thought from where they are meant to stand, so that no beam gets lost."""


def within_reach(
    setup: Setup, seen: Observation, goal: Goal, former: Sequence[Goal] = (), aim: Mapping[str, float] | None = None
) -> Goal:
    """Return a goal whose mirrors are searched no further than is likely to be wrong, around where they stand and
    around where they are to `aim`: whole ranges send beams to where nothing ends them. If the model cannot tell what is
    likely, that is `REACH`, or the trim of a mirror if that is larger."""
    steered = [a for a in goal.tunables if a.rpartition(".")[2] in STEERS]
    if not steered:
        return goal
    told = nominal(setup, set_to(seen, aim or {}), goal, former)
    bounds = dict(goal.tunables)
    for n, address in enumerate(goal.tunables):
        component, _, tunable = address.partition(".")
        about = (seen.known_values.get(component, {}).get(tunable), (aim or {}).get(address))
        known = [value for value in about if isinstance(value, int | float)]
        if address in steered and known:
            kind, (low, high) = setup.type_of(component).tunables[tunable], bounds[address]
            least = _in_unit(REACH, kind)
            room = max(least, _ROOM * told.reach(n) if told else kind.restore.trim or 0.0)
            bounds[address] = max(low, round(min(known) - room, 3)), min(high, round(max(known) + room, 3))
    return replace(goal, tunables=bounds)


def _in_unit(angle: float, kind: Tunable) -> float:
    """Return an angle [mrad] in the unit of a tunable."""
    return angle if kind.unit in ("", "mrad") else float(convert(f"{angle!r} mrad", kind.unit))


def aimed(setup: Setup, seen: Observation, goal: Goal, meant: Observation) -> dict[str, float]:
    """Return the values of a goal's tunables with which the nominal beam of a bench as seen comes to the middles of
    where it is wanted, within their bounds; nothing where nobody can tell. `meant`: the same bench with its parts where
    they should stand, from where the beam is followed where it gets lost otherwise."""
    for steps in (1, _FOLLOWED):
        found = dict[str, float]()
        try:
            for step in range(steps):
                here = _between(meant, seen, (step + 1) / steps)
                found = _aimed(setup, set_to(here, found), goal)
        except Astray:
            continue
        return found
    return {}


def aimed_in_the_dark(setup: Setup, seen: Observation, goal: Goal) -> dict[str, float]:
    """Return the same if mirrors are turned so far that the beam misses where it is wanted; else nothing."""
    if seen_by(goal) or not any(address.rpartition(".")[2] in STEERS for address in goal.tunables):
        return {}
    try:
        lost = NominalBench(setup, seen, places(setup, seen, goal)).lost
    except Astray:
        return {}
    return aimed(setup, seen, goal, seen) if lost else {}


def _aimed(setup: Setup, seen: Observation, goal: Goal) -> dict[str, float]:
    """Return the same by Newton's method from where the tunables stand; raises Astray."""
    import numpy as np

    found = dict[str, float]()
    for _ in range(_AIMED):
        bench = NominalBench(setup, seen, places(setup, seen, goal))
        moves = np.stack([bench.moved_by(address, bounds) for address, bounds in goal.tunables.items()], axis=1)
        steps = -np.linalg.pinv(moves, rcond=1e-6) @ bench.offsets
        for (address, (low, high)), step in zip(goal.tunables.items(), steps.tolist(), strict=True):
            found[address] = min(high, max(low, bench.value(address) + step))
        seen = set_to(seen, found)
    return found


def _between(meant: Observation, seen: Observation, share: float) -> Observation:
    """Return a bench whose parts stand a share of the way from where they are meant to where they are seen."""
    parts = dict(seen.components)
    for name, part in seen.components.items():
        was, now = meant.components[name].pose if name in meant.components else None, part.pose
        if was is not None and now is not None and was != now:
            turn = share * angle_between(was.yaw, now.yaw)
            pose = Pose(was.x + share * (now.x - was.x), was.y + share * (now.y - was.y), was.yaw + turn)
            parts[name] = replace(part, pose=pose)
    return replace(seen, components=parts)


def set_to(seen: Observation, values: Mapping[str, float]) -> Observation:
    """Return a bench whose tunables are set to values, by address."""
    for address, value in values.items():
        component, _, tunable = address.partition(".")
        seen = with_value(seen, component, tunable, value)
    return seen


def nominal(setup: Setup, seen: Observation, goal: Goal, former: Sequence[Goal] = ()) -> Nominal | None:
    """Return what is known of a goal on the bench as seen, its parts where they are thought to stand; None where the
    beam does not come to where it is wanted, or a tunable does not move it there. `former`: goals that will have been
    met before it, by which the beam is where they want it."""
    try:
        if seen_by(goal):
            return nominal_arms(setup, seen, goal)
        if any(address.rpartition(".")[2] not in MOVES for address in goal.tunables):
            return None
        return _nominal(setup, seen, goal, former)
    except Astray:
        return None


def _nominal(setup: Setup, seen: Observation, goal: Goal, former: Sequence[Goal]) -> Nominal:
    """Return the same; raises Astray where it is not known."""
    import numpy as np

    ends = [(place, one) for one in (goal, *former) for place in places(setup, seen, one)]
    bench = NominalBench(setup, seen, [place for place, _ in ends])
    falls = bench.falling()
    own = [fall for fall, (_, of) in zip(falls, ends, strict=True) if of is goal]
    many = sum(len(fall.shape) for fall in own)
    tuned = {address: bounds for one in (goal, *former) for address, bounds in one.tunables.items()}
    moves = np.stack([bench.moved_by(address, bounds) for address, bounds in tuned.items()], axis=1)
    scatter = bench.scattered()
    if former:
        rests = [_LEFT[of.aim == "reach"] ** 2 * np.linalg.inv(fall.shape)
                 for fall, (_, of) in zip(falls, ends, strict=True) if of is not goal]  # fmt: skip
        scatter = _met(scatter, moves, many, rests)
    shape, move = _joined([fall.shape for fall in own]), moves[:many, : len(goal.tunables)]
    fall, spread, shift, flat = _across(goal, shape, move, scatter[:many])
    for n in np.flatnonzero(flat):
        fall[n, n], shift[n], spread[n, n] = bench.along(*list(goal.tunables.items())[n], len(own))
    depth = 1.0 if goal.aim == "reach" else _depth(setup, goal, min(one.power for one in own))
    slopes = bench.slopes([*(goal.reach or {})], goal.tunables)
    return Nominal(_rows(fall), _rows(spread), depth, tuple(shift.tolist()) if flat.any() else (), _rows(slopes))


def _across(goal: Goal, shape: Array, move: Array, scatter: Array) -> tuple[Array, Array, Array, NDArray[np.bool_]]:
    """Return how the power falls with the tunables that move light aside, how its best scatters, where its middle is,
    and which tunables do not move it aside: their rows are 0."""
    import numpy as np

    fall = move.T @ shape @ move
    spans = np.array([high - low for low, high in goal.tunables.values()])
    flat = np.diag(fall) * spans**2 <= _FLAT
    inner = np.ix_(~flat, ~flat)
    steep = np.linalg.eigvalsh(fall[inner]) if np.isfinite(fall).all() and not flat.all() else np.zeros(1)
    if steep[0] <= _DEGENERATE * steep[-1]:
        raise Astray
    fall[flat], fall[:, flat] = 0.0, 0.0
    off = np.zeros((len(fall), scatter.shape[1]))
    off[~flat] = np.linalg.solve(fall[inner], move[:, ~flat].T @ shape @ scatter)
    return fall, off @ off.T, np.zeros(len(fall)), flat


def _met(scatter: Array, moves: Array, many: int, rests: Sequence[NDArray[np.floating]]) -> Array:
    """Return by how much the first `many` offsets scatter once all others have been brought to nothing by what moves
    them, but for rests, whose covariances at each place are known."""
    import numpy as np

    ways = moves[:many] @ np.linalg.pinv(moves[many:], rcond=1e-6)
    return np.concatenate([scatter[:many] - ways @ scatter[many:], ways @ np.linalg.cholesky(_joined(rests))], axis=1)


def _joined(shapes: Sequence[NDArray[np.floating]]) -> Array:
    """Return matrices as the blocks of one."""
    import numpy as np

    size, at = sum(len(one) for one in shapes), 0
    whole = np.zeros((size, size))
    for one in shapes:
        whole[at : at + len(one), at : at + len(one)] = one
        at += len(one)
    return whole


def _rows(matrix: Array) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(float(f"{x:.6g}") for x in row) for row in matrix.tolist())


def _depth(setup: Setup, goal: Goal, power: float) -> float:
    """Return by how much the logarithm of a power may fall until it is dark: to five standard deviations of a meter."""
    of = measured_in(setup, goal.texts)
    least = setup.type_of(of[0][0]).number("least_power", "mW") if len(of) == 1 and not goal.looks else None
    return max(1.0, math.log(power / (_SURE * least))) if least and power > 0 else _USUAL
