"""Between which values a mirror may be turned, for the beam audit.

Above class 3R that is the full range of its screws. Up to class 3R it is what it is set to and what it may be driven
to, widened by the tolerance and the backlash of its axis. A value that is unknown, and an axis without a position (open
loop), count with the full range at any class.
"""

from __future__ import annotations

from pico.optics.audit.branches import Branches
from pico.optics.part import Part

OVER = 2.0
"""By how many times its backlash an axis may go beyond a value that it comes to."""


def turns(branches: Branches, part: Part, tunable: str) -> tuple[float, float] | None:
    """Return between which values a tunable that a part has may be turned, in its unit; None if it has no range."""
    kind, value = part.kind.tunables[tunable], part.values.get(tunable)
    known = isinstance(value, int | float) and not isinstance(value, bool)
    blind = kind.axis is not None and kind.axis.kind == "open_loop"
    if not branches.ordinary or not known or blind or kind.range is None:
        return kind.range
    here = float(value)  # type: ignore[arg-type]
    low, high = branches.spans.get(part.name, {}).get(tunable, (here, here))
    over = kind.tolerance + (OVER * kind.axis.backlash if kind.axis else 0.0)
    return min(low, here) - over, max(high, here) + over
