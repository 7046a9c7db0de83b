"""What an edge works on: the device of a bench, the setup that it was opened for, and the journal."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.backends.device import Capabilities, Device, LightGuarded
from pico.edge.guard.wiring import BenchWiring
from pico.edge.remembering import Remembering
from pico.model.setup import Setup
from pico.places.bench import BenchPlace

if TYPE_CHECKING:
    from pico.backends.hardware.guard.note import Ended
    from pico.backends.hardware.guard.verdict import Trip
    from pico.model.calibration.results import AxisZero


class Apparatus:
    """The bench at `place`. `opening` opens the device of a setup; `clock` gives the wall time as ISO 8601, UTC;
    `files`: what `setup` was read from, None on trial. How it is wired the folder's files say."""

    def __init__(
        self, setup: Setup, place: BenchPlace, opening: Callable[[Setup], Device], clock: Callable[[], str],
        files: Mapping[str, bytes] | None = None,
    ) -> None:  # fmt: skip
        self.place, self._opening = place, opening
        self._heard: Callable[[Ended, Trip | None], None] | None = None
        self._disarm: Callable[[str], tuple[str, ...]] | None = None
        self.wiring = BenchWiring(place)
        self.setup = self.wiring.wired(setup, files)
        self.device = self._opened(self.setup)
        self.now, self.journals = clock, Remembering(place, clock)
        self._usual: tuple[Setup, Device] | None = None

    def _opened(self, setup: Setup) -> Device:
        device = self._opening(setup)
        if self._heard is not None and isinstance(device, LightGuarded):
            device.listen(self._heard, self._disarm)
        return device

    def listen(self, heard: Callable[[Ended, Trip | None], None], disarm: Callable[[str], tuple[str, ...]]) -> None:
        """Have `heard` called, in any thread, after light was ended beside a run, and `disarm` if armings end with
        it."""
        self._heard, self._disarm = heard, disarm
        if isinstance(self.device, LightGuarded):
            self.device.listen(heard, disarm)

    @property
    def usual(self) -> Setup:
        """The setup of the bench at its own speed, whatever speed a run goes at."""
        return self._usual[0] if self._usual is not None else self.setup

    def calibrated_axes(self) -> Mapping[str, AxisZero]:
        """Return direction and zero of the bench's axes, by the address of the tunable."""
        from pico.vision.calibration_files import accepted_axes

        return accepted_axes(self.place.root, self.place.name)

    @property
    def has_samples(self) -> bool:
        """Whether a part of the bench holds a sample, whose light is counted."""
        return any(part.sample for part in self.setup.lab.inventory.values())

    async def describe(self) -> Capabilities:
        """Return what the device can do, at the speed of the run in progress."""
        from pico.teleop.frames import STEPS

        able = await self.device.describe()
        whole = {"set", "measure"} <= able.primitives
        primitives = able.primitives | ({"optimize", "verify", "survey"} if whole else set())
        if able.primitives >= STEPS:
            primitives = primitives - STEPS | {"teleoperate"}
        return replace(able, primitives=primitives, kept=self.device.kept())

    def become(self, setup: Setup, files: Mapping[str, bytes]) -> None:
        """Work on another bench from now on: the Lab was changed to `files`."""
        setup = self.wiring.wired(setup, files)
        self.setup, self.device = setup, self._opened(setup)

    def go_at(self, speed: float | None) -> None:
        """Have every robot at a share of its joint limits until `go_as_usual`; None: as the lab says."""
        if (setup := self.setup.at_speed(speed)) != self.setup:
            self._usual = self.setup, self.device
            self.setup, self.device = setup, self._opened(setup)

    def go_as_usual(self) -> None:
        """Have the device that was there before `go_at`."""
        if self._usual is not None:
            (self.setup, self.device), self._usual = self._usual, None

    def require_kept(self) -> None:
        """Raise PicoError if a simulated world is gone, and the journal says that it was moved."""
        if not self.device.kept() and self.journals.path.exists():
            from pico.edge.recovery import require_unmoved

            require_unmoved(self.journals.path)
