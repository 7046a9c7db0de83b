"""The benches of `faulted_loops.py`: what is sought on them, and how well it truly is met, by the tracer alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random

from pico.backends.sim.lighted import light_on
from pico.backends.sim.readings import Table
from pico.backends.sim.world import World
from pico.bench.bench import Bench, new_lab
from pico.model.observation import ObservedValue
from pico.model.setup import Setup
from pico.optics.instruments import power_on

HEAD = """apiVersion: pico/v1
kind: Lab
metadata: {name: NAME}
table: {size: [1200, 900], beam_height: 70}
robots:
  arm1: {model: xarm7, mount: {x: 480, y: 820, yaw: -90}}
policy: {enclosed: true, arming: {waived: [kinematic, physics]}}
sim: {environment: none}
"""
STEERED = """inventory:
  laser: {type: hene_laser, pose: {x: 120, y: 220, yaw: 0}}
  m1: {type: mirror_tip_tilt, marker: 1, pose: {x: 320, y: 220, yaw: -45}}
  m2: {type: mirror_tip_tilt, marker: 2, pose: {x: 320, y: 510, yaw: 135}}
"""
BEAM_CAMERA = """apiVersion: pico/v1
kind: ComponentType
metadata: {name: quick_camera, title: A camera of few pixels}
parameters:
  pixels_across: {value: 320, unit: pixel}
  pixels_up: {value: 256, unit: pixel}
  pixel_size: {value: 14, unit: um}
  bit_depth: {value: 12, unit: bit}
  full_well: {value: 40000}
  read_noise: {value: 5}
  quantum_efficiency: {value: 0.6}
  filter_density: {value: 5}
  black_level: {value: 64, unit: count}
  dark_current: {value: 1}
  damage_threshold: {value: 500, unit: mW/mm^2}
pose: {mover: person}
tunables:
  exposure: {unit: ms, range: [0.02, 1000], tolerance: 0.01, resolution: 0.001, initial: 1, settle: 50}
measurables:
  image: {datatype: image, unit: count}
  centroid: {datatype: numbers, unit: "um, um", kernel: image | centroid}
  width: {datatype: numbers, unit: "um, um, deg, 1", kernel: image | d4sigma}
  power: {datatype: numbers, unit: count/ms, kernel: image | power}
