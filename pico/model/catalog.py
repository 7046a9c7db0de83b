"""Component types: what a mirror, a lens, a camera is. Lengths in mm, angles in deg, times in ms, powers in mW."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import field, replace
from typing import Any, Literal

from pico.model.body import Body, grooved
from pico.model.quantities import (
    Angle,
    DimensionError,
    Length,
    Mass,
    Milliseconds,
    QuantityError,
    Value,
    convert,
    require_unit,
)
from pico.model.record import record

Mover = Literal["arm", "motor", "electronics", "person", "none"]
RestoreKind = Literal["setpoint", "align", "request", "none"]
SeatingKind = Literal["free", "magnet", "kinematic", "bolted"]


@record
class Parameter:
    """A fixed property, such as a focal length; never changes in an experiment."""

    value: Value
    unit: str = ""
    description: str = ""

    def __post_init__(self) -> None:
        require_unit(self.unit)


@record
class Restore:
    """How a checkout brings a tunable back.

    `setpoint`: drive to the value. `align`: an optimization has the last word within `trim` (in the tunable's unit)
    around the committed value, until `goal` holds. `request`: light that is asked for, no state: shown, neither
    compared nor brought back by itself. `none`: open loop, shown and never restored.
    """

    kind: RestoreKind = "setpoint"
    trim: float | None = None
    goal: str | None = None


@record
class Axis:
    """The motor behind a tunable: what its position means after power-up, and how it moves (in the tunable's unit)."""

    kind: Literal["absolute", "homed", "open_loop"] = "absolute"
    speed: float
    backlash: float = 0.0
    approach: Literal["positive", "negative", "either"] = "either"
    home: float = 0.0


@record
class Tunable:
    """A directly controllable value other than the pose.

    `unit`, `range`, `period`, `tolerance` and `resolution` belong to datatype `float`; `choices` to `choice`.
    `settle` is how long the value takes beyond the motion of its axis. `initial`: the value after power-up on the
    simulated bench; without it the home of an axis, the center of a range that a person sets, the low end of another
    one, false, `closed`, or the first choice.
    """

    datatype: Literal["float", "bool", "choice"] = "float"
    unit: str = ""
    range: tuple[float, float] | None = None
    period: float | None = None
    choices: tuple[str, ...] = ()
    tolerance: float = 0.0
    resolution: float = 0.0
    mover: Mover = "electronics"
    axis: Axis | None = None
    settle: Milliseconds = 10.0
    initial: Value | None = None
    restore: Restore = Restore()
    description: str = ""

    def __post_init__(self) -> None:
        require_unit(self.unit)


@record
class PoseTolerance:
    """How far a component may stand from where it should: position [mm] and yaw [deg]."""

    position: Length = 0.5
    yaw: Angle = 0.5


@record
class PoseTunable:
    """The pose on the table, as a tunable: who moves it, how well it must be met, how it is restored."""

    mover: Mover = "arm"
    tolerance: PoseTolerance = PoseTolerance()
    resolution: PoseTolerance = PoseTolerance(position=0.01, yaw=0.01)
    restore: Restore = Restore()


@record
class Measurable:
    """An observable. Never set, never restored, only acquired.

    `needs`: tunables with the values that a measurement wants, such as `shutter: open` or `gain: 0 dB`: those of the
    component itself, else of whatever has them. Afterwards they are set back. `kernel`: what computes it of another
    measurable, `image | centroid`; with it `numbers` are several by name, in units that the kernel says.
    """

    datatype: Literal["image", "float", "numbers", "pose", "setpoint"]
    unit: str = ""
    kernel: str | None = None
    needs: Mapping[str, Value] = field(default_factory=dict)
    description: str = ""


@record
class Footprint:
    """The outline of a component on the table in its own frame [mm]: exactly one of a disc's radius, a box, a polygon.

    A polygon is convex and runs counter-clockwise.
    """

    disc: Length | None = None
    box: tuple[Length, Length] | None = None
    polygon: tuple[tuple[Length, Length], ...] | None = None

    def __post_init__(self) -> None:
        given = [s for s in (self.disc, self.box, self.polygon) if s is not None]
        if len(given) != 1:
            raise ValueError("a footprint is exactly one of `disc`, `box` and `polygon`")
        if (self.disc is not None and self.disc <= 0) or (self.box is not None and min(self.box) <= 0):
            raise ValueError("a footprint must have a size above zero")
        if self.polygon is not None and not _convex(self.polygon):
            raise ValueError("a footprint polygon must be convex, counter-clockwise, with three corners or more")

    @property
    def vertices(self) -> tuple[tuple[float, float], ...]:
        """The corners [mm], counter-clockwise; none for a disc."""
        if self.box is not None:
            a, b = self.box[0] / 2, self.box[1] / 2
            return ((-a, -b), (a, -b), (a, b), (-a, b))
        return self.polygon or ()

    @property
    def radius(self) -> float:
        """The distance of the farthest point from the origin [mm]."""
        return self.disc if self.disc is not None else max(math.hypot(x, y) for x, y in self.vertices)


def _convex(corners: tuple[tuple[float, float], ...]) -> bool:
    n = len(corners)
    if n < 3:
        return False
    turns = []
    for i in range(n):
        (ax, ay), (bx, by), (cx, cy) = corners[i], corners[(i + 1) % n], corners[(i + 2) % n]
        turns.append((bx - ax) * (cy - by) - (by - ay) * (cx - bx))
    area = sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1], strict=True))
    return min(turns) > 0 and area > 0


