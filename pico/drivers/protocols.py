"""What PICO asks of an instrument: a protocol a kind, each as thin as the job allows. mm, deg, s, W; joints in rad.

All of it is asynchronous, for vendors' libraries block: a driver hands its calls to the one worker thread of its bus
(`pico.drivers.bus`), each with a deadline. What fails raises PicoError, with the device in its address; a reply that
did not come in time is told as such, and never taken for one. After `stop` nothing moves until the next command.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal, Protocol, runtime_checkable

from pico.model.instruments.fault import DeviceFault
from pico.model.instruments.readout import Readout
from pico.model.record import record

if TYPE_CHECKING:
    import numpy as np

Maturity = Literal["documented", "emulated", "vendor's firmware", "on device"]
"""How far a driver was tried, the weakest first; the last with a date and the device's firmware."""


@record
class Identity:
    """Who answers at the other end. `serial` is compared with the lab's before anything else is asked."""

    vendor: str
    model: str
    serial: str
    firmware: str = ""


@record
class ArmState:
    """An arm as it last reported itself: `joints` from the base outward [rad], how old that is [s], whether it moves,
    whether it would, and the controller's fault (0: none). `lost`: why the link was lost by which it was got ready, ''
    where it was not; it may have been without power since, and is to be got ready again."""

    joints: tuple[float, ...]
    age: float
    moving: bool
    enabled: bool
    fault: int = 0
    lost: str = ""


@record
class Grip:
    """What a gripper found when it came to rest: how far its fingers are apart [mm], and whether something keeps them
    from where they were to go; None where it can't tell. One of the two it tells."""

    width: float | None
    holds: bool | None


@record
class SafetyState:
    """A safety input: safe only where `safe` is True; None is unknown, and unsafe. `age`: since it was heard [s]."""

    safe: bool | None
    age: float


class Instrument(Protocol):
    """What every driver does."""

    async def connect(self) -> Identity:
        """Open the link within the driver's deadline and ask who answers; moves nothing. Raises PicoError."""
        ...

    async def stop(self) -> None:
        """Stop all motion now, decelerated; what it holds it keeps holding. Needs no other call to have ended."""
        ...

    async def close(self) -> None:
        """Let go of the link; safe to call twice."""
        ...


@runtime_checkable
class Readable(Protocol):
    """An instrument that gives its properties with the replies that say them."""

    async def readouts(self) -> Mapping[str, Readout]:
        """Return what it reads of each of its properties now, by their names; moves nothing. Raises PicoError."""
        ...


@runtime_checkable
class Faulting(Protocol):
    """An instrument that comes to faults which it keeps until somebody clears them."""

    async def faults(self) -> tuple[DeviceFault, ...]:
        """Return the faults that it has now, in the vendor's numbers; moves nothing. Raises PicoError if the link is
        lost."""
        ...

    async def clear(self, *, by_person: bool = False) -> None:
        """Clear its faults, and read back that they are gone; moves nothing.

        `by_person`: a person was at the table and confirmed what the faults say to check. Without it only what needs no
        person is cleared. Raises PicoError naming what is still to be done.
        """
        ...


@runtime_checkable
class MotionTested(Protocol):
    """An instrument whose driver has a motion test of its own, by which a bench earns that it moves without a hand on
    the stop each time."""

    test: str
    """What the test does, for the person who stands by: `arm1 turns its last joint by 5 deg, ...`."""

    async def motion_test(self) -> Mapping[str, float]:
        """Make a small motion out and back, be stopped in the middle of one, and read the limits back; return what was
        measured, by name with its unit (`off_deg`). Raises PicoError for what is not as it should be."""
        ...


