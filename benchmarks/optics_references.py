"""PICO's rays and Gaussian beams against other programs: optiland for real lenses, finesse for q along a beam path.

    python benchmarks/optics_references.py [--write]

Prints the largest differences from the golden figures in tests/data, with which the tests compare, and from the
programs themselves where this Python has them. Neither is ever installed by PICO: put one into an environment of its
own, `pip install optiland==0.6.3 pydantic pyyaml` (MIT) or `pip install finesse==3.0.2 ipython pydantic pyyaml`
(GPL: for comparison by hand only), and run this with that Python. `--write` makes the golden figures anew, of those
programs that are there.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import warnings
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from oracles.optics_references import BEAMS, RAYS, beam_of, traced  # noqa: E402

COMMAND = "python benchmarks/optics_references.py --write"


def surface(
    vertex: list[float], normal: list[float], radius: float = 0.0, *, before: float = 1.0, after: float = 1.0,
    reflects: bool = False,
) -> dict[str, Any]:  # fmt: skip
    return {"vertex": vertex, "normal": normal, "radius_of_curvature": radius, "before": before, "after": after,
            "reflects": reflects}  # fmt: skip


def lens(
    center: list[float], axis: list[float], front: float, back: float, thickness: float, index: float
) -> list[dict[str, Any]]:
    """Return the surfaces of a lens met along `axis`."""
    along = np.array(axis) / np.linalg.norm(axis)
    vertices = [(np.array(center) + side * thickness / 2 * along).round(9).tolist() for side in (-1, 1)]
    return [surface(vertices[0], axis, front, before=1.0, after=index),
            surface(vertices[1], axis, back, before=index, after=1.0)]  # fmt: skip


def bundle(at: list[float], along: list[float], width: float, slope: float) -> list[dict[str, Any]]:
    """Return seven rays around one, skew to it and to one another."""
    asides = [(0, 0, 0, 0), (1, 0, 0, 0), (0, 1, 0, 0), (-0.7, 0.6, 0, 0), (0.3, -0.8, 1, 0), (-1, -0.2, 0.4, -1),
              (0.5, 0.9, -0.8, 0.7)]  # fmt: skip
    one, two = np.cross(along, [0.3, 0.9, 0.2]), np.cross(along, [0.9, -0.3, 0.1])
    return [
        {"at": (np.array(at) + width * (a * one + b * two)).round(9).tolist(),
         "along": (np.array(along) + slope * (c * one + d * two)).round(9).tolist()}
        for a, b, c, d in asides
    ]  # fmt: skip


RAY_CASES = {
    "plano-convex lens, decentred and tilted": {
        "surfaces": [*lens([0.5, -0.3, 1.8], [0.0349, -0.0523, 1.0], 51.5, 0.0, 3.6, 1.5151),
                     surface([0.0, 0.0, 90.0], [0.0, 0.0, 1.0])],
        "rays": bundle([0.0, 0.0, -20.0], [0.0, 0.0, 1.0], 4.0, 0.03),
    },
    "plano-convex lens turned round, tilted by 15 deg": {
        "surfaces": [*lens([-1.2, 0.8, 40.0], [0.21, 0.15, 1.0], 0.0, -38.6, 4.1, 1.7847),
                     surface([0.0, 0.0, 110.0], [-0.1, 0.2, 1.0])],
        "rays": bundle([0.0, 0.0, 0.0], [0.05, -0.02, 1.0], 3.0, 0.02),
    },
    "biconvex and meniscus lenses": {
        "surfaces": [*lens([0.3, 0.2, 10.0], [-0.05, 0.08, 1.0], 62.0, -48.0, 5.2, 1.5168),
                     *lens([-0.4, 0.6, 31.0], [0.09, 0.02, 1.0], 24.0, 31.0, 3.0, 1.6727),
                     surface([0.0, 0.0, 65.0], [0.0, 0.1, 1.0])],
        "rays": bundle([0.0, 0.0, -15.0], [-0.02, 0.03, 1.0], 3.5, 0.02),
    },
    "plate at 50 deg": {
        "surfaces": [surface([0.0, 0.0, 20.0], [0.9, 0.6, 1.0], before=1.0, after=1.5),
                     surface([0.0, 0.0, 32.0], [0.9, 0.6, 1.0], before=1.5, after=1.0),
                     surface([0.0, 0.0, 60.0], [0.0, 0.0, 1.0])],
        "rays": bundle([0.0, 0.0, 0.0], [0.02, -0.03, 1.0], 2.0, 0.05),
    },
    "concave mirror at 35 deg and a lens on the way back": {
        "surfaces": [surface([0.0, 0.0, 120.0], [0.6, 0.38, 1.0], -300.0, reflects=True),
                     # met against its normal: light comes from its index `after`
                     surface([-60.0, -38.0, 100.0], [1.0, 0.65, 0.3], 45.0, before=1.5151, after=1.0),
                     surface([-64.0, -40.6, 98.8], [1.0, 0.65, 0.3], 0.0, before=1.0, after=1.5151),
                     surface([-150.0, -97.0, 80.0], [1.0, 0.6, 0.4])],
        "rays": bundle([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], 1.5, 0.002),
    },
    "two mirrors, two lenses, a plate and a camera": {
        "surfaces": [surface([0.0, 0.0, 100.0], [0.0, 1.0, 1.0], reflects=True),
                     *lens([0.2, -60.0, 100.3], [0.02, -1.0, 0.03], 51.5, 0.0, 3.6, 1.5151),
                     surface([0.0, -150.0, 100.0], [1.0, -1.0, 0.05], reflects=True),
                     *lens([-70.0, -150.4, 98.0], [-1.0, 0.03, -0.04], 0.0, -77.3, 3.0, 1.5151),
                     surface([-100.0, -150.0, 97.0], [-1.0, 0.5, 0.1], before=1.0, after=1.5151),
                     surface([-102.0, -149.0, 97.2], [-1.0, 0.5, 0.1], before=1.5151, after=1.0),
                     surface([-160.0, -150.0, 95.0], [-1.0, 0.0, 0.0])],
        "rays": bundle([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], 2.0, 0.004),
    },
}  # fmt: skip


def space(length: float) -> dict[str, Any]:
    return {"kind": "space", "length": length}


def thin_lens(level: float, upright: float | None = None) -> dict[str, Any]:
    return {"kind": "lens", "level": level, "upright": level if upright is None else upright}


def mirror(radius: float, incidence: float) -> dict[str, Any]:
    return {"kind": "mirror", "radius_of_curvature": radius, "incidence": incidence, "after": 1.0}


def interface(radius: float, incidence: float, after: float) -> dict[str, Any]:
    return {"kind": "interface", "radius_of_curvature": radius, "incidence": incidence, "after": after}


BEAM_CASES = {
    "telescope": {
        "wavelength_nm": 632.8, "waist_mm": 0.315, "behind_waist_mm": 0.0,
        "path": [space(240.0), thin_lens(-50.0), space(101.0), thin_lens(150.0), space(700.0)],
    },
    "plano-convex lens and a thin one": {
        "wavelength_nm": 632.8, "waist_mm": 0.65, "behind_waist_mm": 300.0,
        "path": [space(80.0), interface(-51.5, 0.0, 1.5151), space(3.6), interface(0.0, 0.0, 1.0), space(220.0),
                 thin_lens(75.0), space(130.0)],
    },
    "folded by curved mirrors": {
        "wavelength_nm": 1064.0, "waist_mm": 0.2, "behind_waist_mm": -150.0,
        "path": [space(410.0), mirror(500.0, 30.0), space(330.0), mirror(-400.0, 22.0), space(270.0),
                 mirror(0.0, 45.0), space(90.0), mirror(350.0, -12.0), space(615.0)],
    },
    "prism with curved faces": {
        "wavelength_nm": 780.0, "waist_mm": 0.12, "behind_waist_mm": 60.0,
        "path": [space(95.0), interface(-60.0, 35.0, 1.51), space(14.0), interface(-80.0, 20.0, 1.0), space(55.0),
                 interface(0.0, -57.0, 1.76), space(9.0), interface(45.0, -8.0, 1.0), space(200.0)],
    },
    "cylinder lenses at right angles": {
        "wavelength_nm": 532.0, "waist_mm": 0.4, "behind_waist_mm": 25.0,
        "path": [space(120.0), thin_lens(60.0, math.inf), space(75.0), thin_lens(math.inf, -90.0), space(160.0),
                 thin_lens(100.0, 140.0), space(80.0)],
    },
}  # fmt: skip


def by_optiland(case: dict[str, Any]) -> list[Any]:
    """Return what optiland makes of a case of rays, as `oracles.optics_references.traced` does."""
    from optiland.materials import IdealMaterial
    from optiland.optic import Optic
    from optiland.rays import RealRays

    optic, index = Optic(), 1.0
    optic.surfaces.add(index=0, z=-np.inf)
    for number, given in enumerate(case["surfaces"], 1):
        normal = np.array(given["normal"]) / np.linalg.norm(given["normal"])
        x, y, z = given["vertex"]
        if not given["reflects"]:
            index = given["after"] if index == given["before"] else given["before"]
        optic.surfaces.add(
            index=number, x=x, y=y, z=z, rx=-math.asin(normal[1]), ry=math.atan2(normal[0], normal[2]),
            radius=given["radius_of_curvature"] or np.inf, is_stop=number == 1,
            material="mirror" if given["reflects"] else IdealMaterial(index),
        )  # fmt: skip
        axis = np.ravel(optic.surfaces[number].geometry.cs.frame_in_gcs[1])
        assert np.allclose(axis, normal, atol=1e-15), "optiland turns frames another way than this program thinks"
    at = np.array([ray["at"] for ray in case["rays"]]).T
    along = np.array([ray["along"] for ray in case["rays"]]).T
    along = along / np.linalg.norm(along, axis=0)
    ones = np.ones(at.shape[1])
    optic.surfaces.trace(RealRays(*at, *along, ones, 0.6328 * ones))
    group = optic.surfaces
    return np.stack(
        [np.asarray(getattr(group, name))[1:] for name in ("x", "y", "z", "L", "M", "N", "opd")], -1
    ).tolist()


def by_finesse(case: dict[str, Any]) -> list[Any]:
    """Return what finesse makes of a beam path: behind each step the real and imaginary parts of q, level and
    upright [mm]."""
    import finesse
    from finesse import components as parts

    model, path = finesse.Model(), case["path"]
    model.lambda0 = case["wavelength_nm"] * 1e-9
    begin = model.add(parts.Nothing("begin"))
    at, index, length, behind = begin.p2, 1.0, 0.0, []
    for number, step in enumerate(path):
        if step["kind"] == "space":
            length = step["length"]
            if number + 1 < len(path):
                continue
        element = model.add(_element(parts, f"e{number}", step))
        model.add(parts.Space(f"s{number}", at, element.p1, L=length * 1e-3, nr=index))
        if length:
            behind.append(element.p1.i)
        if step["kind"] != "space":
            at = element.p3 if step["kind"] == "interface" else element.p2
            index, length = step.get("after", 1.0), 0.0
            behind.append(at.o)
    rayleigh = math.pi * case["waist_mm"] ** 2 / case["wavelength_nm"] * 1e3  # m
    model.add(parts.Gauss("start", begin.p2.o, z=case["behind_waist_mm"] * 1e-3, zr=rayleigh))
    ways = [model.propagate_beam(begin.p2.o, behind[-1], direction=direction) for direction in ("x", "y")]
    found = [[1e3 * complex(way.q(node).q) for way in ways] for node in behind]
    return [[level.real, level.imag, upright.real, upright.imag] for level, upright in found]


def _element(parts: Any, name: str, step: dict[str, Any]) -> Any:
    if step["kind"] == "space":
        return parts.Nothing(name)
    if step["kind"] == "lens":
        return parts.AstigmaticLens(name, fx=1e-3 * step["level"], fy=1e-3 * step["upright"])
    radius = 1e-3 * step["radius_of_curvature"] or math.inf
    sent = 1.0 if step["kind"] == "mirror" else 0.0
    return parts.Beamsplitter(name, R=sent, T=1 - sent, alpha=step["incidence"], Rc=radius)


PROGRAMS = {
    "optiland": (RAYS, RAY_CASES, by_optiland, lambda case: traced(case).tolist(), "MIT",
                 "at each surface, for each ray: point [mm], direction behind, optical path [mm]"),
    "finesse": (BEAMS, BEAM_CASES, by_finesse,
                lambda case: [[q.level.real, q.level.imag, q.upright.real, q.upright.imag] for q in beam_of(case)],
                "GPL; never imported by what ships",
                "behind each step: q = z + i z_R in the plane of the folds, then across it; real, imaginary [mm]"),
}  # fmt: skip


def apart(name: str, found: list[Any], wanted: list[Any]) -> float:
    """Return the largest difference: of rays in mm (and of direction cosines), of q as a share of it."""
    one, two = np.array(found), np.array(wanted)
    if name == "optiland":
        return float(np.abs(one - two).max())
    one, two = (a[..., 0::2] + 1j * a[..., 1::2] for a in (one, two))
    return float((np.abs(one - two) / np.abs(two)).max())


def written(name: str) -> None:
    path, cases, ask, _, licence, columns = PROGRAMS[name]
    head = {"source": f"{name} {metadata.version(name)} ({licence})", "command": COMMAND, "figures": columns}
    body = [json.dumps({"name": title, **case, "figures": _rounded(ask(case))}) for title, case in cases.items()]
    lines = [f'"{key}": {json.dumps(value)},' for key, value in head.items()]
    path.write_text("{" + "\n".join(lines) + '\n"cases": [\n' + ",\n".join(body) + "\n]}\n")
    print(f"{name}: wrote {len(cases)} cases to {path.relative_to(ROOT)}")


def _rounded(figures: Any) -> Any:
    return [_rounded(f) for f in figures] if isinstance(figures, list) else float(f"{figures:.13g}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    for name, (path, _, ask, ours, _, _) in PROGRAMS.items():
        try:
            here = metadata.version(name)
        except metadata.PackageNotFoundError:
            here = ""
        if given.write and here:
            written(name)
        golden = json.loads(path.read_text())
        unit = "mm" if name == "optiland" else "of q"
        print(f"against {golden['source']}, golden figures" + (f", and {name} {here} live:" if here else ":"))
        for case in golden["cases"]:
            line = f"  {case['name']:53} {apart(name, ours(case), case['figures']):.1e} {unit}"
            print(line + (f"   {apart(name, ours(case), ask(case)):.1e} {unit}" if here else ""))
        if not here:
            print(f"  {name} is not installed here, so nothing was compared with the program itself")


if __name__ == "__main__":
    main()
