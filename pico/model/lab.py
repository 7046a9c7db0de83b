"""The lab: the bench as it is, with the inventory of the parts that it owns. mm, deg, kg; see `pico.model.catalog`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from typing import Literal

from pico.diagnostics import RecordError
from pico.model.arming import ArmingPolicy, LaserClass
from pico.model.catalog import (
    Restore,
    SeatingKind,
)
from pico.model.goal import Claim, Goal
from pico.model.pose import Pose
from pico.model.quantities import Angle, Length, Mass, Value
from pico.model.record import record
from pico.model.robot import Robot
from pico.model.simulated import SimSettings


@record
class Holes:
    """The grid of tapped holes: pitch, and the first hole from the front-left corner [mm]."""

    pitch: Length = 25.0
    first: tuple[Length, Length] = (12.5, 12.5)
    thread: str = "M6"


@record
class Table:
    """The table: size along x and y [mm], its hole grid, and the height of the beam above it [mm]."""

    size: tuple[Length, Length]
    beam_height: Length = 70.0
    holes: Holes = Holes()


@record
class Box2:
    """An axis-parallel rectangle on the table: [least, greatest] of x and of y [mm]."""

    x: tuple[Length, Length]
    y: tuple[Length, Length]


@record
class Region:
    """A named part of the table. `staging`: components may be put down there on the way, where the planner may."""

    area: Box2
    title: str = ""
    staging: bool = False


@record
class KeepOut:
    """A volume that neither arm nor component enters: area, and [lowest, highest] above the table [mm]."""

    area: Box2
    z: tuple[Length, Length] = (0.0, 1000.0)
    reason: str = ""


@record
class Slot:
    """A storage place. A part whose origin is within `capture` of it is in the slot, at any yaw.

    `fits`: greatest radius of a footprint that the slot takes; any where it is not given.
    """

    x: Length
    y: Length
    yaw: Angle = 0.0
    capture: Length = 10.0
    fits: Length | None = None

    @property
    def pose(self) -> Pose:
        """Where a part stands that was put into the slot."""
        return Pose(self.x, self.y, self.yaw)


@record
class DepthSensor:
    """How a camera measures depth: within `range` [mm], with `noise` as a share of the depth (one sigma)."""

    range: tuple[Length, Length] = (70.0, 500.0)
    noise: float = 0.002


@record
class Camera:
    """A camera that watches the bench: where it is and looks [mm], its vertical field of view [deg], its pixels.

    With `robot` it rides on that robot's hand: `position` and `look_at` are then in the tool's frame, whose origin is
    the tool center point, z out of the hand, and whose jaws close along y. Up in the picture is +y of the frame where
    the camera looks steeper than 45 deg along z, else up along z; `roll` turns the camera about its axis, clockwise as
    it sees. `distortion`: k1, k2, p1, p2, k3 (Brown-Conrady). `noise`: sigma of a pixel [gray levels of 255]; `blur`:
    sigma of the lens [pixels].
    """

    position: tuple[Length, Length, Length]
    look_at: tuple[Length, Length, Length]
    roll: Angle = 0.0
    field_of_view: Angle = 45.0
    pixels: tuple[int, int] = (1280, 960)
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    noise: float = 2.0
    blur: float = 0.7
    robot: str | None = None
    depth: DepthSensor | None = None


@record
class Datum:
    """A marker fixed to the table: where its center is, and the edge length of its black square [mm]."""

    marker: int
    x: Length
    y: Length
    yaw: Angle = 0.0
    size: Length = 36.0


@record
class Tether:
    """A cable: where it is anchored [mm], its length [mm], and how far the part may turn in all [deg]."""

    anchor: tuple[Length, Length]
    length: Length
    yaw_limit: Angle = 360.0


@record
class Known:
    """How well somebody knows a number of a part: when it was measured (`at`, ISO 8601: a day, or a time); `sigma`, one
    standard deviation, in the number's unit or with one; `valid_for`: how long it counts (`365 d`)."""

    at: str
    sigma: Value | None = None
    valid_for: str | None = None


@record
class Part:
    """One part that the bench owns: exactly one of a `home` slot and a fixed `pose`. `parameters`: of its own, where
    they are others than its type's, such as the focal length of one of many lenses. `ends_beams`: this one is meant to
    end beams (or is not), whatever its type says. `restore`: how tunables of this one are restored, where that is
    otherwise than its type says, such as `{tip: {kind: align, trim: 12, goal: centred}}`. `measured`: of parameters and
    calibrations of its own when and how well they were measured: `{focal_length: {at: 2026-11-20, sigma: 0.2 mm}}`.
    `sample`: which one it holds (`WSe2-041`): no plan to a state moves it unless it is named. `dose_budget`: how much
    light that may have in all [mJ]. `formerly`: the names that the part had before, by which commits, recipes and
    notes of then know it. `mass`: its own [kg], where that is not its type's."""

    type: str
    marker: int | None = None
    serial: str = ""
    home: str | None = None
    pose: Pose | None = None
    seating: SeatingKind | None = None
    tether: Tether | None = None
    calibration: Mapping[str, float] = field(default_factory=dict)
    stage: Literal["allowed", "avoid", "never"] = "allowed"
    note: str = ""
    parameters: Mapping[str, Value] | None = None
    ends_beams: bool | None = None
    restore: Mapping[str, Restore] | None = None
    measured: Mapping[str, Known] | None = None
    sample: str | None = None
    dose_budget: float | None = None
    formerly: tuple[str, ...] | None = None
    mass: Mass | None = None

    def __post_init__(self) -> None:
        if self.mass is not None and self.mass <= 0:
            raise ValueError(f"`mass` is {self.mass:g} kg; it is above 0")
        if self.dose_budget is not None and (not self.sample or self.dose_budget <= 0):
            raise ValueError("a `dose_budget` is above 0 mJ, and of a part with a `sample`")
        if self.home is None and self.pose is None:
            hint = "add `home:` with a free slot; a part that is fixed to the table has a `pose:` instead"
            raise RecordError("the part has neither `home` nor `pose`", hint)
        if self.home is not None and self.pose is not None:
            hint = "keep one: `home` is the slot of a part that moves, `pose` is for a part that is fixed to the table"
            raise RecordError("the part has both `home` and `pose`", hint)


