"""Benches of light for the tests: elements in a row, of types that say exactly what a case asks for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from pico.manifest.catalog import load_catalog
from pico.model.catalog import ComponentType, Parameter
from pico.model.lab import Lab, Part, Table
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.light import Light, light_of

CATALOG = load_catalog()
LENS = {"focal_length": 100.0, "transmission": 1.0}
IDEAL: Mapping[str, Mapping[str, Any]] = {
    "hene_laser": {"power": 1.0, "polarization_ratio": None},
    "plano_convex_100": {"radius_of_curvature": None, "transmission": 1.0},
    "linear_polarizer": {"extinction": None, "transmission": 1.0, "thickness": None},
    "half_wave_plate": {"transmission": 1.0},
    "quarter_wave_plate": {"transmission": 1.0},
    "mirror_tip_tilt": {"reflectance": 1.0},
    "beam_splitter_50_50": {"transmittance": 0.5, "reflectance": 0.5},
}
"""What an ideal part has instead of what the catalog says."""


def kind(name: str, **parameters: Any) -> ComponentType:
    """Return a type of the catalog as an ideal one with these parameters, in its units; None: without it."""
    base = CATALOG[name]
    found = dict(base.parameters)
    for key, value in {**IDEAL.get(name, {}), **parameters}.items():
        unit = found[key].unit if key in found else ""
        found.pop(key, None)
        if value is not None:
            found[key] = Parameter(value=value, unit=unit)
    return replace(base, parameters=found)


def setup_of(kinds: Mapping[str, ComponentType], size: tuple[float, float] = (2400.0, 1200.0)) -> Setup:
    """Return a bench whose parts each have a type of their own."""
    types = {name: replace(given, name=f"type_{name}") for name, given in kinds.items()}
    parts = {name: Part(type=f"type_{name}", home="none") for name in kinds}
    return Setup(lab=Lab(name="light", table=Table(size=size), robots={}, inventory=parts), catalog={
        given.name: given for given in types.values()
    })  # fmt: skip


def light(
    kinds: Mapping[str, ComponentType], poses: Mapping[str, Pose], values: Mapping[str, Mapping[str, Any]] | None = None
) -> Light:
    """Return the light of a bench whose lasers all shine."""
    return light_of(setup_of(kinds), poses, values, lit=lambda _: True)
