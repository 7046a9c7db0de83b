"""Shows a plan, asks whether it is to be run, and has it run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.diagnostics import ExitCode

from ..session import Session
from ..views import plan as plan_view
from ..views import report as report_view
from ..views import verified
from .running import execute

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.plan import Plan


def approve(
    session: Session, bench: Bench, plan: Plan, auto_approve: bool, record: Path | None = None, **options: Any
) -> int:
    """Show a plan, ask, run it, and return the exit code; `options` are those of `Moves.run`."""
    if code := show(session, plan, auto_approve, head=bench.history.head_name(), goal=bench.history.goal_name(plan)):
        return code
    if not plan.operations:
        bench.recovery.settle()
        return _expected(session, bench, plan) if plan.reached else ExitCode.ERROR
    if code := declined(session, plan, auto_approve):
        return code
    return execute(session, bench, plan, record, **options)


def declined(session: Session, plan: Plan, auto_approve: bool) -> ExitCode:
    """Ask whether a plan is to be run; return ERROR where somebody says no, else DONE."""
    session.say("")
    if session.confirm(question(plan), auto_approve):
        return ExitCode.DONE
    session.say("Nothing moved.")
    return ExitCode.ERROR


def single(
    session: Session,
    component: str,
    primitive: str,
    arguments: dict[str, str],
    speed: float | None,
    dry_run: bool,
    fidelity: str | None,
) -> int:
    """Plan one operation and run it."""
    bench = session.bench(fidelity, speed, writing=not dry_run)
    return finish(session, bench, bench.plans.single(component, primitive, arguments), dry_run)


def finish(session: Session, bench: Bench, plan: Plan, dry_run: bool) -> int:
    """Show and run the plan of one operation. Nobody is asked: the command named it."""
    code = show(session, plan, single=True)
    if code or dry_run or not plan.operations:
        return code
    session.say("")
    return execute(session, bench, plan)


def show(session: Session, plan: Plan, auto_approve: bool = True, **how: Any) -> ExitCode:
    """Show a plan and what is wrong with it; return why it can't be run, or DONE. Raises PicoError where nobody can be
    asked; `how`: see `views.plan.text`."""
    if plan.operations:
        session.require_answer(auto_approve)
    session.show(plan_view, plan, **how)
    session.tell(plan.diagnostics)
    return plan.exit_code


def _expected(session: Session, bench: Bench, plan: Plan) -> int:
    """Check the expectations of a goal that the bench has reached already."""
    if not plan.target.expect or plan.target.scope:
        return ExitCode.DONE
    found = bench.measurements.expected(plan)
    if session.json:
        session.document(verified.data(found))
    session.say("\n".join(report_view.expectations(found.expectations)))
    return found.exit_code


def question(plan: Plan) -> str:
    """Return what is asked before anything moves."""
    moved = len({op.component for op in plan.operations if op.kind.carries})
    where = f"on {plan.backend} ({plan.fidelity})"
    if moved:
        return f"Move {moved} {'component' if moved == 1 else 'components'} {where}?"
    steps = len(plan.operations)
    return f"Run {steps} {'operation' if steps == 1 else 'operations'} {where}?"
