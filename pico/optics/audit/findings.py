"""What the beam audit found, as plain data: it is kept in a cache, and read back without numpy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from pico.diagnostics import Diagnostic, error, warning
from pico.model.arming import LaserClass
from pico.model.plan import AUDIT
from pico.model.record import record
from pico.optics.audit.limits import above_class_2

Kind = Literal["end", "edge", "plane", "damage", "lost", "endless", "carried"]
"""`end`: it ends on no block; `edge`: what an aperture stops; `plane`: it may leave the plane of the table; `damage`:
too strong for a part; `lost`: a part keeps it and does not say how; `endless`; `carried`: an arm carries a part through
it."""

Spans = Mapping[str, Mapping[str, tuple[float, float]]]
"""Between which values, in the units of the catalog, tunables may be driven while light is on, by component."""
ORDINARY: LaserClass = "3R"
"""Up to this class only what a mirror may be driven to counts, and housings end beams; above it the full range, and
blocks alone."""


@record
class Finding:
    """One branch that is dangerous.

    It goes from `source` through the parts of `way`, in order, to the point `at` [mm] that `where` speaks of, on a
    `component` or, where that is empty, off the table. `power` and `limit` [mW], the latter None where none is known;
    of `damage` both are irradiances [mW/mm2]. `path`: the branch from above, as points [mm].
    """

    kind: Kind
    source: str
    laser_class: LaserClass
    way: tuple[str, ...]
    where: str
    power: float
    limit: float | None
    component: str = ""
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    path: tuple[tuple[float, float], ...] = ()
    hint: str = ""
    # Where a search, or a tunable that is driven, leads to this, in words; empty if it is so where the plan leads to.
    searched: str = ""

    @property
    def dangerous(self) -> bool:
        """Whether it is of a laser that must not be opened for it: one above class 2."""
        return above_class_2(self.laser_class)

    @property
    def branch(self) -> str:
        """The branch in words: `laser → bs → leaves the table at (1200, 420)`."""
        return " → ".join([self.source, *self.way, self.where])

    @property
    def text(self) -> str:
        """The branch with its power and the limit."""
        unit = "mW/mm²" if self.kind == "damage" else "mW"
        if self.kind == "carried":
            return f"{self.branch}: {self.power:.3g} mW, class {self.laser_class}"
        if self.limit is None:
            return f"{self.branch}: {self.power:.3g} mW, and no limit is known at its wavelength"
        of = "" if self.kind == "damage" else " of class 1"
        return f"{self.branch}: {self.power:.3g} {unit}, above the limit{of} of {self.limit:.3g} {unit}"


@record
class Audit:
    """The verdict on the light of a bench. `lasers`: the class of each that shines; `unjudged`: parts in beams above
    the class 1 limit that give no `damage_threshold`."""

    findings: tuple[Finding, ...] = ()
    lasers: Mapping[str, LaserClass]
    unjudged: tuple[str, ...] = ()

    @property
    def passes(self) -> bool:
        """Whether nothing was found of a laser above class 2."""
        return not any(f.dangerous for f in self.findings)


def audit_from_json(data: Mapping[str, Any]) -> Audit:
    """Return the audit whose `as_json` gave `data`; raises KeyError, TypeError or ValueError for anything else."""
    findings = []
    for one in data["findings"]:
        path = tuple((float(x), float(y)) for x, y in one["path"])
        x, y, z = one["at"]
        findings.append(Finding(**{"limit": None, **one, "way": tuple(one["way"]), "at": (x, y, z), "path": path}))
    return Audit(findings=tuple(findings), lasers=dict(data["lasers"]), unjudged=tuple(data["unjudged"]))


def told(audit: Audit, *, refused: frozenset[str], drawn: str) -> tuple[Diagnostic, ...]:
    """Return the findings as diagnostics, those of one cause as one with a count: an error where it is of a laser above
    class 2 among `refused`, else a warning. `drawn`: what to type for a picture with the branch in red."""
    causes: dict[tuple[str, ...], list[Finding]] = {}
    for one in audit.findings:
        causes.setdefault(_cause(one), []).append(one)
    return tuple(_said(of, refused, drawn) for of in causes.values())


def _cause(one: Finding) -> tuple[str, ...]:
    """Return what findings of one cause have in common: a search, else how and on which part a beam ends."""
    if one.searched:
        return (one.source, "searched")
    return (one.source, one.kind, one.component or one.where)


def _said(of: list[Finding], refused: frozenset[str], drawn: str) -> Diagnostic:
    """Return findings of one cause in words: the most powerful, and how many there are."""
    one = max(of, key=lambda f: f.power)
    text = f"the beam of {one.source} (class {one.laser_class}) is not safe: {one.text}"
    reached = ""
    if one.searched:
        reached = f"the search can reach this at {one.searched}: narrow its bounds, or end the beam in a block"
    if len(of) > 1:
        text += f", the most powerful of {len(of)} such branches"
    hint = "; ".join(words for words in (reached, one.hint, f"{drawn} draws it in red" if one.path else "") if words)
    tell = error if one.dangerous and one.source in refused else warning
    return tell(AUDIT, text, hint=hint, address=one.component or one.source)
