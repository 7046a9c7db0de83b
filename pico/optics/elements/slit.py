"""A slit: what lies between its two edges passes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam, moments, scaled
from pico.optics.part import SPOT, Met, Part, arrived, clipped


def meet(part: Part, beam: Beam) -> Met:
    """Stop what is beside the edges: `width` apart, a tunable or a parameter, along a line at `angle` from level. The
    share that passes is the Gaussian's between them; where that is less than SPOT the spot behind is diffraction's."""
    came = arrived(part, beam)
    inside, lost = clipped(part, came, part.optic.radius)
    half = part.value("width", "mm", part.number("width", "mm", 2 * part.optic.radius)) / 2
    turned = math.radians(part.value("angle", "deg", part.number("angle", "deg", 90.0)))
    _, left, up = part.axes
    across = came.frame @ (math.cos(turned) * up - math.sin(turned) * left)
    across = across / np.linalg.norm(across)
    k = came.wave_number
    spread = math.sqrt(float(across @ np.linalg.inv(k * np.imag(came.curvature)) @ across) / 2)  # one deviation
    middle = float(across @ (came.frame @ (came.at - part.center) + moments(came)[1]))
    share = (math.erf((half - middle) / spread / math.sqrt(2)) + math.erf((half + middle) / spread / math.sqrt(2))) / 2
    passed = scaled(inside, math.sqrt(max(0.0, share)))
    if share < SPOT and not passed.unknown:
        text = f"{part.name} lets only {100 * share:.2g} % of the beam through, and its spot is diffraction's then"
        passed = replace(passed, unknown=text)
    return Met(came, (passed,), 1 - (1 - lost) * max(0.0, share))
