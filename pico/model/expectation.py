"""What became of the expectations of a state, and whether the bench is as it says."""

from __future__ import annotations

from pico.diagnostics import ExitCode
from pico.model.diff import Change
from pico.model.proof import Standing
from pico.model.record import record


@record
class Expected:
    """One expectation against the bench. `holds`: None where that is unknown, which counts as a failure, unless it was
    not `assured`: then it speaks of what nobody measured. `why`: what the bench shows, or why it can't be told."""

    that: str
    message: str = ""
    holds: bool | None = None
    why: str = ""
    assured: bool = True

    @property
    def failed(self) -> bool:
        """Whether a command fails for it."""
        return not self.holds and self.assured


@record
class Verified:
    """A bench against a state, `goal`: what differs (`changes`, those within tolerance marked so; `after` is live),
    and the expectations of the state. `standing`: of the commit that the goal is, or of HEAD for the manifest; None
    without one. `left`: the bench does not stand as that commit says, whatever the manifest does."""

    schema: str = "pico.verified/v1"
    goal: str
    observed_at: str = ""
    changes: tuple[Change, ...] = ()
    expectations: tuple[Expected, ...] = ()
    standing: Standing | None = None
    left: bool = False

    @property
    def off(self) -> tuple[Change, ...]:
        """What differs beyond tolerance, is not seen, or not surely."""
        return tuple(c for c in self.changes if not c.tolerated)

    @property
    def exit_code(self) -> ExitCode:
        """EXPECTATION where one does not hold or is unknown, ERROR where the bench differs, else DONE."""
        if any(e.failed for e in self.expectations):
            return ExitCode.EXPECTATION
        return ExitCode.ERROR if self.off else ExitCode.DONE
