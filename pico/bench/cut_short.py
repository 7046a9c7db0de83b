"""Whether the last run on a bench was killed, or a hand still holds something: told before anything else."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pico.bench.opened import Opened
from pico.diagnostics import Diagnostic, warning

if TYPE_CHECKING:
    from pico.model.observation import Observation


def cut_short(opened: Opened, seen: Observation) -> tuple[Diagnostic, ...]:
    """Return that a run was killed, and what hands hold though nobody moves the bench; and what goes on from there."""
    killed = opened.wait(opened.edge.unended())
    held = [f"{name} holds {robot.holding}" for name, robot in sorted(seen.robots.items()) if robot.holding]
    if not (killed or held) or opened.wait(opened.edge.holder()) is not None:
        return ()
    text = ", and ".join([*([f"run {killed} was killed"] if killed else []), *held])
    after = "`pico resume` takes the run up again, `pico undo` goes back to before it"
    hands = "`pico recover` only sets down what a hand holds"
    return (warning("cut-short", text, hint=f"{after}; {hands}" if held else after),)
