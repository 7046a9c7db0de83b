"""Plane-parallel plates: how they walk a beam aside, and the ghosts of faces that are not coated."""

from __future__ import annotations

import math
from dataclasses import replace

from pico.optics.beam import Amplitudes, Beam, beyond, forward
from pico.optics.part import Part
from pico.optics.polarization import fresnel
from pico.optics.rays import Surface


def plate(part: Part, came: Beam) -> tuple[Beam, ...]:
    """Return the beams behind a plate whose middle a beam has come to: that which passes, and of faces `coating: none`
    also the ghosts, once to and fro: back off the front, back off the rear, and on after both.

    Without the parameters `thickness` and `refractive_index` it is thin, and without that `coating` clear.
    """
    thickness, index = part.kind.number("thickness", "mm"), part.kind.number("refractive_index", "")
    if not thickness or not index:
        return (came,)
    side = 1.0 if came.along @ part.axes[0] > 0 else -1.0
    normal = side * part.axes[0]
    front = Surface(part.center - thickness / 2 * normal, normal, before=1.0, after=index)
    rear = Surface(part.center + thickness / 2 * normal, normal, before=index, after=1.0)
    before = forward(came, -thickness / float(came.along @ normal))
    if part.word("coating", "anti-reflection") != "none":
        inside = beyond(before, front)
        behind = beyond(inside, rear) if inside else None
        return (behind,) if behind else ()
    return _bare(before, front, rear, index)


def _bare(before: Beam, front: Surface, rear: Surface, index: float) -> tuple[Beam, ...]:
    enters, leaves = faces(1.0, index), faces(index, 1.0)
    inside = beyond(before, front, amplitudes=enters[1])
    if inside is None:
        return ()
    found = [
        beyond(inside, rear, amplitudes=leaves[1]),
        beyond(before, front, reflect=True, amplitudes=enters[0]),
    ]
    back = beyond(inside, rear, reflect=True, amplitudes=leaves[0])
    if back is not None:
        found.append(beyond(back, front, amplitudes=leaves[1]))
        again = beyond(back, front, reflect=True, amplitudes=leaves[0])
        found.append(beyond(again, rear, amplitudes=leaves[1]) if again else None)
    main, *ghosts = found
    return tuple(b for b in (main, *(replace(g, ghost=True) for g in ghosts if g)) if b)


def faces(before: float, after: float) -> tuple[Amplitudes, Amplitudes]:
    """Return the amplitudes that a face sends back and lets through, of which the squares are shares of the power."""

    def back(cosine: float) -> tuple[complex, complex]:
        return fresnel(before, after, cosine)[:2]

    def on(cosine: float) -> tuple[complex, complex]:
        inside = math.sqrt(max(0.0, 1 - (before / after) ** 2 * (1 - cosine**2)))
        size = math.sqrt(after * inside / (before * cosine))
        _, _, s, p = fresnel(before, after, cosine)
        return s * size, p * size

    return back, on
