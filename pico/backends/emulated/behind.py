"""What is behind each emulated device of a bench: the part of the world that it moves or looks at."""

from __future__ import annotations

import threading
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeGuard

from pico.backends.attempt import Failed
from pico.backends.emulated.world import EmulatedWorld
from pico.backends.sim.readings import Table, measurer_of
from pico.diagnostics import PicoError
from pico.drivers.zaber_gantry import AXES, SCALE
from pico.model.calibration.results import AxisZero
from pico.model.instruments.conversion import Conversion
from pico.model.instruments.conversions import conversion_of
from pico.model.instruments.declaration import Declaration
from pico.model.instruments.kind import value_at
from pico.model.instruments.mapping import mapped
from pico.model.quantities import Value, convert
from pico.model.simulated import DeviceError
from pico.model.wiring import DeviceEntry
from pico.motion.types import Joints

if TYPE_CHECKING:
    from pico.backends.sim.sight import Posed
    from pico.backends.sim.world import World
    from pico.cameras.board import Sheet


HIGHEST = 1000.0
"""How high the hand of an emulated gantry rises [mm]."""


class OfArm:
    """An arm with its hand: joints as its motors have them [rad], fingers [mm]."""

    def __init__(self, world: EmulatedWorld, robot: str) -> None:
        self._world, self._robot = world, robot
        self._own: dict[str, Any] = {}

    def now(self) -> float:
        return self._world.now()

    def read(self, what: str) -> Any:
        """`joints` and `width` now; `faults` that it keeps; `pace`; `fingers`, `moved` and `way`: what the
        emulator calls, see `XArmEmulator`."""
        if what == "joints":
            return self._world.motors(self._robot)
        if what == "width":
            return self._world.width(self._robot)
        if what == "faults":
            return self._world.recalled(self._robot, what)
        given = {"pace": self._world.pace, "fingers": self._fingers, "moved": self._moved, "way": self._way}
        return given.get(what, self._own.get(what))

    def write(self, what: str, value: Any) -> None:
        """Keep what the emulator says of itself; `faults` as a control box with power does, over a loss of its link."""
        if what == "faults":
            self._world.remember(self._robot, what, value)
        self._own[what] = value

    def _fingers(self, joints: Joints, wanted: float, now: float) -> float:
        return self._world.fingers(self._robot, self._world.nominal(self._robot, joints), wanted, now)

    def _moved(self, joints: Joints, seconds: float) -> int:
        self._world.moved(self._robot, self._world.nominal(self._robot, joints))
        return 0

    def _way(self, before: Joints, after: Joints) -> tuple[float, int]:
        """Which share of a step the arm can move, with the load that was set, and the error of what ends it."""
        begin, end = (self._world.nominal(self._robot, joints) for joints in (before, after))
        return self._world.way(self._robot, begin, end, self._own["emulator"].box.settings.load[0])


class OfGantry:
    """A gantry of stages, or its hand: of each of its axes `position` [mm, deg], `travel` and `homed`, by names such as
    `x position`; `holds`: whether something is in its hand."""

    def __init__(self, world: EmulatedWorld, robot: str) -> None:
        self._world, self._robot = world, robot

    def now(self) -> float:
        return self._world.now()

    def read(self, what: str) -> Any:
        """What a stage or the hand finds."""
        if what == "holds":
            return self._world.holding(self._robot) is not None
        axis, _, prop = what.partition(" ")
        if axis not in AXES:
            return None
        joint = AXES.index(axis)
        if prop == "position":
            return self._world.joints(self._robot)[joint] * SCALE[joint]
        if prop == "travel":
            lab = self._world.setup.lab
            return ((0.0, lab.table.size[0]), (0.0, lab.table.size[1]), (0.0, HIGHEST), (-360.0, 360.0))[joint]
        return self._world.recalled(self._robot, f"{axis} unhomed") is None if prop == "homed" else None

    def write(self, what: str, value: Any) -> None:
        """Let a stage be at a position, or the hand hold or let go."""
        if what == "holds":
            self._world.hold(self._robot, bool(value))
            return
        axis, _, prop = what.partition(" ")
        if prop == "position":
            self._world.drive(self._robot, AXES.index(axis), value / SCALE[AXES.index(axis)])
        elif prop == "homed":
            self._world.remember(self._robot, f"{axis} unhomed", "" if value else "it had no power")