_SAME_WIDTH = 1.0
"""Pads that are this much wider or narrower apart than a part is wide do not hold it [mm]."""

_GROOVE = 4.0
"""The same where the part has grooves and is off the middle of the hand [mm]."""


@record
class Grasp:
    """How the gripper holds a component.

    `height`: of the tool center point above the table [mm]. `width`: of the part between the pads [mm]. `yaws`:
    directions in which the jaws may close, in the component's frame [deg]; 0 closes along the component's x. Jaws
    are alike, so a yaw and its opposite are the same to the fingers but not to the wrist: list one of the two.
    `fixture`: `flat` faces, or grooves that are cut into the body `grip` and bring the part to the middle of the hand.
    """

    height: Length
    width: Length
    yaws: tuple[Angle, ...] = (0.0, 90.0)
    fixture: Literal["flat", "v_groove"] = "flat"

    def fits(self, opening: float) -> bool:
        """Return whether pads that are `opening` apart [mm] can hold the component; they may not have slid to the
        bottom of grooves yet."""
        wider = _SAME_WIDTH if self.fixture == "flat" else _GROOVE
        return -_SAME_WIDTH < opening - self.width < wider


@record
class ClearAperture:
    """The disc of an optic that light passes and nothing touches: center and diameter [mm], normal along local x."""

    center: tuple[Length, Length, Length]
    diameter: Length


@record
class MarkerPlate:
    """Where the marker sits [mm]: its center in the component's frame, and the edge length of its black square."""

    at: tuple[Length, Length, Length]
    size: Length = 24.0


@record
class Geometry:
    """What space a component takes, what it weighs [kg], and where it may be held."""

    footprint: Footprint
    height: Length
    mass: Mass
    bodies: tuple[Body, ...] = ()
    grasp: Grasp | None = None
    clear_aperture: ClearAperture | None = None
    marker: MarkerPlate | None = None

    def __post_init__(self) -> None:
        if self.grasp is None or self.grasp.fixture == "flat":
            return
        cut = [grooved(b, self.grasp.width) if b.name == "grip" else (b,) for b in self.bodies]
        object.__setattr__(self, "bodies", tuple(body for bodies in cut for body in bodies))


@record
class Frames:
    """Origins in the base frame [mm]: `optical`, where the axis (local +x) meets the optic; `pivot`, of a tilt."""

    optical: tuple[Length, Length, Length] = (0.0, 0.0, 70.0)
    pivot: tuple[Length, Length, Length] = (0.0, 0.0, 70.0)


