"""A coated plate that passes a part of a beam and reflects another: plate and pellicle splitters, dichroics."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam, beyond, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.rays import Surface


def meet(part: Part, beam: Beam) -> Met:
    """Divide a beam at the coating, on the face that looks along local -x.

    `transmittance` and `reflectance` are shares of the power; with `cut_on` they are those of what is longer, and of
    what is shorter than that wavelength the shares are `transmittance_below` and `reflectance_below`. The plate behind
    has `thickness` and `refractive_index`, without which it is as thin as a pellicle; its other face sends back the
    share `rear_reflectance`, as a ghost. What is reflected comes a quarter of a wave later, as at a cube's coating.
    """
    normal = np.array(part.optic.normal)
    came = arrived(part, beam, normal=normal)
    passed, lost = clipped(part, came, part.optic.radius)
    t, r = (math.sqrt(share) for share in shares(part, beam.wavelength * 1e6))
    thickness, index = part.number("thickness", "mm", 0.0), part.number("refractive_index", "", 1.0)
    if not thickness:
        coating = Surface(part.center, normal)
        on = beyond(passed, coating, amplitudes=lambda _: (t, t))
        sent = beyond(passed, coating, reflect=True, amplitudes=lambda _: (1j * r, -1j * r))
        return Met(came, tuple(b for b in (on, sent) if b is not None and b.power > 0), lost)
    bare = math.sqrt(part.number("rear_reflectance", "", 0.0))
    clear = math.sqrt(1 - bare**2)
    coated = _Face(Surface(part.center, normal, before=index, after=1.0), (t, t), (1j * r, -1j * r))
    rear = _Face(
        Surface(part.center - thickness * normal, normal, before=1.0, after=index), (clear, clear), (-bare, bare)
    )
    faces = (coated, rear) if beam.along @ normal < 0 else (rear, coated)
    found = _through(scaled(beam, math.sqrt(1 - lost)), *faces)
    return Met(came, tuple(replace(b, unknown=passed.unknown, ghost=b.ghost or came.ghost) for b in found), lost)


def shares(part: Part, wavelength: float) -> tuple[float, float]:
    """Return which shares of the power a coating passes and reflects at a wavelength [nm]."""
    cut = part.kind.number("cut_on", "nm")
    below = "_below" if cut is not None and wavelength < cut else ""
    return part.number(f"transmittance{below}", "", 0.5), part.number(f"reflectance{below}", "", 0.5)


class _Face:
    """A face with its amplitudes of s and p: of what passes, and of what is sent back."""

    def __init__(self, surface: Surface, on: tuple[complex, complex], back: tuple[complex, complex]) -> None:
        self.surface, self.on, self.back = surface, on, back

    def passes(self, beam: Beam | None) -> Beam | None:
        return beam and beyond(beam, self.surface, amplitudes=lambda _: self.on)

    def sends(self, beam: Beam | None) -> Beam | None:
        return beam and beyond(beam, self.surface, reflect=True, amplitudes=lambda _: self.back)


def _through(beam: Beam, first: _Face, second: _Face) -> tuple[Beam, ...]:
    """Return what passes two faces, what the first sends back, and what the second does, through the first again. What
    goes to and fro once more is left out."""
    inside = first.passes(beam)
    on, sent, again = second.passes(inside), first.sends(beam), first.passes(second.sends(inside))
    main = max((b.power for b in (sent, again) if b is not None and b.waves), default=0.0)
    found = [on, *(replace(b, ghost=b.power < main / 2) for b in (sent, again) if b is not None)]
    return tuple(b for b in found if b is not None and b.waves and b.power > 0)