class Arm(Instrument, Protocol):
    """An arm that follows joint trajectories of our own timing."""

    async def ready(self) -> ArmState:
        """Configure limits, load and collision detection, read them back, and enable; raises PicoError where what is
        read back differs, or the controller has a fault."""
        ...

    async def state(self) -> ArmState:
        """Return how it last reported itself; raises PicoError where the link is lost."""
        ...

    async def follow(self, times: np.ndarray, joints: np.ndarray, *, doing: str = "") -> ArmState:
        """Follow `joints` (n, k) [rad] at `times` (n,) [s] from where it stands, and return once it is at rest there;
        `doing`: the operation, for what is raised.

        Raises PicoError where it does not stand at the first of them, was stopped, or came to a fault on the way.
        """
        ...

    async def carry(self, mass: float, center: tuple[float, float, float]) -> None:
        """Reckon with `mass` [kg] in the hand beside its usual load, 0 for none, its center [mm] from the flange; at
        rest. Raises PicoError where it can't."""
        ...

    async def halt(self) -> None:
        """Come to rest on the path, decelerated; `follow` then raises PicoError."""
        ...

    async def recover(self) -> ArmState:
        """Clear a fault that may be cleared, and enable again; raises PicoError naming what a person must do."""
        ...


class Gripper(Instrument, Protocol):
    """What opens and closes around a part."""

    async def move_to(self, width: float, *, force: float | None = None) -> Grip:
        """Bring the fingers `width` [mm] apart, or as near as what is between them allows, and say what was found."""
        ...

    async def grip(self) -> Grip:
        """Return how the fingers are, moving nothing."""
        ...


@runtime_checkable
class Clamp(Protocol):
    """A gripper that only holds or lets go, as a vacuum cup or a pneumatic hand, and knows no width between."""

    async def hold(self, on: bool) -> Grip:
        """Hold what is there, or let go, and say what was found once that is over."""
        ...


class Axis(Instrument, Protocol):
    """One motorized axis, in mm or deg of its own zero."""

    async def position(self) -> float | None:
        """Return where it reads that it is; None where it must be homed first."""
        ...

    async def move_to(self, position: float) -> float:
        """Drive there, and return what it reads at rest; raises PicoError beyond its limits or where it fails."""
        ...

    async def home(self) -> float:
        """Find its zero, and return what it reads there."""
        ...


class Camera(Instrument, Protocol):
    """A camera, over the bench or in the beam."""

    async def grab(self, *, exposure: float | None = None, gain: float | None = None) -> np.ndarray:
        """Return one picture taken after the call, (rows, columns) or (rows, columns, 3), with this exposure [ms]."""
        ...


class DepthCamera(Camera, Protocol):
    """A camera that measures depth, too."""

    async def depth(self) -> np.ndarray:
        """Return one depth map taken after the call, (rows, columns) [mm], NaN where nothing was found."""
        ...


class PowerMeter(Instrument, Protocol):
    """A power meter."""

    async def power(self, *, wavelength: float | None = None) -> Readout:
        """Return the power [W], unknown with the reason if the reply is no number; `wavelength` [nm] is set first, and
        what is read back of it is in the `settings` of the readout, absent if the meter can't be told."""
        ...

    async def wavelength(self) -> Readout:
        """Return the wavelength [nm] for which the reading is corrected."""
        ...

    async def set_wavelength(self, wavelength: float) -> Readout:
        """Set the wavelength [nm] for which the reading is corrected, and return what is read back."""
        ...


class Laser(Instrument, Protocol):
    """A laser whose emission is commanded, and read back from what it reports of itself."""

    async def emit(self, on: bool) -> bool:
        """Switch it, and return whether it emits as it says then; off goes before all that waits for its link."""
        ...

    async def emitting(self) -> bool | None: ...


class Shutter(Instrument, Protocol):
    """A shutter; its state comes from a sensor of its own, never from the echo of a command."""

    async def open(self, wanted: bool) -> bool:
        """Open or close it, and return whether it is open then; closing goes before all that waits for its link."""
        ...

    async def is_open(self) -> bool | None: ...


@runtime_checkable
class DeadMan(Protocol):
    """A laser or shutter that ends its light by itself unless it is refreshed: the guard's own death ends light."""

    @property
    def dead_man(self) -> float | None:
        """How long after the last refresh it ends its light [s]; None if it was not told to, or can't."""
        ...

    async def refresh(self) -> None:
        """Keep it from ending its light for so long again; raises PicoError. It opens nothing."""
        ...


class Lamp(Instrument, Protocol):
    """A lamp of the room or the bench."""

    async def shine(self, on: bool) -> bool: ...


class SafetyInput(Instrument, Protocol):
    """A door, a curtain, an emergency stop, a key, an interlock or a shutter's sensor: fail-safe, with a heartbeat."""

    async def read(self) -> SafetyState: ...