@record
class SpectralLine:
    """A line of a source's spectrum.

    `center`: by how much it is above the frequency of the type's `wavelength` [MHz], or the wavelength itself, in
    vacuum, with its unit. `width`: full width at half maximum [MHz], or of the wavelength with its unit; 0 is a line
    that is always coherent. `share`: how much of the power it has, in parts of the sum of all shares. `polarization`:
    its angle, that of the type where it is left out; lines of other angles do not interfere with it.
    """

    center: float | str = 0.0
    width: float | str = 0.0
    shape: Literal["gaussian", "lorentzian"] = "gaussian"
    share: float = 1.0
    polarization: Angle | None = None

    def detuning(self, wavelength: float) -> float:
        """Return by how much it is above the frequency of a `wavelength` in vacuum [nm], in waves of 1 mm [1/mm].

        Raises QuantityError for a center that is neither a frequency nor a wavelength above 0.
        """
        found = _waves(self.center)
        if found is not None:
            return found
        own = float(convert(self.center, "nm"))
        if own <= 0:
            raise QuantityError(f"`{self.center}` is no wavelength")
        return 1e6 / own - 1e6 / wavelength

    def width_of(self, wavelength: float) -> float:
        """Return its full width at half maximum, in waves of 1 mm [1/mm]: of a wavelength it is the width over the
        square of the center. Raises QuantityError as `detuning` does."""
        found = _waves(self.width)
        if found is not None:
            return found
        return 1e-6 * float(convert(self.width, "nm")) * (1e6 / wavelength + self.detuning(wavelength)) ** 2


def _waves(value: float | str) -> float | None:
    """Return a frequency [MHz] in waves of 1 mm [1/mm], None for a length; raises QuantityError for anything else."""
    try:
        return float(convert(value, "MHz")) / 299792.458
    except DimensionError as exc:
        if exc.have == "length":
            return None
        raise QuantityError(f"`{value}` is neither a frequency nor a wavelength") from exc


@record
class OpticalElement:
    """What a component does to light, by the name of an element; by how much its type's parameters say.

    `ends_beams`: whether it is meant to end any beam that comes to it within its aperture, as blocks are by their
    element; an iris or a shutter does so on its leaves.
    `properties`: those parameters once more, as types of the first release have them. They are lifted on load, see
    `lifted`, and nothing reads them but the digest of a lab. `lines`: the spectrum of a source; without, it is one line
    without a width at its parameter `wavelength`.
    """

    element: str
    properties: Mapping[str, Value] = field(default_factory=dict)
    lines: tuple[SpectralLine, ...] | None = None
    ends_beams: bool | None = None


@record
class Repeatability:
    """One standard deviation of a placement by arm or seat: position each way and height [mm], yaw, and pitch and roll
    about the component's own y and x [deg]. Those left out follow from its seating, see `SEATINGS`."""

    position: Length = 0.1
    yaw: Angle = 0.05
    pitch: Angle | None = None
    roll: Angle | None = None
    height: Length | None = None

    def __post_init__(self) -> None:
        for name in ("position", "yaw", "pitch", "roll", "height"):
            if (value := getattr(self, name)) is not None and value < 0:
                raise ValueError(f"`{name}` of a repeatability is a standard deviation, 0 or more, not {value:g}")


SEATINGS: Mapping[SeatingKind, tuple[float, float, float]] = {
    "free": (0.03, 0.03, 0.03),
    "magnet": (0.02, 0.02, 0.02),
    "kinematic": (0.003, 0.003, 0.002),
    "bolted": (0.01, 0.01, 0.01),
}
"""One standard deviation of pitch, roll [deg] and height [mm] where a type does not say. Estimates, to be replaced by
what a lab measures: a grain or a burr of 20 um under one edge of a base of 60 mm lifts that edge by 0.02 deg, which a
magnet does not press flat, nor its own weight that of a free part; screws press out half of it; three balls in grooves
40 mm apart come back to within 2 um."""


