"""The lab: the bench as it is, with the inventory of the parts that it owns. mm, deg, kg; see `pico.model.catalog`."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from typing import Literal

from pico.model.arming import ArmingPolicy
from pico.model.catalog import (
    Catalog,
    ComponentType,
    Measurable,
    Restore,
    SeatingKind,
    as_first_written,
    value_of,
    with_parameters,
    with_restore,
)
from pico.model.pose import Pose
from pico.model.quantities import Angle, Length, Value
from pico.model.record import digest, record, remembered


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
class Fingers:
    """The gripper's fingers: thickness along the closing direction, breadth across it, how far the tips reach below
    the tool centre point, how much they open beyond the part on each side [mm]."""

    thickness: Length = 14.0
    breadth: Length = 22.0
    tip: Length = 10.0
    opening: Length = 10.0


@record
class Gripper:
    """What holds a component. `fingers: none` is a vacuum gripper: it needs no room beside the part.

    `eyes`: where cameras sit beside the gripper, in the tool's frame [mm]: those of the lab that ride on the robot.
    """

    fingers: Fingers | Literal["none"] = Fingers()
    stroke: Length = 84.0
    tool: Length = 172.0
    eyes: tuple[tuple[Length, Length, Length], ...] = ()


@record
class Mount:
    """Where a robot's base stands: x, y on the table, z above it [mm], and where its own x axis points [deg]."""

    x: Length
    y: Length
    z: Length = 0.0
    yaw: Angle = 0.0


EXPOSURE = "exposure"
"""The tunable of a detector that `auto_range` finds."""
PARKED = 0.02
"""How far a joint may be from where it parks [rad]; of a gantry [m]."""
XARM7_RANGES = ((-360, 360), (-117.97, 120), (-360, 360), (-11, 225), (-360, 360), (-97, 180), (-360, 360))
"""How far the joints of an xArm7 turn, from the base outward [deg]; the vendor's published URDF."""
TOOL_SPEED = 1000.0
"""Greatest speed of the tool center point [mm/s]; the vendor's manual."""


@record
class Robot:
    """An arm. Heights are of the tool centre point above the table [mm]; `speed` is a share of the joint limits, and
    the tool centre point is never faster than `tool_speed` [mm/s], the vendor's limit unless less is asked for."""

    model: Literal["xarm7", "gantry"] = "xarm7"
    mount: Mount
    gripper: Gripper = Gripper()
    transit_height: Length = 250.0
    speed: float = 0.5
    tool_speed: float | None = None
    park: tuple[Angle, ...] = (0.0, -60.0, 0.0, 30.0, 0.0, 90.0, 0.0)

    def __post_init__(self) -> None:
        if self.model != "xarm7":
            return
        if len(self.park) != len(XARM7_RANGES):
            raise ValueError(
                f"`park` of an xarm7 has the angles of its {len(XARM7_RANGES)} joints, not {len(self.park)}"
            )
        for number, (angle, (low, high)) in enumerate(zip(self.park, XARM7_RANGES, strict=True), 1):
            if not low <= angle <= high:
                raise ValueError(f"joint {number} of `park` is {angle:g} deg; it turns from {low:g} to {high:g} deg")

    @property
    def fastest(self) -> float:
        """The greatest speed of the tool centre point [mm/s]."""
        return TOOL_SPEED if self.tool_speed is None else self.tool_speed

    @property
    def park_joints(self) -> tuple[float, ...]:
        """The joints where it waits [rad]; of a gantry x, y, z [m] over its mount at transit height, and yaw [rad]."""
        if self.model == "gantry":
            return (self.mount.x / 1000, self.mount.y / 1000, self.transit_height / 1000, 0.0)
        return tuple(math.radians(angle) for angle in self.park)

    def is_parked(self, joints: Sequence[float]) -> bool:
        """Return whether it stands there, within PARKED."""
        return all(abs(q - p) <= PARKED for q, p in zip(joints, self.park_joints, strict=False))


@record
class DepthSensor:
    """How a camera measures depth: within `range` [mm], with `noise` as a share of the depth (one sigma)."""

    range: tuple[Length, Length] = (70.0, 500.0)
    noise: float = 0.002


