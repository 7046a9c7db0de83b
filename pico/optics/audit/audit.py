"""The beam audit: every branch of every laser that shines, judged.

Light is followed as `pico.optics.light` does, with what faces of glass send astray (`pico.optics.strays`), down to a
tenth of the class 1 limit: ten branches below that would have to meet. Where no limit is known a millionth of the
laser's power is followed, and every branch counts. The limits are those of IEC 60825-1, see `pico.optics.audit.limits`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from functools import partial
from itertools import product

from pico.model.arming import CLASSES
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.audit.branches import Branches
from pico.optics.audit.damage import damaged, unjudged
from pico.optics.audit.ends import open_ends
from pico.optics.audit.findings import Audit, Finding, Spans
from pico.optics.audit.lasers import laser_class, lasers_of
from pico.optics.audit.limits import class_1, class_of
from pico.optics.audit.plane import out_of_plane
from pico.optics.audit.unsettled import told_with, unsettled
from pico.optics.axis import Values
from pico.optics.beam import Beam
from pico.optics.light import Light, light_of

FOLLOWED = 0.1
"""The share of the class 1 limit below which a branch is followed no more."""
STRICT = 1e-6
"""The same as a share of the laser's power, where no limit is known."""


def audit(
    setup: Setup, poses: Mapping[str, Pose], values: Values, lasers: Collection[str] | None = None,
    spans: Spans | None = None,
) -> Audit:  # fmt: skip
    """Return the verdict on the light among what stands at `poses`, tunables set to `values` in the units of the
    catalog; of these `lasers`, else of those that shine. What nobody knows is taken at each value that it may have.
    `spans`: between which values tunables may be driven meanwhile."""
    lit = tuple(sorted(lasers)) if lasers is not None else lasers_of(setup, poses, values)

    def traced(laser: str, changed: Values) -> Light:
        return light_of(setup, poses, changed, lit=lambda name: name == laser, astray=_least)

    found: dict[str, Finding] = {}
    classes, unsaid = {}, set[str]()
    for laser, (known, taken) in product(lit, unsettled(setup, poses, values) if lit else ()):
        light = traced(laser, known)
        if not light.crossings:
            continue
        first = light.crossings[0]
        wavelength = first.beam.wavelength * 1e6
        of = class_of(first.power, wavelength), laser_class(setup, laser, known.get(laser, {}))[0]
        classes[laser] = max(of, key=CLASSES.index)  # what is unknown of the laser counts as the most dangerous
        branches = Branches(setup, light, laser, classes[laser], class_1(wavelength), spans or {})
        for one in _judged(branches, partial(traced, laser), known):
            if one.branch not in found or one.power > found[one.branch].power:
                found[one.branch] = told_with(one, taken)
        unsaid |= set(unjudged(branches))
    return Audit(findings=tuple(found.values()), lasers=classes, unjudged=tuple(sorted(unsaid)))


def _judged(branches: Branches, traced: Callable[[Values], Light], values: Values) -> Iterator[Finding]:
    yield from open_ends(branches)
    yield from out_of_plane(branches, traced, values)
    yield from damaged(branches)


def _least(first: Beam) -> float:
    limit = class_1(first.wavelength * 1e6)
    return STRICT * first.power if limit is None else FOLLOWED * limit