@record
class ComponentType:
    """The definition of a component in the catalog. `coupled`: groups of tunables that mean something only together,
    such as the tip and the tilt that steer one beam; a merge says where both sides changed parts of one."""

    name: str
    title: str
    description: str = ""
    parameters: Mapping[str, Parameter] = field(default_factory=dict)
    pose: PoseTunable = PoseTunable()
    tunables: Mapping[str, Tunable] = field(default_factory=dict)
    measurables: Mapping[str, Measurable] = field(default_factory=dict)
    primitives: tuple[str, ...] = ("move", "stow")
    geometry: Geometry
    frames: Frames = Frames()
    optics: OpticalElement = OpticalElement(element="none")
    seating: SeatingKind = "free"
    repeatability: Repeatability = Repeatability()
    coupled: tuple[tuple[str, ...], ...] = ()

    def __post_init__(self) -> None:
        for name in (name for group in self.coupled for name in group):
            if name not in self.tunables:
                raise ValueError(f"`coupled` names `{name}`, which is none of the tunables")

    @property
    def with_needs(self) -> Mapping[str, Measurable]:
        """The measurables, where one is computed of another with all that this one needs, too."""
        own = self.measurables
        base = {n: own.get((m.kernel or n).partition("|")[0].strip(), m) for n, m in own.items()}
        return {n: replace(m, needs={**base[n].needs, **m.needs}) for n, m in own.items()}

    def number(self, parameter: str, unit: str) -> float | None:
        """Return a parameter that is a number, in `unit`; None where it has none, or not in such a unit."""
        found = self.parameters.get(parameter)
        if found is None or isinstance(found.value, bool | str):
            return None
        try:
            return float(found.value if found.unit in ("", unit) else convert(f"{found.value} {found.unit}", unit))
        except QuantityError:
            return None


