"""Benches with one wrong thing each, and benches with none, for `wrong_benches.py`: YAML, and what is to be named.

What is wrong follows from how a bench was made, from data sheets and from optics; nothing here asks PICO."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from random import Random
from typing import Any, Literal

HENE, POWER = 632.8, 0.03
"""Wavelength of a helium-neon laser [nm]; power of each laser [mW]: class 1 from 400 nm on, where safety is silent."""
Part = dict[str, Any]


@dataclass(frozen=True)
class Bench:
    """A bench. `parts` by name: type, pose, `set` (tunables), `parameters`; `goals` as in `lab.yaml`; the `commands` in
    the order in which a person would come to them; the parts one of which is to be `named`, with a `cause` (a regular
    expression over the message that names it). Without a name nothing is wrong. `example`: a shipped lab and the tag of
    its state, on which `parts` are laid. `reading`: what must be said of the number that is measured at last, if the
    program can know it to be wrong."""

    name: str
    parts: Mapping[str, Part] = field(default_factory=dict)
    goals: Mapping[str, Any] = field(default_factory=dict)
    commands: tuple[str, ...] = ("validate", "plan")
    named: tuple[str, ...] = ()
    cause: str = ""
    example: tuple[str, str] | None = None
    reading: Literal["", "doubted", "unknown"] = ""


def part(kind: str, x: float, y: float, yaw: float = 0, /, **more: Any) -> Part:
    """Return a part: what is in capitals goes to its parameters, the rest is set."""
    parameters = {n.lower(): v for n, v in more.items() if n.isupper()}
    values = {n: v for n, v in more.items() if not n.isupper()}
    return {"type": kind, "pose": {"x": x, "y": y, "yaw": yaw}, "set": values, "parameters": parameters}


def laser(x: float, y: float, wavelength: float = HENE, yaw: float = 0, **more: Any) -> Part:
    """Return a laser that shines, of one wavelength [nm]."""
    usual = {"WAVELENGTH": f"{wavelength} nm", "POWER": f"{POWER} mW", "LASER_CLASS": "1"}
    return part("hene_laser", x, y, yaw, **{**usual, "emission": True, "shutter": "open", **more})


def line(
    rng: Random, wavelength: float, *parts: tuple[str, str, Mapping[str, Any]], source: Any = None
) -> dict[str, Part]:
    """Return parts one after the other along +x, somewhere on the table; `yaw` and `aside` [mm] among
    what is set turn and shift one."""
    y, x = rng.uniform(250, 600), rng.uniform(110, 160)
    made = {"laser": laser(x, y, wavelength, **(source or {}))}
    for n, (name, kind, more) in enumerate(parts):
        laid = {"yaw": 0, "aside": 0, **more}
        aside, yaw = laid.pop("aside"), laid.pop("yaw")
        made[name] = part(kind, x + 130 + 130 * n + rng.uniform(-8, 8), y + aside, yaw, **laid)
    return made


MEASURE = {"photodiode": "voltage", "power_meter": "power", "beam_camera": "power", "balanced_detector": "voltage",
           "avalanche_photodiode": "voltage", "spectrometer": "wavelength", "fiber_coupler": "power"}  # fmt: skip
READS = ("validate", "plan", "apply --yes")


def read(detector: str, kind: str) -> tuple[str, ...]:
    """Return the commands by which a person comes to a reading."""
    return (*READS, f"measure {detector}.{MEASURE[kind]} --yes")


def _colors(rng: Random) -> list[Bench]:
    """Light that one part is not made for, and a detector that sees it."""
    told = [
        ("isolator", "faraday_isolator", {}, (532, 780), "photodiode"),
        ("half-wave plate", "half_wave_plate", {"angle": 20}, (532, 780), "photodiode"),
        ("quarter-wave plate", "quarter_wave_plate", {"angle": 45}, (532, 808), "photodiode"),
        ("polarizing cube", "polarizing_beam_splitter", {}, (780, 850), "photodiode"),
        ("bandpass filter", "bandpass_filter", {}, (660, 532), "photodiode"),
        ("achromat", "achromat", {}, (850, 1064), "photodiode"),
        ("coated lens", "plano_convex_100", {}, (808, 1064), "photodiode"),
        ("splitter cube", "beam_splitter_50_50", {}, (780, 980), "photodiode"),
        ("film polarizer", "linear_polarizer", {"angle": 0}, (980, 1064), "photodiode"),
        ("asphere", "asphere", {}, (450, 488), "photodiode"),
        ("objective", "objective", {}, (808, 1064), "photodiode"),
        ("expander", "beam_expander", {}, (850, 980), "photodiode"),
        ("wollaston prism", "wollaston_prism", {}, (808, 850), "photodiode"),
        ("spatial filter", "spatial_filter", {}, (780, 980), "photodiode"),
    ]
    benches = []
    for name, kind, values, wavelengths, detector in told:
        light = rng.choice(wavelengths)
        parts = line(rng, light, ("part", kind, values), ("pd", detector, {"gain": "20 dB"}))
        doubt: Literal["", "doubted"] = "" if name == "bandpass filter" else "doubted"  # dark behind it is right
        bench = Bench(f"{name} at {light} nm", parts, {}, read("pd", detector), ("part",), rf"{light}|wavelength|nm\b")
        benches.append(replace(bench, reading=doubt))
    y = rng.uniform(300, 500)
    silver = {
        "laser": laser(150, y, 405), "m": part("mirror_tip_tilt", 400, y, -45, tip=0, tilt=0),
        "pd": part("photodiode", 400, y + 220, 90, gain="20 dB"),
    }  # fmt: skip
    benches.append(
        Bench("silver mirror at 405 nm", silver, {}, read("pd", "photodiode"), ("m",), r"405|nm\b", reading="doubted")
    )
    return benches


def _blind(rng: Random) -> list[Bench]:
    """Light that a detector does not see."""
    told = [
        ("power_meter", (1310, 1550), {"wavelength": 1000}), ("photodiode", (1310, 1550), {"gain": "20 dB"}),
        ("avalanche_photodiode", (1310, 1550), {}), ("balanced_detector", (1310, 1550), {"aside": 10}),
        ("spectrometer", (1200, 1310), {"exposure": 100}),
    ]  # fmt: skip
    benches = []
    for kind, wavelengths, values in told:
        light = rng.choice(wavelengths)
        parts = line(rng, light, ("m", kind, values))
        cause = "made for" if kind == "spectrometer" else "blind|sees nothing"  # its channels end there
        benches.append(Bench(f"{kind} at {light} nm", parts, {}, read("m", kind), ("m",), cause))
    light = rng.choice((1310, 1550))
    parts = {"laser": {"parameters": {"wavelength": f"{light} nm", "power": f"{POWER} mW", "laser_class": "1"}}}
    cause = "blind|sees nothing"
    benches.append(
        Bench(f"minimal at {light} nm", parts, {}, read("camera", "beam_camera"), ("camera",), cause,
              ("minimal", "empty"))
    )  # fmt: skip
    return [replace(one, reading="unknown") for one in benches]


def _meters(rng: Random) -> list[Bench]:
    """A meter that is set to another wavelength than the light has."""
    benches = []
    for light, own in ((HENE, 400), (HENE, 1064), (532, HENE), (780, HENE)):
        parts = line(rng, light, ("pm", "power_meter", {"wavelength": own}))
        name = f"meter set to {own} nm in light of {light} nm"
        benches.append(Bench(name, parts, {}, read("pm", "power_meter"), ("pm",), rf"wavelength|{own}"))
    silent = line(rng, HENE, ("pm", "power_meter", {}))
    benches.append(
        Bench("meter whose wavelength is not stated", silent, {}, read("pm", "power_meter"), ("pm",), "wavelength")
    )
    wrong = {"meter": {"set": {"wavelength": rng.choice((850, 1000))}}}
    benches.append(
        Bench("meter of mach_zehnder set to infrared", wrong, {}, read("meter", "power_meter"), ("meter",),
              "wavelength", ("mach_zehnder", "aligned"))
    )  # fmt: skip
    return [replace(one, reading="doubted") for one in benches]


def _polarizers(rng: Random) -> list[Bench]:
    """A search over a plate without a polarizer behind it."""
    h, pd = ("h", "half_wave_plate", {"angle": 10}), ("pd", "photodiode", {"gain": "20 dB"})
    q, p = ("q", "quarter_wave_plate", {"angle": 10}), ("p", "linear_polarizer", {"angle": 0})
    pm = ("pm", "power_meter", {"wavelength": HENE})
    cause = "polarizer|does not change|insensitive|is the same"
    own = {"dark": {"tunables": {"q.angle": [0, 180]}, "minimize": "pm.power"}}
    both = {"bright": {"tunables": {"h.angle": [0, 90]}, "maximize": "pd.voltage"}}
    ask = (*READS, "optimize null h pd --dry-run")
    return [
        Bench("null of a plate without polarizer", line(rng, HENE, h, pd), {}, ask, ("h",), cause),
        Bench("peak of a plate behind the polarizer", line(rng, HENE, p, h, pm), {},
              (*READS, "optimize peak h pm --dry-run"), ("h",), cause),
        Bench("goal over a quarter-wave plate without polarizer", line(rng, HENE, q, pm), own,
              (*READS, "optimize dark --dry-run"), ("q",), cause),
        Bench("goal over a plate between lens and diode",
              line(rng, HENE, p, ("lens", "plano_convex_250", {}), h, pd), both,
              (*READS, "optimize bright --dry-run"), ("h",), cause),
        Bench("shel before its polarizers stand", {}, {}, (*READS, "optimize null hwp cam --dry-run"), ("hwp",),
              cause, ("shel", "C1")),
    ]  # fmt: skip


def _shut(rng: Random) -> list[Bench]:
    """Light that something stops."""
    pm = ("pm", "power_meter", {"wavelength": HENE})
    ask = read("pm", "power_meter")
    bare = {"laser": {"set": {"shutter": "closed"}}}
    return [
        Bench("laser shut", line(rng, HENE, pm, source={"shutter": "closed"}), {}, ask, ("laser",), "shutter|closed"),
        Bench("laser off", line(rng, HENE, pm, source={"emission": False}), {}, ask, ("laser",), "off|emission"),
        Bench("shutter closed", line(rng, HENE, ("gate", "shutter", {"shutter": "closed"}), pm), {}, ask, ("gate",),
              "closed|shut"),
        Bench("chopper stands closed", line(rng, HENE, ("wheel", "chopper", {"blades": "closed"}), pm), {}, ask,
              ("wheel",), "closed|blades"),
        Bench("flip mirror in the beam",
              line(rng, HENE, ("flip", "mirror_flip", {"yaw": 45}), pm), {}, ask, ("flip",),
              r"\bup\b|flipped|turn|reflect|sends|way|beam"),
        Bench("minimal with its laser shut", bare, {}, read("camera", "beam_camera"), ("laser",), "shutter|closed",
              ("minimal", "focused")),
    ]  # fmt: skip


def _parked(rng: Random) -> list[Bench]:
    """Parts in storage, or turned away."""
    return [
        Bench("lens of minimal in storage", {}, {}, (*READS, "optimize centre lens camera --by-arm --yes"),
              ("lens",), "storage|slot|stored", ("minimal", "empty")),
        Bench("meter of mach_zehnder in storage", {}, {}, read("meter", "power_meter"), ("meter",),
              "storage|slot|stored|no light", ("mach_zehnder", "parked")),
        Bench("beam of mach_zehnder parked on its block", {}, {}, read("cam", "beam_camera"), ("m1", "block"),
              "block|m1|end", ("mach_zehnder", "cleaned")),
        Bench("polarizer of shel in storage", {}, {}, (*READS, "optimize null p2 cam --dry-run"), ("p2",),
              "storage|slot|stored", ("shel", "C1")),
    ]  # fmt: skip


def _goals(rng: Random) -> list[Bench]:
    """Searches that cannot find what they are for."""
    away = rng.choice((-1, 1))
    lens = ("lens", "lens_xyz_stage", {"stage_x": 0, "stage_y": round(0.9 * away, 2), "stage_z": 0})
    still = ("lens", "lens_xyz_stage", {"stage_x": 0, "stage_y": 0, "stage_z": 0})
    cam, pm = ("cam", "beam_camera", {"exposure": 5}), ("pm", "power_meter", {"wavelength": HENE})
    p, h = ("p", "linear_polarizer", {"angle": 30}), ("h", "half_wave_plate", {"angle": 10})
    narrow = {"near": {"tunables": {"lens.stage_y": [-0.3, 0.3]}, "reach": {"cam.centroid.x": 0}, "tolerance": 5}}
    power = {"most": {"tunables": {"lens.stage_y": [-0.2, 0.2]}, "maximize": "pm.power"}}
    behind = {"null": {"tunables": {"h.angle": [0, 180]}, "minimize": "pm.power"}}
    angle = {"null": {"tunables": {"p.angle": [100, 150]}, "minimize": "pm.power"}}
    dim = {"null": {"tunables": {"p.angle": [0, 90]}, "minimize": "pm.power", "during": {"laser.shutter": "closed"}}}
    ask = (*READS, "optimize {} --dry-run")

    def bench(name: str, parts: Any, goals: Any, named: Sequence[str], cause: str) -> Bench:
        (goal,) = goals
        return Bench(name, parts, goals, tuple(c.format(goal) for c in ask), tuple(named), cause)

    outside, same = "searched|bounds|outside|range", "does not change|insensitive|same"
    return [
        bench("bounds without the present value of a stage", line(rng, HENE, lens, cam), narrow, ["lens"], outside),
        bench("bounds without the present angle", line(rng, HENE, p, pm), angle, ["p"], outside),
        bench("power of a large meter by a lens", line(rng, HENE, still, pm), power, ["lens"], same),
        bench("plate behind the last polarizer", line(rng, HENE, p, h, pm), behind, ["h"], f"polarizer|{same}"),
        bench("a goal that shuts its own laser", line(rng, HENE, p, pm), dim, ["laser", "pm"], "shutter|dark|no light"),
    ]  # fmt: skip


KINDS: dict[str, Callable[[Random], list[Bench]]] = {
    "wavelength": _colors, "blind detector": _blind, "meter": _meters, "polarizer": _polarizers, "shut": _shut,
    "parked": _parked, "goal": _goals,
}  # fmt: skip
LEFT_OUT = {"wavelength": 3, "shut": 1, "goal": 1, "meter": 1, "blind detector": 1}
"""How many of a kind are drawn away, so that there are 40."""


def wrong(seed: int) -> list[tuple[str, Bench]]:
    """Return 40 benches by the kind of what is wrong."""
    rng, benches = Random(seed), []
    for kind, make in KINDS.items():
        made = make(rng)
        for _ in range(LEFT_OUT.get(kind, 0)):
            made.pop(rng.randrange(len(made)))
        benches += [(kind, bench) for bench in made]
    return benches
