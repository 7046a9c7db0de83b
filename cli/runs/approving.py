"""Shows a plan, asks whether it is to be run, and has it run."""

from __future__ import annotations

from contextlib import nullcontext, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.diagnostics import ExitCode, PicoError, error
from pico.policy.consent import asked_about, lights

from ..session import Session
from ..terminal.waiting import waiting
from ..views import left as left_view
from ..views import plan as plan_view
from ..views import report as report_view
from ..views import verified
from ..views import wanted as wanted_view
from ..views.run import Progress
from ..views.style import count, listed
from .running import Screen, execute, watched

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.diff import Change
    from pico.model.plan import Plan
    from pico.model.setup import Setup
    from pico.model.trace.report import RunReport

FEW = 3
"""So many components are named."""


def approve(
    session: Session, bench: Bench, plan: Plan, auto_approve: bool, record: Path | None = None, *,
    detach: bool = False, **options: Any,
) -> int:  # fmt: skip
    """Show a plan, ask, run it, or leave it to the bench (`detach`), and return the exit code; `options` are those of
    `Moves.run`."""
    if code := show(
        session, bench, plan, auto_approve, head=bench.history.head_name(), goal=bench.history.goal_name(plan)
    ):
        return code
    if not plan.operations:
        session.tell(bench.recovery.settle())
        return _expected(session, bench, plan) if plan.reached else ExitCode.ERROR
    if code := declined(session, bench, plan, auto_approve):
        return code
    if detach:
        session.show(left_view, bench.moves.leave(plan, holder=session.command, **options))
        return ExitCode.DONE
    return execute(session, bench, plan, record, **options)


def going_back(
    session: Session, command: str, auto_approve: bool, fidelity: str | None, speed: float | None, *,
    run: str | None, of: str | None = None,
) -> Bench:  # fmt: skip
    """Open the bench for a command that continues an earlier run or takes one back.

    Report a command that was killed before it moved anything. Raises PicoError if that leaves open which run is
    meant and the command runs without confirmation. `run`: the run that was named; `of`: its operator.
    """
    bench = session.bench(fidelity, speed, writing=True, calls=False)
    if auto_approve and run is None:
        bench.recovery.require_named(command, of)
    session.tell(bench.recovery.killed_early())
    session.calls(bench)
    return bench


def declined(
    session: Session, bench: Bench, plan: Plan, auto_approve: bool, otherwise: str = "Nothing moved."
) -> ExitCode:
    """Ask whether a plan is to be run, where it is one to be asked about; return ERROR where somebody says no, having
    said what is so `otherwise`, else DONE."""
    asked = question(bench.setup, plan)
    if plan.operations:
        session.say("")
    if not asked or session.confirm(asked, auto_approve):
        session.intend()
        return ExitCode.DONE
    session.say(otherwise)
    return ExitCode.ERROR


def single(
    session: Session,
    component: str,
    primitive: str,
    arguments: dict[str, str],
    speed: float | None,
    dry_run: bool,
    fidelity: str | None,
    auto_approve: bool,
) -> int:
    """Plan one operation, show it, ask, and run it."""
    bench = session.bench(fidelity, speed, writing=not dry_run)
    plan = bench.plans.single(component, primitive, arguments)
    asked = arguments if primitive == "set" else ("pose",) if primitive in ("move", "stow") else ()
    off: tuple[Change, ...] = ()
    with nullcontext() if not plan.operations else suppress(PicoError):  # a manifest that can't be read stops no move
        off = bench.plans.not_in_manifest(plan) if asked else ()
    own = [c for c in off if c.component == component and c.tunable in asked] if asked else None
    code = show(session, bench, plan, auto_approve or dry_run, single=True, beside=own)
    if code or dry_run or not plan.operations:
        return code
    after = _too(component, sorted({c.component for c in off} - {component}))
    return declined(session, bench, plan, auto_approve) or execute(session, bench, plan, after=after)


def written(
    session: Session, component: str, primitive: str, arguments: dict[str, str], dry_run: bool
) -> int:  # fmt: skip
    """Write what one operation would lead to into the manifest, if it can be; the bench stays. What is not named, and
    what is relative, counts from the manifest."""
    if primitive not in ("move", "stow", "set"):
        text = f"`{primitive}` can't be written into the manifest"
        raise PicoError(error("usage", text, hint="--manifest goes with move, stow and set"))
    bench = session.bench(writing=not dry_run)
    plan = bench.plans.single(component, primitive, arguments, base=bench.folder.state)
    if plan.errored:
        return show(session, bench, plan, True, single=True)
    only = [f"{component}.{name}" for name in (arguments if primitive == "set" else ("pose",))]
    session.show(wanted_view, bench.commits.wanted(plan, *only, write=not dry_run))
    return ExitCode.DONE


def measured(session: Session, bench: Bench, plan: Plan, auto_approve: bool, dry_run: bool) -> RunReport | int:
    """Run a plan that measures, and return what became of it; the exit code where it is not run. The plan is shown only
    where more than measuring is in it, and asked about where that moves something or lets light out."""
    more = dry_run or plan.errored or any(op.primitive != "measure" for op in plan.operations)
    if more and not (session.json and not dry_run and not plan.errored):
        code = show(session, bench, plan, auto_approve or dry_run, single=True)
        if code or dry_run:
            return code
    if more and (code := declined(session, bench, plan, auto_approve)):
        return code
    run = bench.run(plan, holder="pico measure")
    screen = Screen(session, Progress(plan))
    with nullcontext() if more else waiting("Measuring"):
        watched(run, screen.show if more and not session.json else lambda _: None)
    return run.report


def _too(component: str, others: list[str]) -> str:
    """Return that other components are not as the manifest says, either: moved on the bench, or edited in a file."""
    if not others:
        return ""
    verb, names = "differs" if len(others) == 1 else "differ", " ".join(others) if len(others) <= FEW else "NAME"
    then = f"`pico apply -- {names}` brings it there, `pico commit {component}` leaves it out of a commit"
    return f"{listed(others, FEW)} {verb} from the manifest, too: {then}."


def show(session: Session, bench: Bench, plan: Plan, auto_approve: bool, **how: Any) -> ExitCode:
    """Show a plan and what is wrong with it; return why it can't be run, or DONE. Raises PicoError where nobody can be
    asked; `how`: see `views.plan.text`."""
    if question(bench.setup, plan):
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


def question(setup: Setup, plan: Plan) -> str:
    """Return what is asked before anything moves or light comes out; empty where neither happens."""
    if not asked_about(setup, plan.operations):
        return ""
    light = ", ".join(lights(setup, plan.operations))
    what = plan_view.tally(plan.operations) or count(len(plan.operations), "operation")
    return f"Run {what} on {plan.backend} ({plan.fidelity}){f' and let light out ({light})' if light else ''}?"
