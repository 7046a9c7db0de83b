"""What a bisection is about, what was tried, and what it came to."""

from __future__ import annotations

from typing import Literal

from pico.history.bisect.git_state import Verdict
from pico.model.plan import Plan
from pico.model.record import record
from pico.model.state import Expectation

By = Literal["measured", "person", "same", "impossible", "unreadable"]
End = Literal["", "good", "bad", "fork"]


@record
class BisectionTask:
    """Two commits, `bad` and `good`, by id, and how the user called them; what is expected (nothing: a person judges);
    how long a measurement takes [s]; whether the ends are taken on `trust`, without a measurement; how many times
    likelier a commit is that changed a component that is spoken of (`suspicion`)."""

    bad: str
    good: str
    bad_name: str = ""
    good_name: str = ""
    expect: tuple[Expectation, ...] = ()
    measure: float = 5.0
    trust: bool = False
    suspicion: float = 10.0


@record
class Tried:
    """One configuration that was judged. `by`: how; `same` is as one that was judged already, `impossible` that the
    bench can't be brought to it. `end`: it is one that was called good or bad, or the fork of a good branch.
    `travel`, `measure`: how long the bench took for it [s]; `estimate`: how long the choice had reckoned with."""

    commit: str
    verdict: Verdict
    why: str = ""
    by: By = "measured"
    end: End = ""
    travel: float = 0.0
    measure: float = 0.0
    estimate: float = 0.0

    @property
    def seconds(self) -> float:
        """How long the bench took [s]."""
        return self.travel + self.measure


@record
class Proposal:
    """The configuration to try next and the plan that leads to it from the bench as it stands. `number`: the how
    manieth it is, of `about` so many; `left`: how many commits may still be the first bad one."""

    commit: str
    plan: Plan
    end: End = ""
    number: int = 1
    about: int = 1
    left: int = 0


@record
class BisectionOutcome:
    """What a bisection came to: the first bad commit, or those of which it is one, where the others could not be told.

    `mended`: the fork of a good branch is bad, so the first bad commit lies elsewhere. `tried`: how many
    configurations were built and judged, in `seconds` on the bench's clock; `halving`: how long it would have taken
    about with the middle one always [s], None where that can't be told. `runs`: those of the first bad
    commit.
    """

    first_bad: str | None = None
    suspects: tuple[str, ...] = ()
    mended: str | None = None
    said: str = ""
    tried: int = 0
    seconds: float = 0.0
    halving: float | None = None
    skipped: tuple[Tried, ...] = ()
    runs: tuple[str, ...] = ()
