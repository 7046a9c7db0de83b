"""What the steps of a calibration stand on: the bench, the person at its table, and what was found so far."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from pico.backends.hardware.device import HardwareDevice
from pico.bench.calibrating.progress import Progress, write_progress
from pico.diagnostics import Diagnostic, PicoError, error
from pico.edge.local import LocalEdge
from pico.model.calibration.results import ACCEPTED, Evidence, Provenance
from pico.vision.charuco import BOARD, Board

if TYPE_CHECKING:
    from collections.abc import Coroutine
    from typing import Any, TypeVar

    import numpy as np
    from numpy.typing import NDArray

    T = TypeVar("T")
    Array = NDArray[np.float64]

SHOTS = 20
"""Pictures of the board that are taken by each camera, unless somebody says how many."""


class Hands(Protocol):
    """Who is at the table: a person who is asked at the terminal, or one of the emulated world."""

    @property
    def step(self) -> float:
        """To how much scales are read, in the unit of the tunable."""
        ...

    def show(self, pose: Array, board: Board, text: str) -> bool:
        """Hold the board at about `pose` (4, 4) [mm], as `text` says, and return whether it is held there now."""
        ...

    def away(self) -> None:
        """Take the board away."""
        ...

    def give(self, robot: str, board: Board, text: str) -> bool:
        """Hold the block behind the board between the fingers of a robot, as `text` says, and return whether it is."""
        ...

    def lay(self, pose: Array, board: Board, text: str) -> bool:
        """Lay the board on the table at about `pose` (4, 4) [mm], as `text` says, and return whether it lies there."""
        ...

    def read(self, address: str, unit: str, text: str) -> float:
        """Return what the scale of an axis shows, in `unit`. Raises PicoError if nobody reads it."""
        ...


class Asking(Protocol):
    """The person who calibrates the bench."""

    def say(self, text: str) -> None:
        """Tell what goes on, or what is to be done now."""
        ...

    def confirm(self, question: str, *, by_person: bool = False) -> bool:
        """Ask, and return whether the answer is yes; `by_person`: on a real bench `--yes` does not answer. Raises
        PicoError if nobody can be asked."""
        ...


@dataclass(eq=False)
class AtTable:
    """A bench that is calibrated."""

    edge: LocalEdge
    device: HardwareDevice
    asks: Asking
    hands: Hands
    wait: Callable[[Coroutine[Any, Any, Any]], Any]
    """Waits for what the edge or the device does."""
    progress: Progress
    pictures: Path
    """The folder in which a picture of each step is written."""
    by: str
    """The person who calibrates."""
    board: Board = BOARD
    shots: int = SHOTS

    def keep(self, progress: Progress) -> None:
        """Keep what was found so far, over the end of this process; raises PicoError."""
        write_progress(self.device.place, progress)
        self.progress = progress

    @property
    def evidence(self) -> Evidence:
        """The evidence of what is found here."""
        return ACCEPTED[self.device.bench]

    def provenance(
        self, procedure: str, devices: tuple[str, ...], *, residual: float, held_out: float | None, unit: str,
        uncertainty: Mapping[str, float],
    ) -> Provenance:  # fmt: skip
        """Return how a result came about that was found now by reading `devices`."""
        connected = self.device.links.connected
        who = connected.who if connected is not None else {}
        serials = {name: who[name].serial for name in devices if name in who and who[name].serial}
        return Provenance(
            bench=self.device.bench, evidence=self.evidence, serials=serials, at=self.edge.now(), by=self.by,
            procedure=procedure, residual=residual, held_out=held_out, unit=unit, uncertainty=uncertainty,
        )  # fmt: skip

    def devices_of(self, name: str) -> tuple[str, ...]:
        """Return the devices of a component, robot or camera."""
        return tuple(d for d, entry in self.device.links.entries.items() if (entry.of or d) == name)

    def require_dark(self, doing: str) -> None:
        """Raise PicoError unless every laser is known to be dark."""
        if self.device.may_emit():
            text = f"a laser may emit, and {doing} needs the table dark"
            raise PicoError(
                error("light", text, hint="close its shutter or switch it off (`pico laser disarm`); then go on")
            )


class Stopped(PicoError):
    """Somebody said no: what was found before is kept."""

    def __init__(self) -> None:
        text = "the calibration was left off; what was found so far is kept"
        super().__init__(Diagnostic("error", "declined", text, hint="call it again to go on"))
