"""What a laser emits, by its type and by what it is set to."""

from __future__ import annotations

import math

import numpy as np

from pico.optics import gaussian
from pico.optics.beam import Beam, Wave
from pico.optics.coherence import Spectrum, spectra_of
from pico.optics.part import Part


def emit(part: Part) -> Beam:
    """Return the beam at the exit: from the parameters `wavelength`, `power`, `waist_radius`, `waist_position` (of the
    waist, ahead of the exit), `waist_radius_up` and `waist_position_up` where upright it is another, `quality` (M2),
    `polarization`, `polarization_ratio`, of which a tunable of the same name wins. Its way may be turned by `walk_left`
    and `walk_up` [mrad], and its power be another by the share `walk_power`: what the world does, and no tunable of a
    type. What is polarized across does not interfere with the rest, nor do lines of its spectrum that are polarized
    otherwise."""
    wavelength = part.value("wavelength", "nm", part.number("wavelength", "nm", 632.8)) * 1e-6
    power = part.value("power", "mW", part.number("power", "mW", 1.0))
    power *= max(0.0, 1 + float(part.values.get("walk_power", 0.0)))
    power *= (1.0 - part.unseen.loss) * part.unseen.power
    waist, quality = part.number("waist_radius", "mm", 0.5), part.number("quality", "", 1.0)
    angle = part.number("polarization", "deg", 0.0)
    across = part.number("polarization_ratio", "", math.inf)
    weak = 0.0 if math.isinf(across) else 1 / (1 + across)
    along, left, up = part.axes
    walked = [float(part.values.get(name, 0.0)) * 1e-3 for name in ("walk_left", "walk_up")]
    if any(walked):
        along = along + walked[0] * left + walked[1] * up
        along /= np.linalg.norm(along)
        left = np.cross(up, along)
        left /= np.linalg.norm(left)
        up = np.cross(along, left)
    waves: list[Wave] = []
    spectra: list[Spectrum] = []
    for own, share, spectrum in spectra_of(part.kind, part.number("wavelength", "nm", 632.8)):
        turned = math.radians(angle if own is None else own)
        for way, much in ((turned, 1 - weak), (turned + math.pi / 2, weak)):
            field = math.sqrt(power * share * much) * (math.cos(way) * left + math.sin(way) * up)
            if field.any():
                waves.append(Wave(field.astype(complex), np.zeros(2, dtype=complex), len(spectra)))
                spectra.append(spectrum)
    behind = -part.number("waist_position", "mm", 0.0)
    curvature = gaussian.from_waist(waist, wavelength * quality, behind)
    if (own := part.kind.number("waist_radius_up", "mm")) is not None:
        later = -part.number("waist_position_up", "mm", -behind)
        curvature[1, 1] = gaussian.from_waist(own, wavelength * quality, later)[1, 1]
    return Beam(
        part.name, wavelength, part.origin, along, left, curvature, tuple(waves), quality,
        spectra=tuple(spectra) if any(spectra) else (),
    )  # fmt: skip
