"""After a run that was cut short: taking it up again, going back to before it, or only clearing the hands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pico.attachment import bench_folder
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.model.observation import Observation, live_state
from pico.model.plan import Plan, Target, plan_from_json
from pico.model.state import LabState, state_from_json
from pico.motion.deferred import DeferredMotion

if TYPE_CHECKING:
    from collections.abc import Collection

    from pico.async_bench import AsyncBench
    from pico.journal import Journal, RunRecord
    from pico.model.operation import Outcome


async def resume_plan(bench: AsyncBench) -> tuple[Plan, str]:
    """Return the plan from the bench as it stands to the goal of the last run, and the id of that run.

    Raises PicoError where the last run reached its end, or is still going on (exit code LOCKED).
    """
    from pico.execution.resume import renumbered

    journal = _journal(bench)
    _refuse_while_held(bench)
    last = _last(journal)
    if last.outcome == "done":
        text = f"there is nothing to resume: the last run ({last.run}) did all that it was to do"
        raise PicoError(error("nothing-to-resume", text, hint="`pico plan` shows what differs now"))
    began = _document(journal, last)
    only = began.target.only or _asked(began)
    seen = await bench.observe()
    wanted = state_from_json(began.lab.name, began.target.state)
    plan = _planned(bench, seen, wanted, began.target, only or (), began.target.exclude or ())
    return renumbered(plan, last.resumed + 1), last.run


async def undo_plan(bench: AsyncBench) -> Plan:
    """Return the plan that takes everything that the last run moved or set back to where it was before.

    What nobody knew before it is left as it is. Raises PicoError where no run has moved anything.
    """
    journal = _journal(bench)
    _refuse_while_held(bench)
    for last in reversed(journal.runs()):
        touched = {r.component for r in journal.records(run=last.run) if r.kind == "started"}
        if not touched:
            continue
        before = state_from_json(bench.setup.lab.name, _document(journal, last).base.state)
        seen = await bench.observe()
        back = {n: part for n, part in before.components.items() if n in touched and n in bench.setup.lab.inventory}
        wanted = _live(bench, seen)
        wanted = LabState(lab=wanted.lab, components={**wanted.components, **back})
        name = f"the bench before {last.run}"
        target = Target(title=name, cause="undo", of=last.run, state=wanted.as_json())
        return _planned(bench, seen, wanted, target)
    raise PicoError(_no_run())


async def recover_plan(bench: AsyncBench) -> Plan:
    """Return the plan that sets down what hands still hold, and changes nothing else."""
    _refuse_while_held(bench)
    seen = await bench.observe()
    wanted = _live(bench, seen)
    target = Target(title="the bench with empty hands", cause="recover", state=wanted.as_json())
    return _planned(bench, seen, wanted, target)


async def settle(bench: AsyncBench) -> None:
    """Record what became of operations that a killed run had begun, though there is nothing left to move.

    Raises PicoError for what only a person can tell.
    """
    if (bench_folder(bench.root) / "journal.sqlite").exists() and _journal(bench).unsettled():
        await bench.backend.release(await bench.backend.acquire("pico apply"))


def open_questions(bench: AsyncBench) -> list[Diagnostic]:
    """Return an error for each operation that only a person can tell the end of."""
    from pico.backends import recovery

    return recovery.open_questions(_journal(bench).unsettled())


def answer(bench: AsyncBench, key: str, outcome: Outcome) -> None:
    """Record what a person says of an operation that only a person can tell the end of.

    Raises PicoError where nobody asks about `key`, and where somebody moves the bench (exit code LOCKED).
    """
    from pico.backends.lease import BenchLock, user

    journal = _journal(bench)
    with BenchLock(bench.root).held("pico recover") as lease:
        journal.fence(lease.token)
        asked = {open.key for open in journal.unsettled()}
        if key not in asked:
            known = ", ".join(sorted(asked)) or "nothing is open"
            raise PicoError(error("unknown-key", f"nobody asks about {key[:80]}", hint=f"open: {known}"))
        journal.resolve(key, outcome, user(), None, lease.token)


def _planned(
    bench: AsyncBench, seen: Observation, wanted: LabState, target: Target, only: Collection[str] = (),
    exclude: Collection[str] = (),
) -> Plan:  # fmt: skip
    from pico.planning import plan

    found = plan(
        bench.setup, seen, wanted, motion=DeferredMotion(bench.setup), backend=bench.backend_name,
        fidelity=bench.fidelity, base=bench.base(seen), target=target, targets=only, exclude=exclude,
    )  # fmt: skip
    return bench.judged(found, seen)


def _live(bench: AsyncBench, seen: Observation) -> LabState:
    """The bench as it is, with what hands hold where it will be set down."""
    from pico.planning.setdown import set_downs

    return live_state(bench.setup, set_downs(bench.setup, seen, DeferredMotion(bench.setup)).seen)


def _asked(plan: Plan) -> tuple[str, ...]:
    """The components of a plan that was made for single operations."""
    if plan.asked:
        return tuple(sorted({op.component for op in plan.operations if op.reason.kind == "asked"}))
    return ()


def _document(journal: Journal, run: RunRecord) -> Plan:
    text = journal.document(run.run)
    if text is None:
        raise PicoError(error("no-plan", f"the journal did not keep the plan of the run {run.run}", hint="`pico plan`"))
    return plan_from_json(text)


def _last(journal: Journal) -> RunRecord:
    runs = journal.runs()
    if not runs:
        raise PicoError(_no_run())
    return runs[-1]


def _journal(bench: AsyncBench) -> Journal:
    journal: Journal = bench.backend.journal  # type: ignore[attr-defined]
    return journal


def _refuse_while_held(bench: AsyncBench) -> None:
    from pico.backends.lease import BenchLock

    holder = BenchLock(bench.root).holder()
    if holder is not None:
        text = f"a run goes on: {holder.user} (process {holder.pid}, since {holder.since}): {holder.what}"
        raise PicoError(error("locked", text, hint="`pico stop` ends it safely"), ExitCode.LOCKED)


def _no_run() -> Diagnostic:
    return error("no-run", "the journal of this bench knows no run that moved anything", hint="`pico plan`")
