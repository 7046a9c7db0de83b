"""A run that is ended from within the loop of its edge: who follows it from another thread would come too late."""

from __future__ import annotations

from collections.abc import Callable

from pico.bench.bench import Bench
from pico.edge.protocol import Job
from pico.edge.running import new_run_id
from pico.model.plan import Plan
from pico.model.trace.event import Event
from pico.model.trace.report import RunReport


def ended_when(bench: Bench, plan: Plan, when: Callable[[Event], bool], *, at_once: bool = False) -> RunReport:
    """Run a plan, halt it (or stop it at once) at every event for which `when` holds, and return what became of it."""

    async def followed() -> RunReport:
        edge, run = bench.edge, new_run_id()
        await edge.start(Job(plan=plan, holder="test", within=bench.recording), run)
        async for event in edge.events(run):
            if when(event):
                await (edge.stop() if at_once else edge.cancel(run))
        return await edge.report(run)

    return bench.wait(followed())
