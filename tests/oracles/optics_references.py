"""Golden figures of other programs for rays and Gaussian beams, and the same systems put to PICO.

`tests/data/optiland_rays.json` and `tests/data/finesse_beams.json` name the program that made them, its version and
licence, and the command: `benchmarks/optics_references.py`, which also compares with the program itself where it is
installed. Nothing here imports one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pico.optics.beam import Beam, Wave, beyond, forward
from pico.optics.elements.lens import thin
from pico.optics.gaussian import from_waist
from pico.optics.rays import Surface, rays, trace

DATA = Path(__file__).resolve().parents[1] / "data"
RAYS, BEAMS = DATA / "optiland_rays.json", DATA / "finesse_beams.json"
Array = NDArray[np.float64]


def surfaces_of(case: dict[str, Any]) -> list[Surface]:
    """Return the surfaces of a case of rays; `radius_of_curvature` 0 is flat, its sign as that of a curvature."""
    found = []
    for given in case["surfaces"]:
        normal = np.array(given["normal"], dtype=float)
        radius = given["radius_of_curvature"]
        found.append(Surface(
            np.array(given["vertex"], dtype=float), normal / np.linalg.norm(normal), 1 / radius if radius else 0.0,
            before=given["before"], after=given["after"], reflects=given["reflects"],
        ))  # fmt: skip
    return found


def traced(case: dict[str, Any]) -> Array:
    """Return what PICO makes of a case of rays: at each surface (n_surfaces, n_rays, 7) the point [mm], the direction
    behind it, and the optical path so far [mm]; nan where a ray is lost."""
    begun = rays([ray["at"] for ray in case["rays"]], [ray["along"] for ray in case["rays"]])
    found = trace(surfaces_of(case), begun)
    whole = np.stack([np.column_stack([r.at, r.along, r.path]) for r in found])
    whole[~np.stack([r.alive for r in found])] = np.nan
    return whole


@dataclass(frozen=True)
class Waists:
    """q of a beam in the plane of the folds and across it [mm]: z + i z_R, behind its waist."""

    level: complex
    upright: complex


def beam_of(case: dict[str, Any]) -> list[Waists]:
    """Return q behind each element of a beam path, from PICO's beam in space.

    The path lies in a level plane. Of a mirror or an interface `radius_of_curvature` is above 0 where it is concave
    to who comes, and `incidence` [deg] turns its normal to the left; 0 is flat.
    """
    wavelength, along = case["wavelength_nm"] * 1e-6, np.array([1.0, 0.0, 0.0])
    left, up = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])
    curvature = from_waist(case["waist_mm"], wavelength, case["behind_waist_mm"])
    waves = (Wave(up.astype(complex), np.zeros(2, dtype=complex)),)
    beam = Beam("laser", wavelength, np.zeros(3), along, left, curvature, waves)
    found = []
    for step in case["path"]:
        beam = _stepped(beam, step)
        one, two = 1 / beam.curvature[0, 0], 1 / beam.curvature[1, 1]
        assert abs(beam.curvature[0, 1]) < 1e-15
        found.append(Waists(np.conj(one), np.conj(two)))  # fields as exp(i(kz - wt)) have q = z - i z_R
    return found


def _stepped(beam: Beam, step: dict[str, Any]) -> Beam:
    if step["kind"] == "space":
        return forward(beam, step["length"])
    if step["kind"] == "lens":
        left, up = beam.frame
        return thin(
            beam, beam.at, beam.along, np.outer(left, left) / step["level"] + np.outer(up, up) / step["upright"]
        )
    turn = math.radians(step["incidence"])
    normal = math.cos(turn) * beam.along + math.sin(turn) * beam.across
    radius = step["radius_of_curvature"]
    surface = Surface(beam.at, normal, -1 / radius if radius else 0.0, before=beam.index, after=step["after"])
    behind = beyond(beam, surface, reflect=step["kind"] == "mirror")
    assert behind is not None
    return behind