RADII = ("radius_of_curvature", "radius_of_curvature_back")
"""Of a lens, the side that light comes to first and the other, each above 0 where it is convex."""
LIFTED = "from `optics.properties`"
"""What a parameter is described as that a file has there alone."""
_WRITTEN_TWICE: Mapping[str, tuple[str, ...]] = {
    "source": ("wavelength", "power", "waist_radius", "polarization", "polarization_ratio"),
    "lens": ("focal_length", "clear_diameter", "transmission"),
    "mirror": ("reflectance", "clear_diameter"),
    "polarizer": ("extinction", "transmission", "clear_diameter"),
    "waveplate": ("retardance", "design_wavelength", "transmission", "clear_diameter"),
    "beam_splitter": ("reflectance", "transmittance", "polarizing", "extinction", "fold", "clear_diameter"),
    "iris": ("outer_diameter",),
    "filter": ("optical_density", "clear_diameter"),
    "shutter": ("clear_diameter",),
    "detector": (
        "active_diameter", "responsivity", "transimpedance", "saturation", "least_power", "greatest_power",
        "uncertainty", "pixels_across", "pixels_up", "pixel_size", "bit_depth", "full_well", "read_noise",
        "quantum_efficiency",
    ),
    "block": ("reflectance", "diameter"),
    "none": ("clear_diameter",),
}  # fmt: skip
_THERE_ALONE = {
    ("beam_splitter", "polarizing"),
    ("beam_splitter", "fold"),
    ("block", "diameter"),
    ("none", "clear_diameter"),
}
_SINCE: Mapping[tuple[str, str], Value] = {
    ("polarizer", "substrate"): "film",
    ("polarizer", "refractive_index"): 1.5,
    ("polarizer", "thickness"): 2,
    ("detector", "filter_density"): 1,
    ("detector", "black_level"): 64,
    ("detector", "dark_current"): 1,
}
"""What types of the catalog say since light is simulated, of parts that are the same as before."""
_THRESHOLDS: Mapping[str, Mapping[str, Value]] = {
    "detector": {"beam_camera": 500, "photodiode": 100, "power_meter": 200},
    "lens": {"": 10000},
    "mirror": {"": 5000},
    "polarizer": {"": 1000},
    "waveplate": {"": 10000},
    "beam_splitter": {"": 5000},
    "filter": {"": 500},
}
"""Damage thresholds that the types of the catalog give since beams are audited, by element and type."""
_DECLARED = ("beam_camera", "photodiode", "power_meter", "shutter")
"""Types of the catalog that are declared to end beams since beams are audited."""
_MEASURED_SINCE = ("dark", "monitor")
"""Measurables that types of the catalog have since then, besides those that are computed of others."""
_TRIMS: Mapping[str, float] = {"mirror_tip_tilt": 2, "mirror_fixed": 5, "mirror_flip": 5}
"""What trims of mirrors in the catalog were before they had to take in how mirrors are placed, by type; 12 since."""
_WIDE_OPEN: Mapping[str, float] = {"iris": 11.5, "slit": 6}
"""Where what opens has its zero since that is within its range: wide open [mm], by type; 0 before."""
_WAVELENGTHS: Mapping[str, Mapping[str, Value]] = {
    "faraday_isolator": {"design_wavelength": 633, "longest": 643, "shortest": 623},
    **{
        key: {"glass": "N-BK7", "longest": 700, "shortest": 350}
        for key in [
            "biconvex",
            "lens_xyz_stage",
            "plano_concave",
            "plano_convex",
            "plano_convex_100",
            "plano_convex_100_v_groove",
            "plano_convex_125",
            "plano_convex_150",
            "plano_convex_150_stage",
            "plano_convex_200",
            "plano_convex_200_stage",
            "plano_convex_250",
            "plano_convex_60",
            "plano_convex_75",
        ]
    },
    "avalanche_photodiode": {"longest": 1000, "sensor": "silicon", "shortest": 400},
    "beam_camera": {"longest": 1050, "sensor": "cmos", "shortest": 350},
    "asphere": {"longest": 1050, "shortest": 600},
    **{key: {"longest": 1100, "sensor": "silicon", "shortest": 320} for key in ["balanced_detector", "photodiode"]},
    "bandpass_filter": {"longest": 1100, "shortest": 200},
    **{
        key: {"longest": 2000, "shortest": 450}
        for key in [
            "concave_mirror",
            "delay_stage",
            "mirror_fixed",
            "mirror_flip",
            "mirror_tip_tilt",
            "off_axis_parabola",
            "piezo_mirror",
        ]
    },
    "glan_polarizer": {"longest": 2300, "shortest": 350},
    **{key: {"longest": 660, "shortest": 600} for key in ["half_wave_plate", "quarter_wave_plate"]},
    "polarizing_beam_splitter": {"longest": 680, "reflected_extinction": 20, "shortest": 420},
    "cylindrical_lens": {"longest": 700, "shortest": 350},
    **{
        key: {"longest": 700, "shortest": 400}
        for key in [
            "achromat",
            "beam_expander",
            "beam_splitter_50_50",
            "filter_wheel",
            "neutral_density_filter",
            "pellicle_beam_splitter",
            "plate_beam_splitter",
            "right_angle_prism",
            "spatial_filter",
            "variable_density_filter",
            "wollaston_prism",
        ]
    },
    "linear_polarizer": {"longest": 720, "shortest": 500},
    "objective": {"longest": 750, "shortest": 400},
    "reflection_grating": {"longest": 800, "shortest": 500},
    "dichroic_mirror": {"longest": 900, "shortest": 400},
    "power_meter": {"longest": 980, "sensor": "silicon", "shortest": 440},
}
"""Parameters that types of the catalog have since the wavelength of light is data, with the values given there."""
_SCALES = {"nW": 1e-6}  # to mW
_REQUESTS: Mapping[str, tuple[str, ...]] = {"source": ("emission", "shutter", "power"), "shutter": ("shutter",)}
"""Tunables that let light out, by element: what a state says of them is a request, also in types that were written when
there were none."""


def lifted(kind: ComponentType) -> ComponentType:
    """Return a type with all that its file has under `optics.properties` as parameters, of which those that it has
    stay; and what it asks of light as requests."""
    more = {n: Parameter(value=v, description=LIFTED) for n, v in kind.optics.properties.items()}
    kind = replace(kind, parameters={**more, **kind.parameters}) if more else kind
    return _restored(kind, "setpoint", "request")


