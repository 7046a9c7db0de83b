"""The simulated table as plain data: what stands where, between one command and the next.

A new world starts from the homes of the inventory, never from a laboratory state. Poses in mm and deg, clock in s.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import field, replace
from typing import Any

from pico.base.state_files import WORLD
from pico.cameras.errors import CameraShift
from pico.geometry.seat import PlacementError, Seat, drawn
from pico.model.catalog import ComponentType, Footprint, Tunable
from pico.model.observation import Observation, ObservedComponent, ObservedRobot, ObservedValue, Presence, UnknownObject
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.record import record
from pico.model.setup import Setup
from pico.model.state import home_state, place_of
from pico.optics.unseen import Unseen


@record
class FreePose:
    """A pose in space, of a part that does not stand upright on the table: position of its base frame [mm] and unit
    quaternion (w, x, y, z) in the table frame."""

    position: tuple[float, float, float]
    quaternion: tuple[float, float, float, float]


@record
class RememberedShape:
    """What the world remembers of a component type, so that a part that leaves the inventory stays an obstacle."""

    footprint: Footprint
    height: float


@record
class WorldBody:
    """One component of the simulated table.

    `pose` is its planar pose, None where it is `missing`; of a part that is `held` or `toppled`, where its origin is
    above the table. `free`: its full pose where physics left it off the plane. `seat`: how it truly sits since it was
    put down, which no camera sees. `values`: as they are, also where their status is `unknown` and the bench does not
    read them. `type` names an entry of `World.shapes`. `offsets`: how much more the true value of a tunable is than it
    reads, in its unit, where a mount slipped: light alone finds it. `unseen`: what else of it light alone finds.
    """

    type: str
    marker: int | None = None
    presence: Presence = "seen"
    pose: Pose | None = None
    free: FreePose | None = None
    seat: Seat | None = None
    values: Mapping[str, ObservedValue] = field(default_factory=dict)
    offsets: Mapping[str, float] = field(default_factory=dict)
    unseen: Unseen | None = None

    @property
    def true_values(self) -> dict[str, Value]:
        """The tunables as light finds them, where they are anywhere: nobody reads them so."""
        read = {name: live.value for name, live in self.values.items() if live.value is not None}
        return {name: _off(value, self.offsets.get(name, 0.0)) for name, value in read.items()}


def _off(value: Value, offset: float) -> Value:
    return value + offset if offset and isinstance(value, float | int) else value


@record
class World:
    """The simulated table. `clock`: simulated seconds since it was new. `robots`: joints [rad] and what each holds.

    `openings`: how far the pads of grippers are apart [mm], all the way where it is not told. `cameras`: how far those
    were bumped that are not where they were when the world was new. `person`: somebody is at the table. `stuck`: axes
    that no motor moves any more. `waits`: when it was told to let time pass (ISO 8601), and how long [s].
    """

    schema: str = WORLD.schema
    lab: str
    seed: int = 1
    clock: float = 0.0
    components: Mapping[str, WorldBody] = field(default_factory=dict)
    robots: Mapping[str, ObservedRobot] = field(default_factory=dict)
    openings: Mapping[str, float] = field(default_factory=dict)
    unknown: Mapping[str, UnknownObject] = field(default_factory=dict)
    shapes: Mapping[str, RememberedShape] = field(default_factory=dict)
    cameras: Mapping[str, CameraShift] = field(default_factory=dict)
    stickers: Mapping[str, int | None] = field(default_factory=dict)
    person: bool = False
    stuck: tuple[str, ...] = ()
    waits: tuple[tuple[str, float], ...] = ()

    def with_body(self, name: str, **changes: Any) -> World:
        """Return the world with fields of component `name` replaced."""
        return replace(self, components={**self.components, name: replace(self.components[name], **changes)})

    def with_value(self, name: str, tunable: str, value: ObservedValue) -> World:
        """Return the world with the value of one tunable replaced."""
        return self.with_body(name, values={**self.components[name].values, tunable: value})


def new_world(setup: Setup) -> World:
    """Return the world in which every part is at home, every tunable at its initial value, every robot parked."""
    homes = home_state(setup)
    return World(
        lab=setup.lab.name,
        seed=setup.lab.sim.seed,
        components={name: new_body(setup, name, place_of(setup, homes, name)[1]) for name in setup.lab.inventory},
        robots={name: parked(setup, name) for name in setup.lab.robots},
        shapes=shapes_of(setup),
    )


def new_body(setup: Setup, name: str, pose: Pose | None) -> WorldBody:
    """Return the component as the world first sees it: standing at `pose`, its tunables at their initial values."""
    part, kind = setup.lab.inventory[name], setup.type_of(name)
    presence: Presence = "seen" if pose else "missing"
    return WorldBody(type=part.type, marker=part.marker, presence=presence, pose=pose, values=initial_values(kind))


def parked(setup: Setup, robot: str) -> ObservedRobot:
    """Return the robot at its park pose with an empty gripper."""
    return ObservedRobot(joints=setup.lab.robots[robot].park_joints)


def shapes_of(setup: Setup) -> dict[str, RememberedShape]:
    """Return the shapes of the types that the inventory uses."""
    names = sorted({part.type for part in setup.lab.inventory.values()})
    kinds = {name: setup.catalog[name].geometry for name in names}
    return {name: RememberedShape(footprint=g.footprint, height=g.height) for name, g in kinds.items()}


def initial_values(kind: ComponentType) -> dict[str, ObservedValue]:
    """Return what the tunables of a type read when the world is new: axes are homed, and simulated devices tell what
    they are set to after power-up."""
    return {name: ObservedValue(value=initial_value(tunable)) for name, tunable in sorted(kind.tunables.items())}


def initial_value(tunable: Tunable) -> Value:
    """Return where a tunable stands after power-up: at its `initial` value, the home of an axis, false, `closed`, the
    first choice, or in the middle of its range, of its decades if it has more than two."""
    if tunable.initial is not None:
        return tunable.initial
    if tunable.datatype == "bool":
        return False
    if tunable.datatype == "choice":
        return "closed" if "closed" in tunable.choices else tunable.choices[0] if tunable.choices else ""
    if tunable.axis is not None:
        return tunable.axis.home
    if tunable.range is None:
        return 0.0
    low, high = tunable.range
    return float(f"{math.sqrt(low * high):.3g}") if 0 < 100 * low < high else (low + high) / 2


def put_down(setup: Setup, world: World, name: str, goal: Pose, one: PlacementError) -> tuple[Pose, Seat]:
    """Return where a component comes to stand that is put down at `goal`, and how it sits: off by what it scatters
    (`one` standard deviation each way), by the seed of the world and how often it was put down."""
    seat = world.components[name].seat
    error = drawn(setup, name, world.seed, count := (seat.count if seat else 0) + 1, one=one)
    return (error.of(goal) if one != PlacementError() else goal), error.seat(count)


def footprints(world: World) -> Iterator[tuple[str, Footprint, Pose]]:
    """Yield name, footprint and pose of everything that takes room on the table: what is held does not."""
    for name, body in world.components.items():
        if body.pose is not None and body.presence in ("seen", "toppled"):
            yield name, world.shapes[body.type].footprint, body.pose
    for name, thing in world.unknown.items():
        yield name, thing.footprint, thing.pose


def read_back(body: WorldBody) -> dict[str, ObservedValue]:
    """Return what a bench reads of the tunables of a component: an axis that was not homed is somewhere, and nobody
    knows where."""
    unknown = ObservedValue(status="unknown")
    return {name: unknown if live.status == "unknown" else live for name, live in body.values.items()}


def observe(world: World, backend: str, observed_at: str) -> Observation:
    """Return the world as an observation without error."""
    components = {
        name: ObservedComponent(presence=body.presence, pose=body.pose, values=read_back(body))
        for name, body in world.components.items()
    }
    return Observation(
        backend=backend,
        time=world.clock,
        observed_at=observed_at,
        components=components,
        unknown=world.unknown,
        robots=world.robots,
        person=world.person,
        waits=world.waits or None,
    )
