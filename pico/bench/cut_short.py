"""Whether the last run on a bench was killed, a hand still holds something, or an arm stands about: told first."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from pico.bench.in_use import goes_on
from pico.bench.opened import Opened
from pico.bench.undo.intention import EARLY, told
from pico.diagnostics import Diagnostic, PicoError, warning
from pico.edge.network.opening import remembered
from pico.edge.protocol import RECIPE, RECORDING, STEERING

if TYPE_CHECKING:
    from pico.model.observation import Observation
    from pico.model.trace.dose import Dose
    from pico.runs.journal import RunRecord

_RECOUNTED = (
    "its count was made anew of the journal, without the light between operations, or light fell on it that was not "
    "followed to its end: lower `dose_budget` of {} in lab.yaml by that light"
)


def cut_short(opened: Opened, seen: Observation) -> tuple[Diagnostic, ...]:
    """Return that a run was killed, and what hands hold though nobody moves the bench; and what goes on from there."""
    killed = opened.wait(opened.edge.unended())
    held = [f"{name} holds {robot.holding}" for name, robot in sorted(seen.robots.items()) if robot.holding]
    if not (killed or held) or opened.wait(opened.edge.holder()) is not None:
        return ()
    with remembered(opened.place) as memory:
        moved = memory is None or killed in memory.moving()
        last = memory.last() if memory else None
    if not (moved or held) and (called := told(opened.place)):  # by the command that began the run
        return called
    early = "" if moved else f" {EARLY}"
    ended = f"run {last.run} was interrupted" if last and last.outcome == "interrupted" else ""
    run = f"run {killed} was killed{early}" if killed else ended
    text = ", and ".join([*([run] if run else []), *held])
    after, hands = _goes_on_with(last), "`pico recover` only sets down what a hand holds"
    if not killed and last and last.outcome == "done":  # something else was done since
        after, hands = "`pico recover` sets down what a hand holds", "so does `pico apply`, before anything else"
    return (warning("cut-short", text, hint=f"{after}; {hands}" if held else after),)


def told_first(opened: Opened, seen: Observation) -> tuple[Diagnostic, ...]:
    """Return that somebody moves the bench now; else what `cut_short` does, or that the last run was interrupted, and
    which arms stand where they were stopped with an empty hand, are lost or have a fault."""
    from pico.backends.hardware.guard.note import CODE as GUARD
    from pico.edge.guard.table_lock import CODE as TABLE_LOCK
    from pico.model.instruments.fault import CODES as FAULTS
    from pico.model.observation import LOST, NO_VIEW, left_standing

    found = goes_on(opened)
    cut = found or (*(cut_short(opened, seen) or _interrupted(opened)), *left_standing(opened.setup, seen))
    doses = opened.wait(opened.edge.doses())
    ill = (problem for problem in seen.problems if problem.code in (LOST, GUARD, TABLE_LOCK, NO_VIEW, *FAULTS))
    early = (one for one in told(opened.place) if one not in cut)
    return (*unattended(opened), *ill, *early, *cut, *(note for one in doses for note in _dose(one)))


def _dose(one: Dose) -> Iterator[Diagnostic]:
    now = f"{one.power:.3g} mW fall on it now" if one.power else ""
    if one.unknown:
        now = f"how much falls on it now is unknown: {one.unknown}"
    if one.spent or one.unknown or one.power or one.budget is not None:
        left = "" if one.left is None else f"; {one.left:.4g} mJ are left"
        hint = _RECOUNTED.format(one.component) if one.at_least else ""
        yield Diagnostic("note", "dose", f"{one.said}{left}", detail=now, hint=hint, address=one.component)


def unattended(opened: Opened) -> tuple[Diagnostic, ...]:
    """Return what an unattended run is held to that goes on, or how the edge left the bench of one by itself."""
    terms = opened.wait(opened.edge.unattended())
    if terms is None:
        return ()
    name, left = terms.recipe.partition("@")[0], terms.left
    if left is None:
        text = f"{name} runs unattended until {terms.until} at the latest, up to class {terms.laser_class}"
        ends = f"the bench is then left {', '.join(terms.end)}" if terms.end else ""
        return (warning("unattended", text, detail=ends),)
    if not left.why:
        return ()
    reached = f"the bench was left {', '.join(left.reached)}" if left.reached else ""
    hint = "`pico run --resume --unattended` goes on with it"
    return (warning("unattended", f"{name} ended: {left.why}", detail=reached, hint=hint), *left.wrong)


def not_left(opened: Opened) -> bool:
    """Return whether the process of an unattended run was killed, and nobody brought about its end state yet."""
    terms = opened.wait(opened.edge.unattended())
    return terms is not None and terms.left is not None and not terms.left.reached and bool(terms.left.wrong)


def _interrupted(opened: Opened) -> tuple[Diagnostic, ...]:
    last = _last(opened)
    if last is None or last.outcome != "interrupted":
        return ()
    return (warning("cut-short", f"run {last.run} was interrupted", hint=_goes_on_with(last)),)


def _goes_on_with(last: RunRecord | None) -> str:
    """Return what goes on with the last run, and what goes back; of a teleoperation only a person could go on."""
    back = "`pico undo` goes back to before it"
    if last and last.holder.startswith(f"{RECIPE} ") and last.outcome != "failed":
        return f"`pico run --resume` takes its recipe up again, {back}"
    if last and last.holder.startswith(RECORDING):
        return f"its script alone can go on; `pico recover` brings the bench to order, {back}"
    return back if last and last.holder.startswith(STEERING) else f"`pico resume` takes the run up again, {back}"


def _last(opened: Opened) -> RunRecord | None:
    try:
        with remembered(opened.place) as memory:
            return memory.last() if memory else None
    except PicoError:  # looking must not fail for a journal that can't be read
        return None


def hand_on(opened: Opened, component: str) -> str | None:
    """Return the robot whose hand holds a component since a run was cut short; None where none does."""
    last = _last(opened)
    if last is None or last.outcome == "done":
        return None
    robots = opened.observe().robots
    return next((name for name, robot in sorted(robots.items()) if robot.holding == component), None)


@contextmanager
def told_with(opened: Opened, seen: Observation) -> Iterator[None]:
    """Tell of a killed run or a full hand before whatever is refused meanwhile."""
    try:
        yield
    except PicoError as exc:
        raise PicoError([*cut_short(opened, seen), *exc.diagnostics], exc.exit_code) from exc
