"""A lens: its two surfaces where its type gives them, else a thin one of its focal length."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pico.model.catalog import ComponentType
from pico.model.materials.glass import DESIGN, index_at
from pico.optics import gaussian
from pico.optics.beam import Beam, Wave, beyond, level, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.polarization import Vector, carried, plane_of_incidence, product
from pico.optics.rays import Surface
from pico.optics.strays import GLASS, astray, face, of_plate


def surfaces(part: Part, edge: float, wavelength: float) -> tuple[Surface, ...]:
    """Return the two surfaces of a lens with an edge of a radius [mm] for light of a wavelength in vacuum [nm], that
    with the lesser local x first; none where its type does not tell `center_thickness`, `refractive_index`, and
    `radius_of_curvature` or `form`.

    The parameter is the radius of the side that light along local +x meets first, above 0 where that bulges towards it;
    `radius_of_curvature_back` that of the other, above 0 where that bulges away, flat where it is not given.
    """
    kind = part.kind
    thickness, index = kind.number("center_thickness", "mm"), kind.number("refractive_index", "")
    radius, back = _radii(kind, thickness, index)
    if radius is None or thickness is None or index is None or "cylinder_axis" in kind.parameters:
        return ()
    along, index = part.axes[0], refraction(part, index, wavelength)
    half = thickness / 2 * along
    return (
        Surface(part.center - half, along, 1 / radius if radius else 0.0, edge, 1.0, index),
        Surface(part.center + half, along, -1 / back if back else 0.0, edge, index, 1.0),
    )


def refraction(part: Part, index: float, wavelength: float) -> float:
    """Return the index of a lens at a wavelength [nm], of which it has `index` at its `design_wavelength`."""
    return index_at(part.word("glass", ""), index, part.number("design_wavelength", "nm", DESIGN), wavelength)


def _radii(kind: ComponentType, thickness: float | None, index: float | None) -> tuple[float | None, float | None]:
    """Return the radii of the first side and of the back [mm], None where they are not known.

    The `form` of a lens has them follow from its focal length, by the lensmaker's equation for a thick one: `plano`,
    the first side alone, (n - 1) f; `bi`, both alike, 1/f = (n - 1) (2/R - (n - 1) t / (n R^2)).
    """
    form, focal = kind.parameters.get("form"), kind.number("focal_length", "mm")
    if form is None or focal is None or index is None:
        return kind.number("radius_of_curvature", "mm"), kind.number("radius_of_curvature_back", "mm")
    plano = focal * (index - 1)
    if form.value == "plano":
        return plano, None
    both = plano * (1 + math.sqrt(max(0.0, 1 - (thickness or 0.0) / (index * focal))))
    return both, both


def meet(part: Part, beam: Beam) -> Met:
    """Bend a beam, after the edge has stopped what is beside it."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    share = math.sqrt(part.number("transmission", "", 1.0))
    # around a chief ray beside the edge there may be light that passes
    wavelength = beam.wavelength * 1e6
    ways = surfaces(part, part.optic.radius + came.widths[0], wavelength)
    if not ways:
        return Met(came, (scaled(thin(passed, part.center, part.axes[0], power(part, wavelength)), share),), lost)
    behind: Beam | None = scaled(beam, math.sqrt(1 - lost) * share)
    for surface in ways if beam.along @ part.axes[0] > 0 else ways[::-1]:
        behind = beyond(behind, surface) if behind is not None else None
    if behind is None:
        return Met(came, clipped=lost, event="blocked")
    return Met(came, (replace(behind, unknown=passed.unknown),), lost)


def power(part: Part, wavelength: float) -> Vector:
    """Return the refractive power (3, 3) [1/mm] of a thin lens in light of a wavelength [nm]: what its change of slope
    is per distance from its axis.

    One with the parameter `cylinder_axis` has it only across that line, which is level at 0 deg."""
    _, left, up = part.axes
    strength = 1 / part.number("focal_length", "mm", math.inf)
    if index := part.kind.number("refractive_index", ""):
        strength *= (refraction(part, index, wavelength) - 1) / (index - 1) if index != 1 else 1.0
    line = part.kind.number("cylinder_axis", "deg")
    if line is None:
        return strength * (np.outer(left, left) + np.outer(up, up))
    across = math.cos(math.radians(line)) * up - math.sin(math.radians(line)) * left
    return strength * np.outer(across, across)


def thin(came: Beam, center: Vector, axis: Vector, bends: Vector) -> Beam:
    """Return a beam at the plane of a thin lens of a refractive power (3, 3), bent by it."""
    normal = axis if came.along @ axis > 0 else -axis
    facing = float(came.along @ normal)
    along = came.along / facing - bends @ (came.at - center)
    along = along / np.linalg.norm(along)
    s = plane_of_incidence(came.along, normal, came.up)
    across = level(along, carried(came.across, came.along, along, s))
    axes = np.stack([s, product(normal, s)])
    before, after = came.frame @ axes.T, np.stack([across, product(along, across)]) @ axes.T
    flat = np.zeros((2, 2))
    mapped = gaussian.through(came.curvature, before, np.eye(2), (1, 1), (1, 1), flat) - axes @ bends @ axes.T
    curvature = gaussian.through(mapped, np.eye(2), after, (1, 1), (1, 1), flat)
    back = np.linalg.inv(after).T @ before.T
    arrives, leaves = product(s, came.along), product(s, along)
    waves = tuple(Wave((w.field @ s) * s + (w.field @ arrives) * leaves, back @ w.shift, w.group) for w in came.waves)
    return replace(came, along=along, across=across, curvature=curvature, waves=waves)


def strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what the two faces of a lens send back, and the ghost of both; of a thin one as of a flat plate."""
    ways = surfaces(part, part.optic.radius + met.came.widths[0], beam.wavelength * 1e6)
    if not ways:
        return of_plate(part, met)
    begun = scaled(beam, math.sqrt(1.0 - met.clipped))
    first, last = ways if beam.along @ part.axes[0] > 0 else ways[::-1]
    glass = part.number("refractive_index", "", GLASS)
    (sends, lets), (keeps, frees) = face(part, 1.0, glass), face(part, glass, 1.0)
    entered = beyond(begun, first, amplitudes=lets)
    back = entered and beyond(entered, last, reflect=True, amplitudes=keeps)
    again = back and beyond(back, first, reflect=True, amplitudes=keeps)
    return astray(
        beyond(begun, first, reflect=True, amplitudes=sends), back and beyond(back, first, amplitudes=frees),
        again and beyond(again, last, amplitudes=frees),
    )  # fmt: skip
