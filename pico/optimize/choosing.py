"""Which algorithm suits what is asked, where nobody says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from pico.optimize.problem import Aim

CYCLES: Mapping[str, float] = {"polarizer": 180.0, "waveplate": 90.0}
"""After how many degrees the light behind a turned element, and a polarizer, is the same again."""
_RADII = ("d4sigma", "gaussian_fit")


@dataclass(frozen=True)
class Tuned:
    """A tunable as it counts for the choice: the optical element of its component, its name, its period."""

    element: str
    name: str
    period: float | None = None


def choose(tuned: Sequence[Tuned], kernels: Sequence[str], aim: Aim, *, known: bool = False) -> tuple[str, str]:
    """Return the algorithm for an aim, and why. `kernels`: what makes the number of each output, empty for an
    instrument's own; `known`: nominal geometry tells how the tunables move the light."""
    first = tuned[0]
    if len(tuned) == 1 and first.name == "angle" and first.element in CYCLES and aim != "reach":
        return "malus", f"{aim} over the angle of a {first.element}: the law of Malus"
    if len(tuned) == 1 and kernels[0] in _RADII and aim in ("reach", "minimize"):
        return "waist_parabola", "a radius along one way: its square is a parabola"
    if aim == "reach" and len(kernels) >= len(tuned):
        return "centroid_newton", f"{len(kernels)} readings for {len(tuned)} tunables: Newton's method"
    if aim == "maximize" and (known or len(tuned) <= 4):
        walk = "the steering matrix is taken from the layout; only the optimum is fitted"
        climb = "as much of something as can be: a parabola through its logarithm, axis by axis"
        return ("beam_walk", walk) if known else ("peak", climb)
    many = f"{len(tuned)} tunables: conjugate directions"
    return ("nelder_mead", "no model fits: a simplex") if len(tuned) <= 4 else ("rcds", many)


def usual_parameters(algorithm: str, tuned: Sequence[Tuned]) -> Mapping[str, float]:
    """Return the parameters of an algorithm that follow from what is tuned."""
    if algorithm == "malus" and len(tuned) == 1 and tuned[0].element in CYCLES:
        return {"cycle": CYCLES[tuned[0].element]}
    return {}
