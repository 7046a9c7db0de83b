"""What an edge does by itself when the lease of its bench is over and nobody said so: lasers off, shutters closed, arms
parked."""

from __future__ import annotations

from contextlib import suppress

from pico.diagnostics import Diagnostic, PicoError, error
from pico.edge.local import LocalEdge
from pico.edge.protocol import Job

WHO = "the edge"
"""For whom the bench is taken then."""
WAITS = 30.0
"""Seconds in which the bench gets free for that."""


async def left_safely(edge: LocalEdge, why: str) -> tuple[Diagnostic, ...]:
    """Take the bench, and bring it to where it may stay; return what could not be."""
    from pico.edge.running import new_run_id
    from pico.motion.deferred import DeferredMotion
    from pico.planning import Planner, park

    wrong = [*await shut(edge, why)]
    try:
        seen, robots = await edge.observe(), edge.setup.lab.robots
        if all(not one.holding and robots[name].is_parked(one.joints) for name, one in seen.robots.items()):
            return tuple(wrong)
        able = await edge.describe()
        planner = Planner(edge.setup, DeferredMotion(edge.setup), seen, able.name, able.fidelity)
        plan = planner.plan(park(planner))
        if plan.operations:
            report = await edge.report(await edge.start(Job(plan=plan, holder=WHO, wait=WAITS), new_run_id()))
            wrong += report.diagnostics
    except PicoError as exc:
        wrong += exc.diagnostics
    with suppress(PicoError):
        for name, one in sorted((await edge.observe()).robots.items()):
            if one.holding or not edge.setup.lab.robots[name].is_parked(one.joints):
                held = f" and holds {one.holding}" if one.holding else ""
                wrong.append(error("lapsed", f"{name} stands where it stopped{held}", hint="`pico recover`"))
    return tuple(wrong)


async def shut(edge: LocalEdge, why: str) -> tuple[Diagnostic, ...]:
    """Take the bench, close its shutters and switch its lasers off; return what could not be. Who takes it finds out
    about what was cut short, too."""
    from pico.edge.shutting import Shutting
    from pico.policy.arming import lasers

    try:
        lease = await edge.acquire(WHO, WAITS)
        try:
            return tuple(await Shutting(edge).shut(tuple(lasers(edge.setup)), why))
        finally:
            await edge.release(lease)
    except PicoError as exc:
        return tuple(exc.diagnostics)
