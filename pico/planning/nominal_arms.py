"""What the nominal bench says of fringes before anything is measured: over which range of what makes an arm longer they
are seen, and where both arms are likely to be as long, by how well the parts in them are put down."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from pico.model.goal import Goal
from pico.model.observation import Observation
from pico.model.setup import Setup
from pico.optimize.problem import Nominal
from pico.planning.nominal_bench import Astray, NominalBench

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.optics.light import Light
    from pico.optics.nominal.arms import Meeting

VISIBILITY = ".fringes.visibility"
"""How the visibility of fringes is called behind the name of a camera."""
CLEAR = 0.05
"""A visibility that no noise has, though the kernel sees less."""
_LEAST_MOVED = 1e-7
"""How much longer an arm gets by a unit of what makes it so, at least [mm]."""


class _Arms(NominalBench):
    """A bench whose `offsets` are by how much one arm is longer than the other [mm], where they meet on a camera."""

    def __init__(self, setup: Setup, seen: Observation, camera: str) -> None:
        self.camera = camera
        super().__init__(setup, seen, ())

    def _offsets(self, light: Light) -> NDArray[np.float64]:
        import numpy as np

        return np.array([self._met(light).delay])

    def _met(self, light: Light) -> Meeting:
        from pico.optics.nominal.arms import meeting

        if (found := meeting(light, self.camera)) is None:
            raise Astray
        return found

    @property
    def meeting(self) -> Meeting:
        """How the two beams meet."""
        return self._met(self.light)


def seen_by(goal: Goal) -> str:
    """Return the camera whose fringes a goal makes as clear as can be; empty where it wants something else."""
    wanted = (goal.maximize or "").strip()
    camera = wanted.removesuffix(VISIBILITY)
    return camera if camera != wanted and camera.isidentifier() and not goal.looks else ""


def met(setup: Setup, seen: Observation, camera: str) -> Meeting | None:
    """Return how the beams of two arms nominally meet on a camera; None where not two of one source do."""
    try:
        return _Arms(setup, seen, camera).meeting
    except Astray:
        return None


def nominal_arms(setup: Setup, seen: Observation, goal: Goal) -> Nominal:
    """Return what is known of a goal of clear fringes: the logarithm of their visibility falls by 1 over the length
    over which the light is coherent. Raises Astray where two beams do not meet, are coherent at any length, or are not
    made longer by the one tunable."""
    bench = _Arms(setup, seen, seen_by(goal))
    there, (address, bounds) = bench.meeting, next(iter(goal.tunables.items()))
    per = float(bench.moved_by(address, bounds)[0])
    least = goal.least if goal.least is not None and goal.signal == goal.maximize else CLEAR
    depth = math.log(there.contrast / least) if there.contrast > 0 else 0.0
    if len(goal.tunables) != 1 or abs(per) < _LEAST_MOVED or not math.isfinite(there.length) or depth <= 0:
        raise Astray
    spread = float((bench.scattered()[0] ** 2).sum())
    return Nominal((((per / there.length) ** 2,),), ((spread / per**2,),), depth, (-there.delay / per,))
