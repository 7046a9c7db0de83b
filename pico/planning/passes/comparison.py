"""What differs between the bench as seen and the state wanted, and what about the bench itself needs a word."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from pico.diagnostics import Diagnostic, warning
from pico.model.comparing.drift import uncertain
from pico.model.diff import diff_observed
from pico.model.observation import Observation
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.planning.parts.selection import selection
from pico.planning.passes.draft import Draft


def compared(draft: Draft) -> Draft:
    """Return the plan with what differs and which of it is asked for, and warnings about parts that can't be planned
    for. Raises PicoError for a target that the lab does not have."""
    setup, seen, goal = draft.setup, draft.seen, draft.goal
    samples = bool(goal.alone) or goal.target.cause in ("undo", "redo", "recover")
    only = selection(setup, goal.targets, goal.exclude, samples=samples)
    changes = diff_observed(setup, seen, goal.wanted, exact=goal.exact)
    found = (*_problems(seen, goal.wanted), *_absences(setup, seen, goal.wanted), *_doubts(setup, seen, goal.wanted))
    return replace(draft, only=only, changes=changes).told(*found)


def _problems(seen: Observation, wanted: LabState) -> Iterator[Diagnostic]:
    """What was wrong with what was seen: an error about a part that the goal does not name keeps nothing from it, and
    that nobody sees it is no matter of the goal's."""
    for problem in seen.problems:
        if problem.code == "marker-hidden" and problem.address not in wanted.components:
            continue
        touches = problem.severity != "error" or not problem.address or problem.address in wanted.components
        yield problem if touches else replace(problem, severity="warning")


def _absences(setup: Setup, seen: Observation, wanted: LabState) -> Iterator[Diagnostic]:
    told = {problem.address for problem in seen.problems}
    for name in sorted(setup.lab.inventory):
        part = seen.components.get(name)
        if name in told and (part is None or part.presence == "missing"):
            continue
        if part is not None and part.presence == "toppled":
            yield warning(
                "toppled", f"{name} lies on its side; nothing is moved near it",
                hint="set it upright by hand, then plan again", address=name,
            )  # fmt: skip
        elif (part is None or part.presence == "missing" or part.pose is None) and name in wanted.components:
            if part is not None and (part.presence == "held" or part.is_unlooked):
                continue
            slot, pose = place_of(setup, wanted, name)
            yield warning(
                "missing", f"nobody sees {name}, which belongs {f'in {slot}' if slot else f'at {pose}'}",
                hint="put it where a camera sees it, then plan again; the rest is planned without it", address=name,
            )  # fmt: skip


def _doubts(setup: Setup, seen: Observation, wanted: LabState) -> Iterator[Diagnostic]:
    for name, part in sorted(seen.components.items()):
        if name in setup.lab.inventory and uncertain(setup, name, part, place_of(setup, wanted, name)[0]):
            yield warning(
                "uncertain",
                f"{name} was seen at {part.pose} only to within {part.uncertainty.position:.2g} mm and "
                f"{part.uncertainty.yaw:.2g}°, less exactly than it must stand",
                hint="look again from nearer, or uncover its marker", address=name,
            )  # fmt: skip
