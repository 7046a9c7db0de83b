"""What a bench remembers of a step that was cut short: so that nothing is measured twice, and nothing is lost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.diagnostics import Diagnostic, PicoError, error
from pico.recipes.log import Checked, Log

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.diff import Change
    from pico.model.measurement import Measurement
    from pico.model.plan import Plan
    from pico.runs.journal import JournalRecord


def checked_out(bench: Bench) -> Checked:
    """Return the branch and the commit that are checked out."""
    head = bench.folder.head()
    return (head.branch, head.commit) if head else (None, None)


def otherwise(bench: Bench, log: Log) -> tuple[Diagnostic, ...]:
    """Return what is otherwise than a recipe left it when it was cut short, and what others did to that: what it
    measures and commits would be of another bench, or on another branch, than it says."""
    found = list[Diagnostic]()
    last = next(reversed(log.steps.values()), None)
    here = checked_out(bench)
    moves_head = last is not None and last.told is None and last.kind in ("commit", "checkout", "branch")
    if last is not None and last.at not in (None, here) and not moves_head:
        then, now = (f"{branch or 'no branch'} at {(commit or 'no commit')[:7]}" for branch, commit in (last.at, here))
        hint = f"`git checkout {last.at[0] or last.at[1]}`" if last.at and any(last.at) else ""
        found.append(error("bench-changed", f"{then} was checked out, and now it is {now}", hint=hint))
    runs = [run for step in log.steps.values() for run in step.runs]
    changes, others = _changed_since(bench, runs[-1]) if runs else ((), ())
    by = f"since {log.about.name} was cut short, by {', '.join(others)}"
    return (*found, *(error("bench-changed", f"{c.component}.{c.tunable}: {c.text}", detail=by) for c in changes))


def _changed_since(bench: Bench, run: str) -> tuple[tuple[Change, ...], tuple[str, ...]]:
    """Return what is otherwise by what other runs moved or set after one that was cut short, and these runs in their
    order. Apart from that is what the run itself was at when it was cut short, and what only emptied hands. Raises
    PicoError where the journal can't be read."""
    from pico.bench.recovery import state_before
    from pico.bench.undo.choice import begun_by, document_of
    from pico.model.comparing.drift import drift_of
    from pico.model.observation import live_state

    memory = bench.edge.memory
    runs = memory.runs() if memory else ()
    own = next((n for n, one in enumerate(runs) if one.run == run), len(runs))
    if memory is None or own + 1 >= len(runs):
        return (), ()
    moving = memory.moving()
    others = [r for r in runs[own + 1 :] if r.run in moving and document_of(memory, r).target.cause != "recover"]
    parts = {component for other in others for component, _ in begun_by(memory, other)}
    if not parts:
        return (), ()
    before, _ = state_before(bench.setup, memory, (others[0], *runs[own::-1]), parts)
    seen = bench.observe()
    live = live_state(bench.setup, seen)
    then = {name: before.components[name] for name in parts & before.components.keys()}
    off = drift_of(bench.setup, seen, replace(live, components={**live.components, **then}))
    under_way = set(begun_by(memory, runs[own], ended=False))
    found = tuple(
        c for c in off if c.component in then and (c.component, c.tunable) not in under_way and not c.tolerated
    )
    return found, tuple(r.run for r in others) if found else ()


def settle(bench: Bench, begun: Sequence[str]) -> None:
    """Bring the bench to order after a run of a step was cut short: what it had set for a measurement is set back, and
    what a hand holds is put down; raises PicoError where only a person can."""
    memory = bench.edge.memory
    last = memory.last() if memory else None
    if last is None or last.run not in begun or last.outcome == "done":
        return
    try:
        plan, run = bench.recovery.resume_plan()
    except PicoError as exc:
        if exc.diagnostics[0].code != "nothing-to-resume":
            raise
        plan, run = bench.recovery.recover_plan(), None
    if plan.operations:
        from pico.bench.running.attending import attend

        attend(bench.moves.run(plan, resumes=run))
    else:
        bench.recovery.settle()


def measured_before(
    bench: Bench, begun: Sequence[str], step: str, plan: Plan
) -> Mapping[str, Measurement] | None:  # fmt: skip
    """Return what was measured by runs that a `step` began before it was cut short, by address, where that is all that
    a plan is to measure; None where it must be run."""
    wanted = {op.address for op in plan.operations if op.primitive == "measure"}
    memory = bench.edge.memory
    if not wanted or not begun or memory is None:
        return None
    found = {m.address: m for run in begun for r in memory.records(run=run) if (m := _measured(r, step)) is not None}
    return {a: found[a] for a in sorted(wanted)} if wanted <= found.keys() else None


def _measured(r: JournalRecord, step: str) -> Measurement | None:
    """Return the measurement that a record tells of, where it was taken in a step; an open run has those of others."""
    from pico.model.measurement import measurement_from_json
    from pico.runs.left_set import step_of

    operation = r.key.split("/")[1]
    if step_of(operation) and not operation.partition(".")[2].startswith(f"{step}:"):
        return None
    data = (r.data.get("data") or {}).get("measurement") if r.kind == "done" else None
    return measurement_from_json(data) if data else None
