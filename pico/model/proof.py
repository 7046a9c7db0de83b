"""How far the state of a commit is proven: whether a bench ever stood so, and which."""

from __future__ import annotations

from typing import Literal

from pico.diagnostics import Diagnostic
from pico.model.record import record

Verdict = Literal["verified", "inherited", "planned", "unknown"]


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
