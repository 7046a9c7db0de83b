"""A person at the emulated bench: holds the calibration board up about where it is asked for, and reads scales about as
well as people do."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from pico.backends.emulated.world import EmulatedWorld
from pico.diagnostics import PicoError, error

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.vision.charuco import Board

    Array = NDArray[np.float64]

PLACED = 15.0
"""How far from where it is asked for the board is held [mm], one standard deviation each way."""
LEANT = 0.06
"""How much it leans otherwise than it is asked to [rad], one standard deviation each way."""
READS = 0.2
"""How well a scale is read [deg], one standard deviation before rounding."""
STEP = 0.5
"""To how much a scale is read [deg]."""


class SimulatedHands:
    """Hands at the table of `world`; the same `seed` and the same requests give the same."""

    step = STEP

    def __init__(self, world: EmulatedWorld, seed: int) -> None:
        import numpy as np

        self._world, self._random = world, np.random.default_rng((seed, 17))

    def show(self, pose: Array, board: Board, text: str) -> bool:
        """Hold the board up at about `pose` (4, 4) [mm], and return True."""
        import numpy as np

        from pico.cameras.board import board_sheet
        from pico.vision.rigid import moved

        sigmas = np.repeat((PLACED, LEANT), 3)
        self._world.shown = board_sheet(moved(pose, self._random.normal(0.0, sigmas)), board)
        return True

    def away(self) -> None:
        """Put the board away."""
        self._world.shown = self._world.in_hand = None

    def give(self, robot: str, board: Board, text: str) -> bool:
        """Hold the block behind the board between the fingers of a robot, and return True."""
        import numpy as np

        from pico.cameras.board import board_sheet
        from pico.motion.built.fitting import SLACK, grip
        from pico.vision.rigid import moved

        sigmas = np.repeat((SLACK[0], math.radians(SLACK[1])), 3)
        askew = moved(np.eye(4), self._random.normal(0.0, sigmas))
        self._world.in_hand = robot, board_sheet(askew @ grip(), board)
        return True

    def lay(self, pose: Array, board: Board, text: str) -> bool:
        """Lay the board on the table at about `pose` (4, 4) [mm], and return True."""
        import numpy as np

        from pico.cameras.board import board_sheet
        from pico.vision.rigid import moved

        x, y, _, _, _, turn = self._random.normal(0.0, np.repeat((PLACED, LEANT), 3))
        self._world.shown = board_sheet(moved(pose, np.array((x, y, 0.0, 0.0, 0.0, turn))), board)
        return True

    def read(self, address: str, unit: str, text: str) -> float:
        """Return what the scale of an axis shows; raises PicoError if nobody can read it."""
        component, _, tunable = address.partition(".")
        value = self._world.value(component, tunable)
        if not isinstance(value, int | float) or isinstance(value, bool):
            raise PicoError(error("unread", f"the scale of {address} can't be read", address=address))
        seen = value + float(self._random.normal(0.0, READS))
        return math.floor(seen / STEP + 0.5) * STEP
