"""What became of a check of a lab: a verdict for each question, and the exit code that follows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any, Literal

from pico.diagnostics import Diagnostic, ExitCode
from pico.history.repository.comparison_base import ComparisonBase
from pico.model.diff import Change
from pico.model.plan import Plan
from pico.model.record import record
from pico.model.trace.expectation import Expected

Question = Literal["valid", "formatted", "stands", "feasible", "expectations", "policy", "recipes"]
Verdict = Literal["passed", "advised", "failed", "skipped"]

SCHEMA = "pico.check/v1"
QUESTIONS: tuple[Question, ...] = ("valid", "formatted", "stands", "feasible", "expectations", "policy")
"""Those about the manifests, in order; the recipes come last."""
TITLES: Mapping[Question, str] = {
    "valid": "the manifests are valid",
    "formatted": "they are in the normal form",
    "stands": "everything has room to stand",
    "feasible": "a plan leads there",
    "expectations": "the simulator gets there, and its expectations hold",
    "policy": "the policy of the lab allows it",
    "recipes": "its recipes are right",
}
_CODES: Mapping[Question, ExitCode] = {
    "valid": ExitCode.ERROR,
    "stands": ExitCode.IMPOSSIBLE,
    "feasible": ExitCode.IMPOSSIBLE,
    "expectations": ExitCode.EXPECTATION,
    "policy": ExitCode.DENIED,
    "recipes": ExitCode.ERROR,
}


@record
class Check:
    """The answer to one question. `text`: what was found, or why it was not asked. `advised`: said, but no reason to
    refuse. `broken`: the simulator did not get as far as the question. `seconds`: what it took here."""

    question: Question
    verdict: Verdict
    text: str = ""
    broken: bool = False
    seconds: float = 0.0
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def exit_code(self) -> ExitCode:
        """What this answer alone would end with."""
        if self.verdict != "failed":
            return ExitCode.DONE
        return ExitCode.ERROR if self.broken else _CODES[self.question]


@record
class Picture:
    """A picture that was drawn: `before` or `after`, and where it is."""

    title: Literal["before", "after"]
    path: str


@record
class LabChecked:
    """What became of one lab. `folder`: where it lies, from the top of its repository.

    `changes`: what differs physically from the base, exactly; `bench`: what differs in the lab itself and its types.
    `plan`: from the base to the state checked, None where that could not be read. `notes`: what to know of all that.
    """

    lab: str
    folder: str = "."
    base: ComparisonBase = ComparisonBase()
    fidelity: str = "kinematic"
    checks: tuple[Check, ...] = ()
    changes: tuple[Change, ...] = ()
    bench: tuple[str, ...] = ()
    plan: Plan | None = None
    expectations: tuple[Expected, ...] = ()
    rules: tuple[Mapping[str, Any], ...] = ()
    pictures: tuple[Picture, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def exit_code(self) -> ExitCode:
        """The lowest of the codes of its checks: invalid before impossible before expectation before policy."""
        return min((c.exit_code for c in self.checks if c.exit_code), default=ExitCode.DONE)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """All that was found, each once."""
        return tuple(dict.fromkeys(d for c in self.checks for d in c.diagnostics))


@record
class CheckReport:
    """What became of every lab that was checked. `what`: what was checked, `base`: against what; `alike`: labs that do
    not differ from the base, and were passed over."""

    schema: str = SCHEMA
    what: str
    base: ComparisonBase = ComparisonBase()
    labs: tuple[LabChecked, ...] = ()
    alike: tuple[str, ...] = field(default=())

    @property
    def exit_code(self) -> ExitCode:
        """As of the labs together."""
        return min((lab.exit_code for lab in self.labs if lab.exit_code), default=ExitCode.DONE)