def _restored(kind: ComponentType, before: RestoreKind, after: RestoreKind) -> ComponentType:
    """Return a type whose tunables that let light out are restored otherwise, those that are as `before`."""
    tunables = dict(kind.tunables)
    for name in _REQUESTS.get(kind.optics.element, ()):
        if name in tunables and tunables[name].restore.kind == before:
            tunables[name] = replace(tunables[name], restore=replace(tunables[name].restore, kind=after))
    return replace(kind, tunables=tunables) if tunables != kind.tunables else kind


def as_first_written(kind: ComponentType) -> ComponentType:
    """Return a type as the first release wrote it, with parameters of its element under `optics.properties` too.

    The digest of a lab is taken of that, so that the plans which that release saved are not stale: see decision 11.
    """
    kind = _restored(kind, "request", "setpoint")
    element, written = kind.optics.element, dict(kind.optics.properties)
    alone = {n for n, p in kind.parameters.items() if p.description == LIFTED and n in written}
    if not written:
        found = {n: kind.parameters[n] for n in _WRITTEN_TWICE.get(element, ()) if n in kind.parameters}
        written = {n: _plain(parameter) for n, parameter in found.items()}
        alone = {n for n in written if (element, n) in _THERE_ALONE}
    own = {n: p for n, p in kind.parameters.items() if n not in alone and _SINCE.get((element, n)) != p.value}
    said = _WAVELENGTHS.get(kind.name, {})
    own = {n: p for n, p in own.items() if n not in said or p.value != said[n]}
    threshold, known = own.get("damage_threshold"), _THRESHOLDS.get(element, {})
    if threshold is not None and threshold.value == known.get(kind.name, known.get("")):
        own.pop("damage_threshold")
    measured = {n: m for n, m in kind.measurables.items() if m.kernel is None and n not in _MEASURED_SINCE}
    for name, one in measured.items():  # a lab without a lamp has nothing to switch
        measured[name] = replace(one, needs={k: v for k, v in one.needs.items() if k != "illumination"})
    can = tuple(p for p in kind.primitives if p != "auto_range" and not (element == "source" and p == "measure"))
    repeats = replace(kind.repeatability, pitch=None, roll=None, height=None)
    usual = SEATINGS[kind.seating]
    if (kind.repeatability.pitch, kind.repeatability.roll, kind.repeatability.height) not in (usual, (None,) * 3):
        repeats = kind.repeatability
    tunables = dict(kind.tunables)
    for name, tunable in kind.tunables.items():
        if kind.name in _TRIMS and tunable.restore == Restore(kind="align", trim=12):
            tunables[name] = replace(tunable, restore=Restore(kind="align", trim=_TRIMS[kind.name]))
        if tunable.axis is not None and tunable.axis.home == _WIDE_OPEN.get(kind.name):
            tunables[name] = replace(tunable, axis=replace(tunable.axis, home=0.0))
    ends = None if kind.name in _DECLARED and kind.optics.ends_beams else kind.optics.ends_beams
    return replace(
        kind, parameters=own, measurables=measured, primitives=can, repeatability=repeats, tunables=tunables,
        optics=replace(kind.optics, properties=written, ends_beams=ends),
    )  # fmt: skip


def _plain(parameter: Parameter) -> Value:
    scale = _SCALES.get(parameter.unit)
    return parameter.value if scale is None else float(parameter.value) * scale


Catalog = Mapping[str, ComponentType]


_KEPT = 1024
_made: dict[tuple[int, str, tuple[tuple[str, Any], ...]], tuple[ComponentType, ComponentType]] = {}


def with_parameters(kind: ComponentType, given: Mapping[str, Value]) -> ComponentType:
    """Return a type with other values of its parameters, in their units or with one (`80 mm`); the same object for the
    same type and values. Raises KeyError for a parameter that it does not have, QuantityError for what is none."""
    return _kept(kind, given, _made_of)


def with_restore(kind: ComponentType, given: Mapping[str, Restore]) -> ComponentType:
    """Return a type some of whose tunables are restored otherwise, the same object for the same type and words. Those
    that it does not have are left out, and light that is asked for stays a request."""
    return _kept(kind, given, _otherwise_restored)


