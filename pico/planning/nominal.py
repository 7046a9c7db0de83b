"""What the nominal bench says of a goal before anything is measured: how its tunables move the light that it wants, and
how far off the best is likely to be, by how well the parts on the way are put down."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from pico.model.lab import Goal, Setup
from pico.model.observation import Observation
from pico.model.vocabulary import measured_in
from pico.optimize.problem import Nominal
from pico.planning.nominal_bench import Astray, NominalBench, places

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


def nominal(setup: Setup, seen: Observation, goal: Goal, former: Sequence[Goal] = ()) -> Nominal | None:
    """Return what is known of a goal on the bench as seen, its parts where they are thought to stand; None where the
    beam does not come to where it is wanted, or a tunable does not move it there. `former`: goals that will have been
    met before it, by which the beam is where they want it."""
    if any(address.rpartition(".")[2] not in MOVES for address in goal.tunables):
        return None
    try:
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
    return Nominal(_rows(fall), _rows(spread), depth, tuple(shift.tolist()) if flat.any() else ())


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