primitives: [set, measure, auto_range]
geometry: {footprint: {box: [60, 60]}, height: 140, mass: 0.3, clear_aperture: {center: [0, 0, 70], diameter: 6}}
frames: {optical: [0, 0, 70], pivot: [0, 0, 70]}
optics: {element: detector, ends_beams: true}
seating: bolted
"""
LIT = "  laser: {emission: true, shutter: open}\n"
LABS: Mapping[str, tuple[str, str]] = {
    "camera": (
        STEERED
        + "  lens: {type: lens_xyz_stage, marker: 3, pose: {x: 500, y: 510, yaw: 0}}\n"
        + "  cam: {type: quick_camera, pose: {x: 640, y: 510, yaw: 0}}\n",
        LIT,
    ),
    "fiber": (STEERED + "  fiber: {type: fiber_coupler, marker: 3, pose: {x: 620, y: 510, yaw: 0}}\n", LIT),
    "crossed": (
        "inventory:\n"
        "  laser: {type: hene_laser, pose: {x: 120, y: 220, yaw: 0}}\n"
        "  p1: {type: linear_polarizer, marker: 1, pose: {x: 320, y: 220, yaw: 0}}\n"
        "  p2: {type: linear_polarizer, marker: 2, pose: {x: 450, y: 220, yaw: 0}}\n"
        "  pd: {type: photodiode, marker: 3, pose: {x: 620, y: 220, yaw: 0}}\n",
        LIT,
    ),
}
"""Own small benches: their inventory, and what their state sets."""


@dataclass(frozen=True)
class Sought:
    """A goal as `lab.yaml` has it (without its tunables' bounds), where its tunables stand at first, each within its
    own range, `true`: how far the light truly is from it, the less the better, and in how many units of what is
    measured that is told."""

    lab: str
    bounds: Mapping[str, tuple[float, float]]
    starts: Mapping[str, tuple[float, float]]
    what: str
    algorithms: tuple[str, ...]
    true: Callable[[Table], float]

    def text(self, name: str) -> str:
        """Return its entry under `goals:`."""
        bounds = ", ".join(f"{n}: [{low:g}, {high:g}]" for n, (low, high) in self.bounds.items())
        return f"  {name}:\n    tunables: {{{bounds}}}\n    {self.what}\n"


def off_centre(detector: str) -> Callable[[Table], float]:
    """Return how far the light on a detector is from its middle [um]; infinite in the dark."""

    def off(table: Table) -> float:
        found = light_on(table).at(detector)
        power = sum(a.power for a in found)
        if power <= 0:
            return math.inf
        return 1e3 * math.hypot(*(sum(a.power * a.center[n] for a in found) / power for n in (0, 1)))

    return off


def power(detector: str, sign: float) -> Callable[[Table], float]:
    """Return the power on a detector [mW], or what of it a fiber takes; `sign` -1 where more is better."""

    def taken(table: Table) -> float:
        light, kind = light_on(table), table.setup.type_of(detector)
        if kind.number("mode_radius", "mm") is not None:
            from pico.optics.offsets import coupled

            return sign * sum(coupled(light.parts[detector], a.beam) for a in light.at(detector))
        return sign * power_on(light.at(detector), light.parts[detector])

    return taken


def width(detector: str) -> Callable[[Table], float]:
    """Return the width of the beam on a detector along its wider axis [um]."""

    def wide(table: Table) -> float:
        return max((2e3 * max(a.beam.widths[:2]) for a in light_on(table).at(detector)), default=math.inf)

    return wide


CAM = "reach: {cam.centroid.x: 0, cam.centroid.y: 0}\n    tolerance: TOL\n    signal: cam.power\n    least: 50"


def _budget(count: int) -> str:
    return f"\n    budget: {{measurements: {count}, seconds: 900}}"


def _all(names: str, low: float, high: float) -> dict[str, tuple[float, float]]:
    return dict.fromkeys(names.split(), (low, high))


SOUGHT: Mapping[str, Sought] = {
    "lens": Sought("camera", _all("lens.stage_y lens.stage_z", -2, 2), _all("lens.stage_y lens.stage_z", -0.5, 0.5),
                   CAM.replace("TOL", "5") + _budget(40), ("centroid_newton", "nelder_mead", "cobyqa"),
                   off_centre("cam")),
    "mirror": Sought("camera", _all("m2.tip m2.tilt", -5, 5), _all("m2.tip m2.tilt", -1.5, 1.5),
                     CAM.replace("TOL", "5") + _budget(40), ("centroid_newton", "rcds"), off_centre("cam")),
    "focus": Sought("camera", _all("lens.stage_x", -6, 6), _all("lens.stage_x", -6, 6),
                    "minimize: cam.width.major" + _budget(20), ("waist_parabola", "nelder_mead"), width("cam")),
    "tip": Sought("fiber", _all("m2.tip m2.tilt", -2, 2), _all("m2.tip m2.tilt", -0.4, 0.4),
                  "maximize: fiber.power" + _budget(50), ("peak", "nelder_mead", "rcds", "cma_es"),
                  power("fiber", -1)),
    "walk": Sought("fiber", _all("m1.tip m1.tilt m2.tip m2.tilt", -2, 2),
                   _all("m1.tip m1.tilt m2.tip m2.tilt", -0.2, 0.2), "maximize: fiber.power" + _budget(90),
                   ("nelder_mead", "peak", "rcds"), power("fiber", -1)),
    "null": Sought("crossed", _all("p2.angle", 0, 180), _all("p2.angle", 5, 175), "minimize: pd.voltage" + _budget(20),
                   ("malus", "nelder_mead"), power("pd", 1)),
    "shel": Sought("shel", _all("ly_150.stage_y ly_150.stage_z", -1.5, 1.5),
                   _all("ly_150.stage_y ly_150.stage_z", -0.5, 0.5), CAM.replace("TOL", "5") + _budget(20),
                   ("centroid_newton",), off_centre("cam")),
    "shel_null": Sought("shel", _all("p1.angle", 0, 180), _all("p1.angle", 5, 175), "minimize: cam.power" + _budget(20),
                        ("malus",), power("cam", 1)),
    "fringe": Sought("mach_zehnder", _all("m2.piezo", 0, 10), _all("m2.piezo", 0, 10),
                     "maximize: cam.power" + _budget(20), ("peak",), power("cam", -1)),
}  # fmt: skip
OFTEN = {"lens": 5, "mirror": 4, "focus": 4, "tip": 5, "walk": 3, "null": 5, "shel": 1, "shel_null": 1, "fringe": 1}
"""How often each is run, in so many loops as that is in all: pictures of real cameras take long."""
PLACED = {"shel": "e1", "mach_zehnder": None}
"""Shipped labs, and the revision that is applied on each."""


def made(name: str, place: Path) -> Path:
    """Make one of the labs with its goals, its state applied, and return its folder."""
    folder, goals = place / name, "".join(s.text(n) for n, s in SOUGHT.items() if s.lab == name)
    if name in PLACED:
        new_lab(folder, name)
        lab = folder / "lab.yaml"
        text = lab.read_text().replace("  seed: 1\n", "  seed: 1\n  environment: none\n", 1)
        if "\ngoals:\n" not in text:
            text = text.replace("\ninventory:\n", "\ngoals:\ninventory:\n", 1)
        lab.write_text(text.replace("\ngoals:\n", f"\ngoals:\n{goals}", 1))
    else:
        folder.mkdir(parents=True)
        inventory, state = LABS[name]
        (folder / "lab.yaml").write_text(HEAD.replace("NAME", name) + f"goals:\n{goals}" + inventory)
        (folder / "quick_camera.yaml").write_text(BEAM_CAMERA)
        head = f"apiVersion: pico/v1\nkind: LabState\nmetadata: {{lab: {name}}}\ncomponents:\n"
        (folder / "state.yaml").write_text(head + state)
    with Bench.open(folder, fidelity="kinematic") as bench:
        report = bench.apply(PLACED.get(name))
        assert report.outcome == "done", report.diagnostics
    return folder


STARTS = 12


def drawn(setup: Setup, world: World, sought: Sought, draw: Random) -> World:
    """Return a world whose tunables stand at one of STARTS places within where they may begin: the beam audit, which
    is kept by state, then need not be done anew for each loop."""
    place = Random(draw.randrange(STARTS))
    for address, (low, high) in sought.starts.items():
        component, _, tunable = address.partition(".")
        world = world.with_value(component, tunable, ObservedValue(value=round(place.uniform(low, high), 3)))
    return replace(world, stuck=(), clock=world.clock + 1000.0, seed=draw.randrange(1, 10**6))
