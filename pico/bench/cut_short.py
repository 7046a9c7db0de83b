"""Whether the last run on a bench was killed, a hand still holds something, or an arm stands about: told first."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from pico.bench.in_use import goes_on
from pico.bench.opened import Opened
from pico.diagnostics import Diagnostic, PicoError, warning
from pico.edge.link.opening import remembered

if TYPE_CHECKING:
    from pico.model.observation import Observation


def cut_short(opened: Opened, seen: Observation) -> tuple[Diagnostic, ...]:
    """Return that a run was killed, and what hands hold though nobody moves the bench; and what goes on from there."""
    killed = opened.wait(opened.edge.unended())
    held = [f"{name} holds {robot.holding}" for name, robot in sorted(seen.robots.items()) if robot.holding]
    if not (killed or held) or opened.wait(opened.edge.holder()) is not None:
        return ()
    with remembered(opened.root) as memory:
        moved = memory is None or killed in memory.moving()
        last = memory.last() if memory else None
    early = "" if moved else " before it began an operation"
    text = ", and ".join([*([f"run {killed} was killed{early}"] if killed else []), *held])
    after = "`pico resume` takes the run up again, `pico undo` goes back to before it"
    hands = "`pico recover` only sets down what a hand holds"
    if not killed and last and last.outcome == "done":  # something else was done since
        after, hands = "`pico recover` sets down what a hand holds", "so does `pico apply`, before anything else"
    return (warning("cut-short", text, hint=f"{after}; {hands}" if held else after),)


def told_first(opened: Opened, seen: Observation) -> tuple[Diagnostic, ...]:
    """Return that somebody moves the bench now; else what `cut_short` does, and which arms stand where they were
    stopped with an empty hand."""
    from pico.model.observation import left_standing

    return goes_on(opened) or (*cut_short(opened, seen), *left_standing(opened.setup, seen))


@contextmanager
def told_with(opened: Opened, seen: Observation) -> Iterator[None]:
    """Tell of a killed run or a full hand before whatever is refused meanwhile."""
    try:
        yield
    except PicoError as exc:
        raise PicoError([*cut_short(opened, seen), *exc.diagnostics], exc.exit_code) from exc
