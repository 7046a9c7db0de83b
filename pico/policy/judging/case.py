"""A plan before its judges: made once, and what they need of it is worked out once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from pico.diagnostics import Diagnostic, ExitCode
from pico.model.observation import Observation
from pico.model.plan import Plan, Spoiled
from pico.model.setup import Setup

if TYPE_CHECKING:
    from pico.backends.device import Capabilities
    from pico.model.calibration.results import AxisZero
    from pico.model.trace.dose import Dose
    from pico.optics.audit.findings import Audit
    from pico.policy.audit import Lit
    from pico.policy.goals import GoalRecord

T = TypeVar("T")


class Recall(Protocol):
    """What was found out before, by the content that it is about."""

    def __call__(self, kind: str, key: str, read: Callable[[Any], T], find: Callable[[], T] | None) -> T | None:
        """Return the finding of a `kind` under a key, which `read` makes of JSON data; if it is unknown, what `find`
        returns, None without `find`."""
        ...


def recall_nothing(kind: str, key: str, read: Callable[[Any], T], find: Callable[[], T] | None) -> T | None:
    """Find everything out anew: an edge believes no file of a client."""
    return find() if find is not None else None


@dataclass(frozen=True)
class Judgment:
    """What one judge says of a plan."""

    # What a plan is told, in this order; an error among these refuses it.
    diagnostics: tuple[Diagnostic, ...] = ()
    # Refusals that a plan does not carry among its diagnostics: it says them elsewhere, or they are about its start.
    denials: tuple[Diagnostic, ...] = ()
    # Code and address of diagnostics of the planner that these stand for, and that are left out.
    replaces: frozenset[tuple[str, str]] = frozenset()
    # The verdict on each rule of the lab; None if no rule was asked.
    rules: tuple[Mapping[str, Any], ...] | None = None
    # The goals that the plan leaves to be aligned again; None if nothing is said of goals.
    spoils: tuple[Spoiled, ...] | None = None
    # Why a plan that is refused can't run.
    exit_code: ExitCode = ExitCode.DENIED

    @property
    def refusals(self) -> tuple[Diagnostic, ...]:
        """The errors for which the plan must not run; none if it may."""
        return (*(one for one in self.diagnostics if one.severity == "error"), *self.denials)


@dataclass(frozen=True)
class PlanCase:
    """A plan, the bench that it is for, and what that bench knows which no plan says.

    A client fills it from what it asked its edge, an edge from its own records.
    """

    setup: Setup
    plan: Plan
    # The bench as it is now; None before the edge has taken it.
    present: Observation | None = None
    # What executes the plan can do; None as long as nobody asks: a plan may be made for a bench that can't run it yet.
    able: Capabilities | None = None
    # How much light each sample had, and may have.
    doses: tuple[Dose, ...] = ()
    # How the goals of the bench stand; None for who needs no advice.
    goals: GoalRecord | None = None
    # What is known of light and tolerances already.
    recall: Recall = recall_nothing
    # Direction and zero of axes as the bench is calibrated, by the address of the tunable.
    axes: Callable[[], Mapping[str, AxisZero]] = dict

    @property
    def seen(self) -> Observation:
        """The bench as it is now, for judges that need it."""
        assert self.present is not None  # else they are not asked
        return self.present

    @cached_property
    def light(self) -> tuple[Audit, Lit]:
        """The verdict of the beam audit on the light of the plan, and the poses, values and lasers that it is about. Of
        a plan that does nothing only what is known already: nothing is traced for it."""
        from pico.optics.audit.findings import audit_from_json
        from pico.policy.audit import audit_key, audit_of, judge

        def judged(setup: Setup, lit: Lit) -> Audit | None:
            find = (lambda: judge(setup, lit)) if self.plan.operations else None
            return self.recall("audit", audit_key(setup, lit), audit_from_json, find)

        return audit_of(self.setup, self.plan, self.seen, judged)

    def with_judgment(self, judgment: Judgment) -> PlanCase:
        """Return the case with a plan that carries a judgment; no judgment changes what the plan does, so what was
        worked out of it stays. What the plan says already is not said twice."""
        plan, changes = self.plan, dict[str, Any]()
        rest = [one for one in plan.diagnostics if (one.code, one.address) not in judgment.replaces]
        new = [one for one in judgment.diagnostics if one not in plan.diagnostics]
        if new or len(rest) < len(plan.diagnostics):
            changes["diagnostics"] = (*rest, *new)
        if judgment.rules is not None:
            changes["policy"] = (*judgment.rules, *(entry for entry in plan.policy if "level" not in entry))
        if judgment.spoils is not None:
            changes["spoils"] = judgment.spoils or None
        if not changes:
            return self
        case = copy(self)
        object.__setattr__(case, "plan", replace(plan, **changes))
        return case
