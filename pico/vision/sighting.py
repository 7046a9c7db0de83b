"""What was seen of a bench, and what was wrong with what was seen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Literal

from pico.diagnostics import Diagnostic, error, warning
from pico.model.observation import Uncertainty
from pico.model.pose import Pose
from pico.model.record import record

How = Literal["stereo", "known height", "in hand"]
Kind = Literal[
    "duplicate", "conflict", "unknown", "half-seen", "hidden", "tilted", "height", "size", "datum", "datums",
    "dark",
]  # fmt: skip

HINTS: Mapping[Kind, str] = {
    "duplicate": "each number may be on the table once: print another marker for one of them",
    "conflict": "look for a second marker with this number, or recalibrate with `pico calibrate`",
    "unknown": "`pico import` takes it into the inventory; or take it off the table",
    "half-seen": "clear the view of the cameras, clean the marker, or move the part by hand",
    "hidden": "clear the view of the cameras, or put the part back where they see it",
    "tilted": "stand it upright by hand",
    "height": "put the right marker on it, or correct `geometry.marker` of its type",
    "size": "print markers at 100 % (measure the bar on the sheet), or correct `geometry.marker.size` of its type",
    "datum": "screw it down where the lab says, or correct `datums`",
    "datums": "the lab needs three datums or more that every camera sees",
    "dark": "check its cable, its exposure and the light, then look again",
}
_WRONG: frozenset[Kind] = frozenset(("duplicate", "conflict", "tilted", "height", "dark"))


@record
class SeenPart:
    """A component as it was seen: its pose with one standard deviation, and how.

    `height` of the marker [mm], as measured or, at known height, as its type has it; `cameras` that saw it.
    """

    pose: Pose
    uncertainty: Uncertainty
    how: How
    height: float
    cameras: tuple[str, ...]


@record
class Stranger:
    """A marker that the inventory does not have: where it is, how high above the table and how large [mm]."""

    marker: int
    pose: Pose
    uncertainty: Uncertainty
    height: float
    size: float


@record
class Finding:
    """Something that was not as it should be. `at`: where on the table [mm], where that is known."""

    kind: Kind
    text: str
    component: str | None = None
    marker: int | None = None
    at: tuple[tuple[float, float], ...] = ()

    def diagnostic(self) -> Diagnostic:
        """Return the finding as a user is told of it."""
        make = error if self.kind in _WRONG else warning
        return make(f"marker-{self.kind}", self.text, hint=HINTS[self.kind], address=self.component or "")


@record
class CameraMoved:
    """A camera that is not where it was when it was calibrated: by how much [mm, deg], and what that does to a
    position on the table [mm]."""

    camera: str
    shift: float
    turn: float
    effect: float

    def diagnostic(self) -> Diagnostic:
        """Return why nothing that this camera says counts."""
        return error(
            "calibration-drift",
            f"camera `{self.camera}` has moved by {self.shift:.1f} mm and turned by {self.turn:.2f} deg since it was "
            f"calibrated: all datums are seen off by {self.effect:.1f} mm together",
            detail="Positions from its pictures are wrong by as much, so they are neither captured nor acted on.",
            hint="recalibrate with `pico calibrate`",
        )


@record
class Sighting:
    """What the cameras saw of a bench. Only what is certain has a pose; the rest is in `findings`.

    `drift`: cameras that have moved since they were calibrated. Where there are any, nothing here may be acted on.
    `toppled`: components that lie or lean. `checked`: cameras whose datums say that they have not moved;
    `dark`: cameras whose pictures were black. `datums`: how far from its place the farthest datum is seen by each
    camera as it was calibrated [mm]: what the calibration has drifted by.
    """

    components: Mapping[str, SeenPart] = field(default_factory=dict)
    unknown: Mapping[str, Stranger] = field(default_factory=dict)
    toppled: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()
    drift: tuple[CameraMoved, ...] = ()
    checked: tuple[str, ...] = ()
    dark: tuple[str, ...] = ()
    datums: Mapping[str, float] = field(default_factory=dict)

    @property
    def trusted(self) -> bool:
        """Whether the cameras are where they were when they were calibrated, as far as datums tell."""
        return not self.drift

    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Return everything that a user should know, what stops the work first."""
        return (*(d.diagnostic() for d in self.drift), *(f.diagnostic() for f in self.findings))

    def of(self, kind: Kind) -> tuple[Finding, ...]:
        """Return the findings of a kind."""
        return tuple(f for f in self.findings if f.kind == kind)
