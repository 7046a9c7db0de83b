"""How a component comes to sit that is put down: where beside its goal, and how it leans. Lengths in mm, angles in deg.

The catalog says how well a type repeats. What a lab knows of one placement is what its cameras see of it from above:
x, y and yaw. Pitch, roll and height only light tells.
"""

from __future__ import annotations

import math
import random
from dataclasses import astuple, dataclass, replace

from pico.model.catalog import SEATINGS, ComponentType, Repeatability, SeatingKind
from pico.model.pose import Pose, wrap
from pico.model.quantities import QuantityError, convert
from pico.model.record import record
from pico.model.setup import Setup
from pico.model.trace.learned import Learned


@record
class Seat:
    """How a component sits: turned by `pitch` about its own y and `roll` about its own x, both right-handed, and raised
    by `height`, in its `count`-th placement. No camera that looks from above tells it."""

    pitch: float = 0.0
    roll: float = 0.0
    height: float = 0.0
    count: int = 0

    @property
    def level(self) -> bool:
        """Whether it sits as the lab means it to."""
        return not (self.pitch or self.roll or self.height)


@dataclass(frozen=True, slots=True)
class PlacementError:
    """By how much a component that was put down is off: in the table's frame, but pitch and roll about its own axes."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    pitch: float = 0.0
    roll: float = 0.0
    height: float = 0.0

    def of(self, goal: Pose) -> Pose:
        """Return where a component comes to stand that is put down at a goal."""
        return Pose(goal.x + self.x, goal.y + self.y, wrap(goal.yaw + self.yaw))

    def times(self, factor: float) -> PlacementError:
        """Return what is so many times as large."""
        return PlacementError(*(factor * one for one in astuple(self)))

    def seat(self, count: int) -> Seat:
        """Return how it then sits."""
        return Seat(pitch=self.pitch, roll=self.roll, height=self.height, count=count)


def scatter_of(setup: Setup, component: str) -> PlacementError:
    """Return one standard deviation of a placement each way: as the type of a component says, what it does not say by
    how the component is seated."""
    return scatter(setup.type_of(component).repeatability, setup.seating_of(component))


def scatter(repeats: Repeatability, seating: SeatingKind) -> PlacementError:
    """Return the same of a type's repeatability, and how the component is seated."""
    usual = SEATINGS[seating]
    said = (repeats.pitch, repeats.roll, repeats.height)
    pitch, roll, height = (u if own is None else own for own, u in zip(said, usual, strict=True))
    return PlacementError(repeats.position, repeats.position, repeats.yaw, pitch, roll, height)


def placed_on(kind: ComponentType, tunable: str, one: PlacementError) -> float | None:
    """Return how far placing a component scatters along one of its axes, in the unit of that tunable, `one` being one
    standard deviation: yaw for `tip`, pitch for `tilt`, roll for `angle`; and for stages position and height, with what
    it leans at the height of its optic. None for what placing it does not move."""
    height = kind.frames.optical[2]
    lean = {"stage_x": one.pitch, "stage_y": one.roll}
    by: tuple[float, str]
    if tunable in ("tip", "tilt", "angle"):
        by = {"tip": one.yaw, "tilt": one.pitch, "angle": one.roll}[tunable], "deg"
    elif tunable in lean:
        by = math.hypot(one.x, height * math.radians(lean[tunable])), "mm"
    elif tunable == "stage_z":
        by = one.height, "mm"
    else:
        return None
    try:
        return float(convert(f"{by[0]} {by[1]}", kind.tunables[tunable].unit))
    except QuantityError:
        return None


def injected(setup: Setup, component: str, learned: Learned | None, usual: float) -> PlacementError:
    """Return one standard deviation by which a simulated placement of a component errs each way.

    What the twin learned of its type, or of parts that are seated so, is position and yaw; all else is what the type
    declares, times the lab's `seat`, and `usual` where it says none. A lab with `seat: 0` places exactly.
    """
    asked = setup.lab.sim.errors.seat
    one = scatter_of(setup, component)
    errs = one.times(usual if asked is None else asked)
    if learned is None or asked == 0:
        return errs
    own = learned.types.get(setup.lab.inventory[component].type)
    alike = learned.seatings.get(setup.seating_of(component))
    position, yaw = errs.x, errs.yaw
    if alike is not None:
        position = one.x * alike.position.value if alike.position else position
        yaw = one.yaw * alike.yaw.value if alike.yaw else yaw
    if own is not None:
        position = own.position.value if own.position else position
        yaw = own.yaw.value if own.yaw else yaw
    return replace(errs, x=position, y=position, yaw=yaw)


def drawn(
    setup: Setup, component: str, seed: int, count: int, times: float = 1.0, one: PlacementError | None = None
) -> PlacementError:
    """Return the error of the `count`-th placement of a component, `times` as large as it scatters (`one` standard
    deviation, as `scatter_of` has it where None): Gaussian, the same for the same seed, component and count."""
    draw, sigma = random.Random(f"{seed}/{component}/placed/{count}"), one or scatter_of(setup, component)
    sigmas = (sigma.x, sigma.y, sigma.yaw, sigma.pitch, sigma.roll, sigma.height)
    return PlacementError(*(times * draw.gauss(0.0, each) for each in sigmas))
