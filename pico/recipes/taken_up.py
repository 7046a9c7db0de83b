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
    from pico.runs.journal import JournalRecord, RunRecord
    from pico.runs.memory import Memory


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
    if last is not None and last.at and not moves_head and not _same_state(bench, last.at, here):
        then, now = (f"{branch or 'no branch'} at {(commit or 'no commit')[:7]}" for branch, commit in (last.at, here))
        hint = _way_back(bench, last.at) if last.at else ""
        found.append(error("checkout-changed", f"{then} was checked out, and now it is {now}", hint=hint))
    runs = [run for step in log.steps.values() for run in step.runs]
    changes, others = _changed_since(bench, runs[-1]) if runs else ((), ())
    by = f"since {log.about.name} was cut short, by {', '.join(others)}"
    return (*found, *(error("bench-changed", f"{c.component}.{c.tunable}: {c.text}", detail=by) for c in changes))


def _same_state(bench: Bench, then: Checked, now: Checked) -> bool:
    """Return whether two checkouts are of one branch and hold the same state: a commit of notes or code changes nothing
    that a recipe measures or commits."""
    if then == now or then[0] != now[0] or not (then[0] and then[1] and now[1]):
        return then == now
    try:
        return bench.folder.state_at(then[1]) == bench.folder.state_at(now[1])
    except PicoError:  # one of them can't be read
        return False


def _way_back(bench: Bench, then: Checked) -> str:
    """Return the commands that check out again what was checked out."""
    branch, commit = then
    if branch is None or commit is None:
        return f"`git checkout {branch or commit}`" if branch or commit else ""
    try:
        moved = bench.folder.history().resolve(branch).id != commit
    except PicoError:
        return f"`git checkout -b {branch} {commit[:7]}`: the branch is gone"
    if not moved or checked_out(bench)[0] != branch:
        return f"`git checkout {branch}`"
    hint = f"`git branch later-{branch}` names the commits made since, then `git reset --keep {commit[:7]}`"
    return f"{hint}; or `pico run` begins anew"


def _changed_since(bench: Bench, run: str) -> tuple[tuple[Change, ...], tuple[str, ...]]:
    """Return what is otherwise by what other runs moved or set after one that was cut short, and these runs in their
    order. Apart from that is what the run itself was at when it was cut short, and what only emptied hands. Raises
    PicoError where the journal can't be read."""
    from pico.bench.recovery import state_before
    from pico.bench.undo.choice import begun_by
    from pico.model.comparing.drift import drift_of
    from pico.model.observation import live_state

    memory = bench.edge.memory
    runs = memory.runs() if memory else ()
    own = next((n for n, one in enumerate(runs) if one.run == run), len(runs))
    if memory is None or own + 1 >= len(runs):
        return (), ()
    moving = memory.moving()
    others = [r for r in runs[own + 1 :] if r.run in moving and not _recovers(memory, r)]
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


def _recovers(memory: Memory, run: RunRecord) -> bool:
    from pico.bench.undo.choice import document_if_any

    plan = document_if_any(memory, run)
    return plan is not None and plan.target.cause == "recover"


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
