"""One judge of plans asked alone, who raises as an edge does."""

from __future__ import annotations

from pico.backends.device import Capabilities
from pico.diagnostics import PicoError
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.policy.judging.case import PlanCase
from pico.policy.judging.judges import judgment_of, require_permitted


def require(judge: str, setup: Setup, plan: Plan, seen: Observation | None = None) -> None:
    """Raise PicoError if one of the judges refuses a plan."""
    judgment = judgment_of(judge, PlanCase(setup, plan, seen))
    if judgment.refusals:
        raise PicoError(judgment.refusals, judgment.exit_code)


def require_applicable(setup: Setup, plan: Plan, able: Capabilities) -> None:
    """Raise PicoError if a plan is refused before its bench is taken."""
    require_permitted(PlanCase(setup, plan, able=able))


def require_current(setup: Setup, plan: Plan, seen: Observation) -> None:
    """Raise PicoError if a plan does not fit its bench."""
    require("freshness", setup, plan, seen)


def with_rules(setup: Setup, plan: Plan, seen: Observation) -> Plan:
    """Return a plan that carries the verdicts on the rules of its lab."""
    case = PlanCase(setup, plan, seen)
    return case.with_judgment(judgment_of("rules", case)).plan.sealed()
