"""A run that went wrong, as an exception."""

from __future__ import annotations

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.model.plan import Plan
from pico.model.trace.report import RunReport


def require_possible(plan: Plan) -> Plan:
    """Return a plan; raises PicoError, with its exit code, where it must not be run."""
    if plan.exit_code:
        raise PicoError([d for d in plan.diagnostics if d.severity == "error"] or _denied(plan), plan.exit_code)
    return plan


def require_done(report: RunReport) -> RunReport:
    """Return the report of a run; raises PicoError, with its exit code, where that did not do what it was to do."""
    if report.exit_code == ExitCode.INTERRUPTED:
        raise PicoError(error("interrupted", f"run {report.run} was interrupted"), ExitCode.INTERRUPTED)
    if report.exit_code:
        wrong = [d for d in report.diagnostics if d.severity == "error"]
        found = wrong or [error("failed", f"run {report.run} did not reach its goal", hint="`pico runs show`")]
        raise PicoError(found, report.exit_code)
    return report


def _denied(plan: Plan) -> list[Diagnostic]:
    broken = [rule for rule in plan.policy if not rule.get("holds") and rule.get("level") == "mandatory"]
    said = "; ".join(str(rule.get("message") or rule.get("text") or rule.get("rule")) for rule in broken)
    return [error("denied", f"the policy of {plan.lab.name} does not allow it: {said}")]
