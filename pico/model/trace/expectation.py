"""What became of the expectations of a state, whether the bench is as it says, and whether one ever was."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Literal

from pico.diagnostics import Diagnostic, ExitCode
from pico.model.comparing.unstated import Unstated
from pico.model.diff import Change, addresses_of
from pico.model.measurement import Compared
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
class NumberRead:
    """A number of a goal, by address (`cam.centroid.x`) or as an expression: its `value` with one standard deviation.
    `target` and `tolerance` where it is to be reached; `was`: what it was when the goal was met."""

    address: str
    value: float
    sigma: float = 0.0
    target: float | None = None
    tolerance: float | None = None
    was: float | None = None


@record
class GoalRead:
    """A goal as it was measured, nothing sought: `met` or not, None where that is not assured, and `why`."""

    goal: str
    met: bool | None = None
    why: str = ""
    numbers: tuple[NumberRead, ...] = ()

    @property
    def word(self) -> str:
        """How it stands, in a word."""
        return "not assured" if self.met is None else "aligned" if self.met else "lost"


def goal_read(arguments: Mapping[str, Any], data: Mapping[str, Any]) -> GoalRead:
    """Return what an operation with these arguments that measured a goal told; `data` are those of its end."""
    name, met = str(arguments["goal"]), data.get("met")
    why = str(data.get("why") or data.get("doubt") or "")
    return GoalRead(goal=name, met=met, why=why, numbers=tuple(_numbers(arguments, data.get("last") or {})))


def _numbers(arguments: Mapping[str, Any], last: Mapping[str, float]) -> Iterator[NumberRead]:
    what, was = arguments["what"], arguments.get("was") or {}
    reach, near = what.get("reach"), what.get("tolerance")
    outputs = {n: n for n in reach} if reach else {"objective": what.get("minimize") or what.get("maximize")}
    for output, text in outputs.items():
        if output in last:
            tolerance = near.get(output) if isinstance(near, Mapping) else near
            yield NumberRead(
                address=str(text), value=last[output], sigma=last.get(f"{output}_sigma", 0.0),
                target=reach[output] if reach else None, tolerance=tolerance, was=was.get(output),
            )  # fmt: skip


@record
class Standing:
    """The proof of one commit.

    `verified`: a bench stood exactly so, as the digest of its state says, which is computed from what the commit holds.
    `inherited`: it brings runs, or words in its message, that are of other states: it was cherry-picked, rebased,
    merged or edited, and nobody has applied it since. `planned`: nothing says that a bench ever stood so. `unknown`:
    its manifests can't be read.

    `state`: the digest. Where it is verified: `evidence` (`kinematic`, `physics`, `emulated`, `hardware`), the `bench`
    that stood so, `run` that led there, or None where it was only captured, `at` when, and `carried` by which commit:
    None where this bench alone knows the run yet. `why` in words.
    """

    verdict: Verdict
    commit: str
    state: str = ""
    evidence: str | None = None
    run: str | None = None
    at: str = ""
    carried: str | None = None
    why: str = ""
    bench: str | None = None
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def simulated(self) -> bool:
        """Whether what proves it happened in a simulation: that never counts as hardware."""
        return self.evidence in ("kinematic", "physics")


@record
class Verified:
    """A bench against a state, `goal`: what differs (`changes`, those within tolerance marked so; `after` is live),
    and the expectations of the state. `standing`: of the commit that the goal is, or of HEAD for the manifest; None
    without one. `left`: the bench does not stand as that commit says, whatever the manifest does. `goals` as they were
    measured, `light`: what the commit recorded of it against what was measured; None where neither was. `unread`:
    values of the state, by address, that no device of the bench reads. `unstated`: what was set here and the state does
    not name; None for nothing."""

    schema: str = "pico.verified/v1"
    goal: str
    observed_at: str = ""
    changes: tuple[Change, ...] = ()
    expectations: tuple[Expected, ...] = ()
    standing: Standing | None = None
    left: bool = False
    goals: tuple[GoalRead, ...] | None = None
    light: tuple[Compared, ...] | None = None
    unread: tuple[str, ...] | None = None
    unstated: tuple[Unstated, ...] | None = None

    def __repr__(self) -> str:
        off = f"{addresses_of(self.off)} differ" if self.off else "the bench equals it"
        failed = sum(one.failed for one in self.expectations)
        more = f"; {failed} of {len(self.expectations)} expectations fail" if failed else ""
        more += "; light is not as it was" if self.dimmed else ""
        return f"<verified against {self.goal}: {off}{more}>"

    @property
    def dimmed(self) -> bool:
        """Whether light is not as it was: a goal is not met, or what a commit recorded differs."""
        return any(g.met is False for g in self.goals or ()) or any(one.differs for one in self.light or ())

    @property
    def off(self) -> tuple[Change, ...]:
        """What differs beyond tolerance, is not seen, or not surely."""
        return tuple(c for c in self.changes if not c.tolerated)

    @property
    def exit_code(self) -> ExitCode:
        """EXPECTATION where one does not hold or is unknown, or light is not as it was; ERROR where the bench differs,
        else DONE."""
        if self.dimmed or any(e.failed for e in self.expectations):
            return ExitCode.EXPECTATION
        return ExitCode.ERROR if self.off else ExitCode.DONE