@record
class Camera:
    """A camera that watches the bench: where it is and looks [mm], its vertical field of view [deg], its pixels.

    With `robot` it rides on that robot's hand: `position` and `look_at` are then in the tool's frame, whose origin is
    the tool centre point, z out of the hand, and whose jaws close along y. Up in the picture is +y of the frame where
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
    calibrations of its own when and how well they were measured: `{focal_length: {at: 2026-11-20, sigma: 0.2 mm}}`."""

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

    def __post_init__(self) -> None:
        if (self.home is None) == (self.pose is None):
            raise ValueError("a part has exactly one of `home` (a slot) and `pose` (fixed)")


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
class Budget:
    """What an optimization may spend: measurements, and seconds on the bench's clock."""

    measurements: int = 60
    seconds: float = 600.0


@record
class Goal:
    """What light is to be brought to, and by which tunables: exactly one of `reach`, `minimize` and `maximize`.

    `tunables`: addresses (`ly_150.stage_y`) with the bounds within which they may be set, in their unit. `reach`:
    numbers that are measured (`cam.centroid.x`) with their targets, in their unit, each met within its `tolerance` (one
    number for all, or by name). `minimize`, `maximize`: an expression over such numbers. `signal`: a number that is
    measured too, below whose `least` nothing is believed. `algorithm`: one by name, with its `parameters`; without, one
    is chosen. `valid_for`: how long it counts as aligned once it was met (`12 h`). `offset`: how far from the best, in
    its unit, its one tunable is left, as from a null; counted from where the model of the algorithm has the best.
    `during`: tunables that are set to values while it is sought, and set back (`p1.angle: 90`).

    `looks`: what is set while it is measured, and set back at the end: settings by name, each with its tunables. What
    is measured is then spoken of with the name of its look: `near.meter.power`. `after`: goals of the Lab that are
    sought first, in this order, where this one is dark to begin with; each is begun when the one before has light.
    """

    tunables: Mapping[str, tuple[float, float]]
    reach: Mapping[str, float] | None = None
    minimize: str | None = None
    maximize: str | None = None
    tolerance: float | Mapping[str, float] | None = None
    signal: str | None = None
    least: float | None = None
    algorithm: str | None = None
    parameters: Mapping[str, float] | None = None
    budget: Budget = Budget()
    valid_for: str | None = None
    offset: float | None = None
    during: Mapping[str, Value] | None = None
    description: str = ""
    looks: Mapping[str, Mapping[str, Value]] | None = None
    after: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        if self.offset is not None and (self.reach is not None or len(self.tunables) != 1):
            raise ValueError("`offset` goes with `minimize` or `maximize` and one tunable")
        if sum(one is not None for one in (self.reach, self.minimize, self.maximize)) != 1:
            raise ValueError("a goal has exactly one of `reach`, `minimize` and `maximize`")
        if not self.tunables:
            raise ValueError("a goal has `tunables`, each with its bounds: {ly_150.stage_y: [-1, 1]}")
        if (self.signal is None) != (self.least is None):
            raise ValueError("`signal` and `least` go together")

    @property
    def aim(self) -> Literal["reach", "minimize", "maximize"]:
        """Which of the three it is."""
        return "reach" if self.reach is not None else "minimize" if self.minimize is not None else "maximize"

    @property
    def expressions(self) -> tuple[str, ...]:
        """The expressions over what is measured, those of `reach` numbers by name, that of `signal` last."""
        own = tuple(self.reach or ()) or (self.minimize or self.maximize or "",)
        return (*own, *((self.signal,) if self.signal else ()))

    @property
    def texts(self) -> tuple[str, ...]:
        """The expressions without the names of looks: what is measured, whatever is set for it."""
        return tuple(self.plain(text) for text in self.expressions)

    def plain(self, text: str) -> str:
        """Return an expression without the names of looks."""
        return self._looked.sub("", text)

    def seen_in(self, look: str) -> tuple[str, ...]:
        """Return the numbers that expressions speak of in a look, without its name; in none where it is empty."""
        words = (w for text in self.expressions for w in re.findall(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)+", text))
        if not look:
            return tuple(dict.fromkeys(w for w in words if not self._looked.match(w)))
        return tuple(dict.fromkeys(w.removeprefix(f"{look}.") for w in words if w.startswith(f"{look}.")))

    @property
    def _looked(self) -> re.Pattern[str]:
        names = "|".join(map(re.escape, self.looks or ())) or r"(?!)"
        return re.compile(rf"(?<![\w.])(?:{names})\.(?=[A-Za-z_]\w*\.)")

    def near(self, output: str) -> float:
        """Return the tolerance of a number that is to be reached, 0 where none is said."""
        if isinstance(self.tolerance, Mapping):
            return self.tolerance.get(output, 0.0)
        return self.tolerance or 0.0


def goal_from_json(data: Mapping[str, object]) -> Goal:
    """Return the goal whose `as_json` gave `data`, as the plan of an optimization has it."""
    from pydantic import TypeAdapter

    goal: Goal = TypeAdapter(Goal).validate_python(dict(data))
    return goal


@record
class Policy:
    """What the bench allows. `open_beam`: arms may work, and axes that steer the beam may be homed, while a laser's
    shutter is open; else a plan closes it first. `rules`: what every plan must obey. `heal`: `pico drift --watch
    --heal` may bring back what drifted. `ignore`: tunables (`cam.exposure`) and components that never count as drift.
    `merge`: what becomes of a merge where each side changed a part of what belongs together (a pose, coupled tunables):
    a warning, or with `strict` a conflict. `enclosed`: the table stands in an interlocked enclosure that no beam
    leaves; what the beam audit finds is then only told. `arming`: who may let lasers above class 2 emit; nobody,
    without it. `calibrated_for`: how long a calibration of the cameras counts (`90 d`). `align`: whether an
    apply redoes the goals whose light it changes, or that are not aligned: `always`, or only where it is `asked` with
    --align."""

    open_beam: bool = False
    enclosed: bool | None = None
    rules: tuple[PolicyRule, ...] = ()
    heal: bool = False
    ignore: tuple[str, ...] = ()
    merge: Literal["warn", "strict"] = "warn"
    arming: ArmingPolicy | None = None
    align: Literal["always", "asked"] | None = None
    calibrated_for: str | None = None


@record
class ArmErrors:
    """What is wrong with the simulated arms, and not known to what plans with them.

    The base of each is displaced by `mount_position` [mm] in a random direction and turned by `mount_rotation` [deg]
    about a random axis; the zero of each joint is wrong by `joint_zero` [deg], up or down; the tool is displaced on its
    flange by `tool_position` [mm] in a random direction. `encoder_noise`: sigma of a joint that is read once [deg].
    `backlash`: the play of each joint [deg]: it follows its motor only once that has turned so far.
    """

    mount_position: Length = 0.0
    mount_rotation: Angle = 0.0
    joint_zero: Angle = 0.0
    tool_position: Length = 0.0
    encoder_noise: Angle = 0.0
    backlash: Angle = 0.0


@record
class BadLight:
    """Light in which the simulated cameras see badly. `dim`: share of the light that there should be. `defocus`: sigma
    by which pictures are blurred besides [pixels]. `scatter`, `glare`: how many spots of scattered laser light there
    are on the table, speckled and up to saturation, and how many reflections of lamps in each camera's picture."""

    dim: float = 1.0
    defocus: float = 0.0
    scatter: int = 0
    glare: int = 0


@record
class SensorErrors:
    """What is wrong with the sensors of simulated beam cameras. `non_uniformity`: how pixels respond, one standard
    deviation; `hot_pixels`: the share of them that fill by themselves; `fringes`: of the cover glass, their amplitude;
    `flicker`: of the light from frame to frame, one standard deviation. Cameras have about 0.01, 1e-5, 0.03, 0.01."""

    non_uniformity: float = 0.0
    hot_pixels: float = 0.0
    fringes: float = 0.0
    flicker: float = 0.0

    def __post_init__(self) -> None:
        for name in ("non_uniformity", "hot_pixels", "fringes", "flicker"):
            if not 0 <= getattr(self, name) <= 1:
                raise ValueError(f"`{name}` is a share from 0 to 1, not {getattr(self, name):g}")


@record
class Environment:
    """What the simulated world does by itself, by the bench's clock, and nobody who plans or looks knows.

    `temperature`: how far it drifts about its mean [degC], one standard deviation over a day. `pointing`: how far the
    beam of a laser walks each way over hours [mrad]; `warm_up`: from where it comes to its way in the first quarter of
    an hour of a bench [mrad]; `power`: by which share of it the power walks. `vibration`: how
    far mirrors move along their normal [nm], one standard deviation at 10 to 100 Hz.
    """

    temperature: float = 0.3
    pointing: float = 0.003
    warm_up: float = 0.02
    power: float = 0.005
    vibration: float = 5.0

    def __post_init__(self) -> None:
        for name in ("temperature", "pointing", "warm_up", "power", "vibration"):
            most = 0.5 if name == "power" else 1000.0
            if not 0 <= getattr(self, name) <= most:
                raise ValueError(f"`{name}` is from 0 to {most:g}, not {getattr(self, name):g}")


@record
class SimErrors:
    """What is wrong with the simulated cameras, markers and arms, and not known to what looks through them.

    Each camera is displaced by `camera_position` [mm] in a random direction, turned by `camera_rotation` [deg] about a
    random axis, and its focal length is wrong by the share `focal_length`, up or down. `marker_height`: sigma by which
    a marker lies above or below where its type says [mm]. `lost_frames`: share of pictures that come out black.
    `noise`: factor on the sensors' noise. `seat`: how far off a part comes to sit that is put down, as a multiple of
    its type's repeatability; where it is left out 1 in physics, and 0 (exactly) in kinematic fidelity. `arm`: what is
    wrong with arms, `light`: with the light, `sensor`: with the sensors of beam cameras; nothing where they are left
    out.
    """

    camera_position: Length = 0.0
    camera_rotation: Angle = 0.0
    focal_length: float = 0.0
    marker_height: Length = 0.0
    lost_frames: float = 0.0
    noise: float = 1.0
    seat: float | None = None
    arm: ArmErrors | None = None
    light: BadLight | None = None
    sensor: SensorErrors | None = None

    def __post_init__(self) -> None:
        if self.seat is not None and not 0 <= self.seat <= 10:
            raise ValueError(f"`seat` is a multiple of the repeatability, from 0 to 10, not {self.seat:g}")


@record
class SimSettings:
    """How the simulated bench behaves where a command does not say. `pad_friction`: sliding friction coefficient of the
    finger pads on a part. `renderer`: what draws the cameras' pictures; `egl` needs OpenGL. `errors`: what is wrong
    with cameras and arms. `sight`: by what the physical world corrects a part in the hand before it is put down: the
    truth (but where the table is looked at by sight), the pictures of the eye in the hand, or nothing; with `pixels` a
    physical run knows only what its cameras saw, of the table, too. `faults`: what goes wrong how often, as
    a share of the operations that it can befall: `drop`, `slip`, `jam`, `camera`, `timeout`, `reading`, `slow`, `all`.
    `observe`: how the table is looked at, exactly or through the cameras. `environment`: what the world does by itself,
    as worlds do where it is left out; `none`: nothing."""

    fidelity: Literal["kinematic", "physics"] = "kinematic"
    seed: int = 1
    pad_friction: float = 1.0
    renderer: Literal["raycast", "egl"] = "raycast"
    errors: SimErrors = SimErrors()
    sight: Literal["exact", "pixels", "none"] = "exact"
    observe: Literal["exact", "sight"] = "exact"
    environment: Environment | Literal["none"] | None = None
    faults: Mapping[Literal["drop", "slip", "jam", "camera", "timeout", "reading", "slow", "all"], float] = field(
        default_factory=dict
    )

    @property
    def hand_sight(self) -> Literal["exact", "pixels", "none"]:
        """By what a part in the hand is seen in the physical world."""
        return "pixels" if self.observe == "sight" and self.sight == "exact" else self.sight

    def runs_by_sight(self, fidelity: str) -> bool:
        """Return whether a run at a fidelity knows only what its cameras, joints and pads tell."""
        return self.observe == "sight" or (fidelity == "physics" and self.hand_sight == "pixels")

    def __post_init__(self) -> None:
        for name, rate in self.faults.items():
            if not 0 <= rate <= 1:
                raise ValueError(f"the rate of `{name}` in `faults` is a share from 0 to 1, not {rate:g}")


@record
class Lab:
    """A bench."""

    name: str
    title: str = ""
    table: Table
    regions: Mapping[str, Region] = field(default_factory=dict)
    slots: Mapping[str, Slot] = field(default_factory=dict)
    robots: Mapping[str, Robot]
    cameras: Mapping[str, Camera] = field(default_factory=dict)
    datums: Mapping[str, Datum] = field(default_factory=dict)
    keep_out: Mapping[str, KeepOut] = field(default_factory=dict)
    margins: Margins = Margins()
    policy: Policy = Policy()
    sim: SimSettings = SimSettings()
    goals: Mapping[str, Goal] | None = None
    inventory: Mapping[str, Part]

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


@record
class Setup:
    """A lab together with the component types that its inventory uses: what every computation about a bench needs."""

    lab: Lab
    catalog: Catalog

    def type_of(self, component: str) -> ComponentType:
        """Return the type of `component`, with the parameters that are the part's own and how it is restored; raises
        KeyError for a part that the inventory does not have."""
        part = self.lab.inventory[component]
        kind = self.catalog[part.type]
        if part.restore:
            kind = with_restore(kind, part.restore)
        return with_parameters(kind, part.parameters) if part.parameters else kind

    def ranges(self, component: str) -> bool:
        """Return whether `component` finds an exposure of its own."""
        if component not in self.lab.inventory:
            return False
        kind = self.type_of(component)
        return "auto_range" in kind.primitives and EXPOSURE in kind.tunables

    def seating_of(self, component: str) -> SeatingKind:
        """Return how `component` is seated: the part's own word, else its type's."""
        return self.lab.inventory[component].seating or self.type_of(component).seating

    def ends_beams(self, component: str) -> bool:
        """Return whether `component` is meant to end beams: the part's own word, else its type's; a block is."""
        own, optics = self.lab.inventory[component].ends_beams, self.type_of(component).optics
        said = optics.ends_beams if own is None else own
        return optics.element == "block" if said is None else said

    def requests(self, component: str, tunable: str) -> bool:
        """Return whether what a state says of a tunable is a request: light, which is asked for and never restored."""
        kind = self.type_of(component).tunables.get(tunable)
        return kind is not None and kind.restore.kind == "request"

    def movable(self, component: str) -> bool:
        """Return whether an arm may move `component`: not bolted, has a grasp, and its type says that an arm does."""
        kind = self.type_of(component)
        return (
            self.lab.inventory[component].pose is None
            and self.seating_of(component) != "bolted"
            and kind.pose.mover == "arm"
            and kind.geometry.grasp is not None
        )

    @remembered
    def measurables_of(self, name: str) -> Mapping[str, Measurable]:
        """Return what can be asked to be measured of a component or a camera over the bench; nothing for another name.

        Besides the measurables of its type a component has its `pose`, as cameras see it, and its set-points, read
        back; a camera has its `frame`.
        """
        if name in self.lab.inventory:
            kind = self.type_of(name)
            read = {t: Measurable(datatype="setpoint", unit=tunable.unit) for t, tunable in kind.tunables.items()}
            return {**read, "pose": Measurable(datatype="pose", unit="mm, mm, deg"), **kind.with_needs}
        camera = self.lab.cameras.get(name)
        return {} if camera is None or camera.robot else {"frame": Measurable(datatype="image", unit="count")}

    def at_speed(self, speed: float | None) -> Setup:
        """Return the same with every robot at a share of its joint limits; as it is where that is None."""
        if speed is None:
            return self
        robots = {name: replace(robot, speed=speed) for name, robot in self.lab.robots.items()}
        return replace(self, lab=replace(self.lab, robots=robots))

    def same_as(self, other: Setup) -> bool:
        """Whether this is the same lab with the same types, as digests tell it."""
        return self == other or self.digest() == other.digest()

    @remembered
    def digest(self) -> str:
        """Return the digest of the lab and its types as the first release wrote them, as a plan records it; parameters
        of a part count by their values, however they are written."""
        lab = self.lab
        if any(part.parameters is not None for part in lab.inventory.values()):
            lab = replace(lab, inventory={name: self._converted(part) for name, part in lab.inventory.items()})
        return digest({"lab": lab, "catalog": {n: as_first_written(kind) for n, kind in self.catalog.items()}})

    def _converted(self, part: Part) -> Part:
        if not part.parameters:
            return part if part.parameters is None else replace(part, parameters=None)
        declared = self.catalog[part.type].parameters
        return replace(part, parameters={name: value_of(declared[name], v) for name, v in part.parameters.items()})