class OfPart:
    """A device of a component: each property of its driver is a tunable, in the device's own numbers."""

    def __init__(
        self, world: EmulatedWorld, device: str, entry: DeviceEntry, component: str, about: Declaration
    ) -> None:
        self._world, self._device, self._component = world, device, component
        self._kind = world.setup.type_of(component)
        setup, self._names = world.setup, about.kind == "choice"
        self._is: dict[str, tuple[str, Conversion | None]] = {
            wired.property: (name, self._really(name, conversion_of(setup, about, entry, component, name, wired)))
            for name, wired in mapped(setup, about, entry, component).items()
        }

    def _really(self, name: str, said: Conversion) -> Conversion:
        """How a tunable really follows from the device's number: wrong by the lab's errors."""
        wrong = self._wrong(name)
        return AxisZero(direction=-1 if wrong.reversed else 1, zero=wrong.zero, sigma=0.0).corrects(said)

    def _wrong(self, name: str) -> DeviceError:
        return (self._world.setup.lab.sim.errors.devices or {}).get(f"{self._component}.{name}", DeviceError())

    def now(self) -> float:
        return self._world.now()

    def read(self, what: str) -> Any:
        """The device's number of a tunable; `stuck`: where it does not get past, None where it does."""
        if what == "stuck":
            return next((self.read(p) for p, (t, _) in self._is.items() if self._world.stuck(self._component, t)), None)
        if what in ("frame", "power"):
            return self._measured("image" if what == "frame" else self._is.get(what, ("power", None))[0])
        tunable, wired = self._is.get(what, (what, None))
        if what in self._is and tunable not in self._kind.tunables:
            return self._measured(tunable)
        if tunable not in self._kind.tunables:
            return self._world.recalled(self._device, what)
        value = self._world.value(self._component, tunable)
        if tunable == "shutter":
            return value == "open"
        return wired.to_device(value) if wired and _number(value) else value

    def write(self, what: str, value: Any) -> None:
        """Let a tunable be at the device's number."""
        tunable, wired = self._is.get(what, (what, None))
        if tunable not in self._kind.tunables:
            self._world.remember(self._device, what, value)
            return
        there: Value = wired.to_lab(value) if wired and _number(value) else value
        if self._names and isinstance(value, str):
            there = found if (found := value_at(self._kind.tunables[tunable], value)) is not None else value
        if tunable == "shutter":
            there = "open" if value else "closed"
        self._world.set_value(self._component, tunable, there)

    def _measured(self, name: str) -> Any:
        """The picture, or the power [W], that the twin's instrument gives; None where it gives none."""
        found = measurer_of(self._world.setup, self._component, name)
        try:
            table = Table(self._world.setup, self._world.place, self._world.world())
            reading = found.read(table, self._component, name) if found else None
        except (Failed, PicoError):
            return None
        if reading is None or reading.array is not None:
            return reading.array if reading else None
        if not _number(reading.value):
            return None
        wired = next((one for key, one in self._is.values() if key == name), None)
        unit, there = (
            self._world.setup.measurables_of(self._component)[name].unit,
            reading.value + self._wrong(name).dark,
        )
        return wired.to_device(there) if wired else float(convert(f"{there!r} {unit}", "W"))


class OfCamera:
    """A camera over the bench: what it sees, gray levels."""

    def __init__(self, world: EmulatedWorld, camera: str, eyes: SharedEyes) -> None:
        self._world, self._camera, self._eyes = world, camera, eyes
        self._own: dict[str, Any] = {}

    def now(self) -> float:
        return self._world.now()

    def read(self, what: str) -> Any:
        """`frame`: a picture (rows, columns), uint8, taken now; `pixels`: its width and height."""
        if what == "pixels":
            return self._world.setup.lab.cameras[self._camera].pixels
        return self._eyes.picture(self._camera) if what == "frame" else self._own.get(what)

    def write(self, what: str, value: Any) -> None:
        """Keep what the camera was told; over the bench it does not matter to what it sees."""
        self._own[what] = value


class OfInput:
    """A safety input: safe while nobody is at the table, or has pulled it."""

    def __init__(self, world: EmulatedWorld, device: str) -> None:
        self._world, self._device = world, device
        self._own: dict[str, Any] = {}

    def now(self) -> float:
        return self._world.now()

    def read(self, what: str) -> Any:
        return self._world.safe(self._device) if what == "safe" else self._own.get(what)

    def write(self, what: str, value: Any) -> None:
        self._own[what] = value


class SharedEyes:
    """The cameras over the bench, which look at one scene, one at a time; a table that is as it was looks as it did."""

    def __init__(self, world: EmulatedWorld) -> None:
        self._world, self._lock = world, threading.Lock()
        self._posed: Posed | None = None
        self._taken: dict[str, tuple[tuple[World, object], Any]] = {}
        self._light: dict[str, tuple[World, Any]] = {}

    def picture(self, camera: str) -> Any:
        """Return what a camera sees now, gray levels (rows, columns)."""
        with self._lock:
            now, shown = replace(self._world.world(), clock=0.0), self._world.sheet()
            if camera not in self._taken or self._taken[camera][0] != (now, shown):
                self._taken[camera] = (now, shown), self._frame(camera, now, shown)
            return self._taken[camera][1]

    def _frame(self, camera: str, now: World, shown: Sheet | None) -> Any:
        eyes = self._scene().eyes(now)
        if shown is None:
            return eyes.frame(camera).gray
        if camera not in self._light or self._light[camera][0] != now:  # while a board is moved the rest stands still
            self._light[camera] = now, eyes.light(camera)
        return eyes.frame(camera, light=self._light[camera][1], sheets=(shown,)).gray

    def open(self) -> None:
        """Make the scene, so that the first picture does not take longer than any other."""
        with self._lock:
            self._scene()

    def _scene(self) -> Posed:
        from pico.backends.sim.sight import Posed
        from pico.twin.learned import read_learned, with_noise
        from pico.vision.calibration_files import accepted_arms

        if self._posed is None:
            setup, place = self._world.setup, self._world.place
            noisy = with_noise(setup, read_learned(place.root))
            known = accepted_arms(place.root, place.name)
            self._posed = Posed(noisy, self._world.world(), known, lit=False)
        return self._posed


def _number(value: object) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)