@record
class Margins:
    """Least distance kept between footprints, and between the open fingers and a neighbour [mm]."""

    body: Length = 2.0
    fingers: Length = 2.0


@record
class PolicyRule:
    """What must hold of a plan before anything moves: `that`, a CEL expression over the plan and the bench.

    `mandatory`: where it does not hold, or can't be told, nothing moves; `advisory`: that is only said. `message`: what
    is said then.
    """

    name: str
    that: str
    level: Literal["mandatory", "advisory"] = "mandatory"
    message: str = ""


@record
class HealLimit:
    """How often one component is brought back while a bench is watched: so many `times` within so many `minutes`; after
    that it is left as it is until the watch is started again."""

    times: int = 3
    minutes: float = 10.0

    def __post_init__(self) -> None:
        if self.times < 1 or self.minutes <= 0:
            raise ValueError("a `heal_limit` allows to heal once or more, in more than 0 minutes")


@record
class Policy:
    """What the bench allows. `open_beam`: arms may work, and axes that steer the beam may be homed, while a laser's
    shutter is open; else a plan closes it first. `rules`: what every plan must obey. `heal`: `pico drift --watch
    --heal` may bring back what drifted; `heal_limit`: how often a component, three times in 10 min without it.
    `ignore`: tunables (`cam.exposure`) and components that never count as drift.
    `merge`: what becomes of a merge where each side changed a part of what belongs together (a pose, coupled tunables):
    a warning, or with `strict` a conflict. `enclosed`: the table stands in an interlocked enclosure that no beam
    leaves; what the beam audit finds is then only told. `arming`: who may let lasers above class 2 emit; nobody,
    without it. `calibrated_for`: how long a calibration of the cameras counts (`90 d`). `align`: whether an
    apply redoes the goals whose light it changes, or that are not aligned: `always`, or only where it is `asked` with
    --align. `offline`: the longest that an optimization whose `budget` says so may go on where the bench is cut off
    from its coordinator [s]; a minute at most, and without it. `presence_ends`: the lowest laser class whose light ends
    as soon as a curtain reports somebody at the table; without it a curtain ends no light. `hard_wired_interlock`: the
    interlock of the table ends the light of every laser by its own wiring, without PICO."""

    open_beam: bool = False
    enclosed: bool | None = None
    rules: tuple[PolicyRule, ...] = ()
    heal: bool = False
    heal_limit: HealLimit | None = None
    ignore: tuple[str, ...] = ()
    merge: Literal["warn", "strict"] = "warn"
    arming: ArmingPolicy | None = None
    align: Literal["always", "asked"] | None = None
    calibrated_for: str | None = None
    offline: float | None = None
    presence_ends: LaserClass | None = None
    hard_wired_interlock: bool | None = None


@record
class Lab:
    """A bench."""

    name: str
    title: str = ""
    table: Table
    regions: Mapping[str, Region] = field(default_factory=dict)
    slots: Mapping[str, Slot] = field(default_factory=dict)
    robots: Mapping[str, Robot] = field(default_factory=dict)
    cameras: Mapping[str, Camera] = field(default_factory=dict)
    datums: Mapping[str, Datum] = field(default_factory=dict)
    keep_out: Mapping[str, KeepOut] = field(default_factory=dict)
    margins: Margins = Margins()
    policy: Policy = Policy()
    sim: SimSettings = SimSettings()
    goals: Mapping[str, Goal] | None = None
    claims: Mapping[str, Claim] | None = None
    inventory: Mapping[str, Part]
    requires_pico: str | None = None
    """The versions of PICO that may read this lab, as a version specifier (`>=0.2`); None for any."""

    def __post_init__(self) -> None:
        riding = {
            robot: tuple(c.position for _, c in sorted(self.cameras.items()) if c.robot == robot)
            for robot in self.robots
        }
        robots = {name: _with_eyes(robot, riding[name]) for name, robot in self.robots.items()}
        object.__setattr__(self, "robots", robots)  # what rides on a hand is part of its outline

    def beside_table(self, slot: str | None) -> bool:
        """Return whether a part in `slot` need not stand on the table: where every robot is a gantry, which reaches
        beyond its edge, storage may lie beside it."""
        return slot is not None and all(robot.model == "gantry" for robot in self.robots.values())


def _with_eyes(robot: Robot, eyes: tuple[tuple[Length, Length, Length], ...]) -> Robot:
    return replace(robot, gripper=replace(robot.gripper, eyes=eyes)) if robot.gripper.eyes != eyes else robot
