"""`run`: a plan, a backend, and events."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable
from contextlib import aclosing

from pico.backends.protocol import Backend
from pico.execution.about import about_run
from pico.execution.checks import require_allowed, require_applicable, require_current
from pico.execution.walk import Walk
from pico.model.event import Event
from pico.model.lab import Setup
from pico.model.plan import Plan
from pico.runs.journal import Journal


async def run(
    plan: Plan,
    backend: Backend,
    *,
    run_id: str,
    holder: str,
    setup: Setup,
    cancelled: Callable[[], bool] = lambda: False,
    stop_on_error: bool = False,
    resumed: bool = False,
) -> AsyncGenerator[Event, None]:
    """Execute `plan` on `backend` and yield what happens; the last event is `run_finished`, with the tally.

    The bench is locked for `holder` meanwhile. `setup` says the tolerances. Before the first operation
    raises PicoError: exit code IMPOSSIBLE for a plan with errors, STALE where the bench or the lab
    changed since it was made, DENIED by the lab's policy, LOCKED where somebody else has the bench, ERROR where the
    backend can't do what the plan asks. A failure of an operation is an event.

    Where an operation fails, what depends on it is skipped and the rest goes on, unless `stop_on_error`. `resumed`: the
    journal knows the run, which goes on under its id.

    Once `cancelled()` is true, or the task that iterates is cancelled, nothing more starts; what is under way goes on
    to its safe end, and the events end with `run_finished`, outcome `interrupted`. Cancelled twice, it stops at once.
    """
    able = await backend.describe()
    require_applicable(plan, able)
    lease = await backend.acquire(holder)
    try:
        seen = await backend.observe()
        require_current(setup, plan, seen)
        require_allowed(setup, plan, seen)
        journal: Journal | None = getattr(backend, "journal", None)  # one at the far end of a network keeps its own
        walk = Walk(
            plan, backend, lease, run=run_id, now=seen.time, cancelled=cancelled, journal=journal,
            stop_on_error=stop_on_error, resumed=resumed, about=about_run(setup, plan, able),
        )  # fmt: skip
        async with aclosing(_events(walk, backend)) as events:
            async for event in events:
                yield event
    finally:
        await backend.release(lease)


async def _events(walk: Walk, backend: Backend) -> AsyncGenerator[Event, None]:
    """Yield the events of a walk in a task of its own, so that neither a slow nor a cancelled reader harms it."""
    task = asyncio.create_task(walk.run())
    pressed = 0
    try:
        while True:
            try:
                event = await walk.events.get()
            except asyncio.CancelledError:
                pressed += 1
                walk.interrupt()
                if pressed > 1:
                    await backend.stop()
                continue
            if event is None:
                break
            yield event
    finally:
        walk.interrupt()
        await asyncio.wait([task])
    task.result()
    if pressed:
        raise asyncio.CancelledError