def with_mass(kind: ComponentType, mass: float) -> ComponentType:
    """Return a type that weighs `mass` [kg], the same object for the same type and mass."""
    return _kept(kind, {"mass": mass}, _weighing)


def _weighing(kind: ComponentType, given: Mapping[str, Any]) -> ComponentType:
    return replace(kind, geometry=replace(kind.geometry, mass=given["mass"]))


def _kept(
    kind: ComponentType, given: Mapping[str, Any], make: Callable[[ComponentType, Mapping[str, Any]], ComponentType]
) -> ComponentType:  # fmt: skip
    key = id(kind), make.__name__, tuple(sorted(given.items()))
    found = _made.get(key)
    if found is None or found[0] is not kind:
        if len(_made) >= _KEPT:
            _made.clear()
        found = _made[key] = kind, make(kind, given)
    return found[1]


def _otherwise_restored(kind: ComponentType, given: Mapping[str, Restore]) -> ComponentType:
    able = {name for name, one in kind.tunables.items() if one.restore.kind != "request"}
    own = {name: replace(kind.tunables[name], restore=one) for name, one in given.items() if name in able}
    return replace(kind, tunables={**kind.tunables, **own})


def _made_of(kind: ComponentType, given: Mapping[str, Value]) -> ComponentType:
    own = {name: replace(kind.parameters[name], value=value_of(kind.parameters[name], v)) for name, v in given.items()}
    said = ", ".join(f"{name} {_said(parameter)}" for name, parameter in own.items())
    own = {**_bent_alike(kind, own), **own}
    return replace(kind, parameters={**kind.parameters, **own}, title=f"{kind.title}; {said}" if said else kind.title)


def _bent_alike(kind: ComponentType, own: Mapping[str, Parameter]) -> dict[str, Parameter]:
    """Return the radii of a lens of whose specimen only the focal length is known, where its type gives them: all
    scaled by the one factor k that makes the thick lens of its type P = A + B as strong as f says, P f/f' = A/k + B/k^2
    (the lensmaker's equation; B is the term of its thickness)."""
    radii = [name for name in RADII if name in kind.parameters]
    if kind.optics.element != "lens" or "focal_length" not in own or not radii or own.keys() & {*RADII}:
        return {}
    before, after = (one["focal_length"].value for one in (kind.parameters, own))
    curved = [1 / (kind.number(name, "mm") or math.inf) for name in radii]
    thick, index = kind.number("center_thickness", "mm") or 0.0, kind.number("refractive_index", "") or 1.5
    bends, thickness = sum(curved), -(index - 1) * thick / index * math.prod(curved) * (len(curved) > 1)
    if not isinstance(before, int | float) or not isinstance(after, int | float) or not after or not bends:
        return {}
    wanted = (bends + thickness) * before / after
    root = math.sqrt(max(0.0, bends**2 + 4 * wanted * thickness))
    scale = (bends + math.copysign(root, bends)) / (2 * wanted)
    return {
        name: replace(kind.parameters[name], value=scale / one if one else math.inf)
        for name, one in zip(radii, curved, strict=True)
    }


def value_of(parameter: Parameter, given: Value) -> Value:
    """Return a value in the unit of a parameter, of the kind that it has; raises QuantityError for one of another."""
    if isinstance(parameter.value, bool) or isinstance(given, bool):
        if type(parameter.value) is not type(given):
            raise QuantityError(
                f"`{given}` is not {'true or false' if isinstance(parameter.value, bool) else 'a number'}"
            )
        return given
    if isinstance(parameter.value, str):
        if not isinstance(given, str):
            raise QuantityError(f"`{given:g}` is not a word, as `{parameter.value}` is")
        return given
    return float(convert(given, parameter.unit))


def _said(parameter: Parameter) -> str:
    value = parameter.value
    number = f"{value:g}" if isinstance(value, float | int) and not isinstance(value, bool) else str(value).lower()
    return f"{number} {parameter.unit}".rstrip()
