"""What became of the expectations of a state, whether the bench is as it says, and whether one ever was."""

from __future__ import annotations

from typing import Literal

from pico.diagnostics import Diagnostic, ExitCode
from pico.model.diff import Change
from pico.model.record import record

Verdict = Literal["verified", "inherited", "planned", "unknown"]


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
class Standing:
    """The proof of one commit.

    `verified`: a bench stood exactly so, as the digest of its state says, which is computed from what the commit holds.
    `inherited`: it brings runs, or words in its message, that are of other states: it was cherry-picked, rebased,
    merged or edited, and nobody has applied it since. `planned`: nothing says that a bench ever stood so. `unknown`:
    its manifests can't be read.

    `state`: the digest. Where it is verified: `evidence` (`kinematic`, `physics`, `emulated`, `hardware`), `run` that
    led there, or None where it was only captured, `at` when, and `carried` by which commit: None where this bench alone
    knows the run yet. `why` in words.
    """

    verdict: Verdict
    commit: str
    state: str = ""
    evidence: str | None = None
    run: str | None = None
    at: str = ""
    carried: str | None = None
    why: str = ""
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def simulated(self) -> bool:
        """Whether what proves it happened in a simulation: that never counts as hardware."""
        return self.evidence in ("kinematic", "physics")


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
