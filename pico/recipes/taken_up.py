"""What a bench remembers of a step that was cut short: so that nothing is measured twice, and nothing is lost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.measurement import Measurement
    from pico.model.plan import Plan
    from pico.runs.journal import JournalRecord


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
