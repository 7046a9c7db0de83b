"""A beam splitter cube: a coating that passes one part of a beam and sends another to the side."""

from __future__ import annotations

import math

import numpy as np

from pico.optics.beam import Beam, beyond
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.rays import Surface
from pico.optics.strays import GLASS, astray, face, passing


def meet(part: Part, beam: Beam) -> Met:
    """Divide a beam at the coating. `transmittance` and `reflectance` are shares of the power, of a polarizing one of p
    and s; there `extinction` is by how much less of s passes, no more of s is sent than is left, and
    `reflected_extinction` by how much less of p than of s is sent; without it all p that does not pass is.

    What is reflected comes a quarter of a wave later, from either side, as a coating without loss must have it: the
    field along the coating does, and so p = s x along has the other sign, as at a mirror."""
    normal = np.array(part.optic.normal)
    came = arrived(part, beam, normal=normal)
    passed, lost = clipped(part, came, part.optic.radius)
    coating = Surface(part.center, normal)
    through, back = part.number("transmittance", "", 0.5), part.number("reflectance", "", 0.5)
    polarizing = part.kind.parameters.get("polarizing")
    shares = (through, through), (back, back)
    if polarizing is not None and polarizing.value is True:
        leaks = through / part.number("extinction", "", math.inf)
        sent_s = min(back, 1 - leaks)
        pure = part.number("reflected_extinction", "", 0.0)
        shares = (leaks, through), (sent_s, min(1 - through, sent_s / pure) if pure else 1 - through)
    (t_s, t_p), (r_s, r_p) = ((math.sqrt(s), math.sqrt(max(p, 0.0))) for s, p in shares)
    on = beyond(passed, coating, amplitudes=lambda _: (t_s, t_p))
    sent = beyond(passed, coating, reflect=True, amplitudes=lambda _: (1j * r_s, -1j * r_p))
    return Met(came, tuple(b for b in (on, sent) if b is not None and b.waves), lost)


def strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what the faces of the cube send back: that where light comes in, and each where it goes out, of which the
    coating makes two."""
    back, _ = face(part, 1.0, part.number("refractive_index", "", GLASS))
    found: list[Beam] = []
    for one, enters in ((passing(met), True), *((b, False) for b in met.onward)):
        square = max(part.axes[:2], key=lambda axis: abs(float(axis @ one.along)))
        sent = beyond(one, Surface(one.at, square), reflect=True, amplitudes=back)
        if sent is not None:
            found += [sent] if enters else meet(part, sent).onward
    return astray(*found)
