"""A Faraday isolator: light passes along local +x, and hardly the other way."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam, Wave
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.polarization import Field, product
from pico.optics.strays import of_plate

_TGG = 258.2
"""The wavelength of the transition that turns light in terbium gallium garnet [nm]."""


def missed(part: Part, wavelength: float) -> float:
    """Return by how much the rotation of an isolator misses 45 degrees [rad] at a wavelength [nm]: that goes as
    1 / (w^2 - w0^2), and is right at `design_wavelength`."""
    design = part.number("design_wavelength", "nm", wavelength)
    turned = (design**2 - _TGG**2) / (max(wavelength, _TGG + 1.0) ** 2 - _TGG**2)
    return math.radians(45.0) * (turned - 1.0)


def meet(part: Part, beam: Beam) -> Met:
    """Pass what is level along local +x, turned by 45 degrees, and `transmission` of it: the field is then at `output`
    [deg]. What comes the other way leaves level, less by `isolation` [dB], however it is polarized. What the rotation
    misses at the wavelength of the light is lost forward and let through backward."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    ahead, left, up = part.axes
    forward = float(came.along @ ahead) > 0
    output = math.radians(part.number("output", "deg", 45.0))
    leaves = math.cos(output) * left + math.sin(output) * up if forward else left
    leaves = leaves - (leaves @ came.along) * came.along
    leaves = leaves / np.linalg.norm(leaves)
    enters = product(came.along, product(left, came.along))
    enters = enters / np.linalg.norm(enters)
    through, off = part.number("transmission", "", 1.0), missed(part, beam.wavelength * 1e6)
    leak = 10 ** (-part.number("isolation", "dB", 30.0) / 10)
    share = through * math.cos(off) ** 2 if forward else min(1.0, leak + through * math.sin(off) ** 2)

    def behind(wave: Wave) -> Field:
        size = complex(wave.field @ enters) if forward else complex(np.linalg.norm(wave.field))
        return np.asarray(math.sqrt(share) * size * leaves, dtype=np.complex128)

    waves = tuple(replace(w, field=behind(w)) for w in passed.waves)
    return Met(came, (replace(passed, waves=waves),), lost)


def strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what its faces send back; what its polarizers reject ends inside."""
    return of_plate(part, met)
