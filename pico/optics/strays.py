"""What faces of glass send astray: beams too weak for a measurement, and of a strong laser too strong for an eye.

`meet` of an element leaves them out, but for ghosts of plates with `coating: none`; who audits light asks for them,
too, by the `strays` of an element. A face that is not coated sends back what Fresnel's equations say; one that is,
`face_reflectance` of its type, 0.5 % where that is not given: what a usual anti-reflection coating stays below over its
band. Two reflections inside a lens count, too; of a plate and a cube only one: two of 4 % each are a part in 600.
"""

from __future__ import annotations

import math
from dataclasses import replace

from pico.optics.beam import Amplitudes, Beam, beyond, scaled
from pico.optics.part import Met, Part
from pico.optics.plates import faces
from pico.optics.rays import Surface

RESIDUAL = 0.005
"""What a coated face sends back where its type does not say [share of the power]."""
GLASS = 1.5
"""The refractive index of glass whose type does not say."""


def of_plate(part: Part, met: Met) -> tuple[Beam, ...]:
    """Return what both faces of a plate send back of a beam that it has met, as one beam."""
    if part.word("coating", "") == "none" and part.kind.number("thickness", "mm"):
        return ()  # its ghosts are there already
    back, _ = face(part, 1.0, part.number("refractive_index", "", GLASS))
    sent = beyond(passing(met), Surface(part.center, part.axes[0]), reflect=True, amplitudes=back)
    return () if sent is None else astray(scaled(sent, math.sqrt(2.0)))


def face(part: Part, before: float, after: float) -> tuple[Amplitudes, Amplitudes]:
    """Return the amplitudes that a face of a part sends back and lets through."""
    if part.word("coating", "anti-reflection") == "none" or part.word("substrate", "") == "glass":
        return faces(before, after)
    share = part.number("face_reflectance", "", RESIDUAL)
    back, on = math.sqrt(share), math.sqrt(1 - share)
    return lambda _: (back, back), lambda _: (on, on)


def passing(met: Met) -> Beam:
    """Return a beam as it came to a part, without what its edge stopped."""
    return scaled(met.came, math.sqrt(1.0 - met.clipped))


def astray(*beams: Beam | None) -> tuple[Beam, ...]:
    """Return beams that there are, as ghosts."""
    return tuple(replace(b, ghost=True) for b in beams if b is not None)
