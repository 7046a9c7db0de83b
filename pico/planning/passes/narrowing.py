"""A plan for some of the components: only what it changes counts as its changes."""

from __future__ import annotations

from dataclasses import replace

from pico.planning.parts.selection import done_by, samples_kept, told
from pico.planning.passes.draft import Draft


def narrowed(draft: Draft) -> Draft:
    """Return the plan with the changes that are asked for or made all the same, and with what is said of the rest."""
    only, changes, operations, goal = draft.only, draft.changes, draft.operations, draft.goal
    if goal.alone:
        return replace(draft, changes=tuple(c for c in changes if c.component == goal.alone))
    if not only.everything and operations:
        draft = draft.told(*told(only, changes, operations))
    staying = tuple(samples_kept(only, changes))
    if staying:
        without = {*(goal.target.exclude or ()), *(f"{one.address}.pose" for one in staying)}
        goal = replace(goal, target=replace(goal.target, exclude=tuple(sorted(without))))
    if staying or not only.everything:
        done = done_by(operations)
        changes = tuple(c for c in changes if only.chosen(c.component, c.tunable) or (c.component, c.tunable) in done)
    return replace(draft, goal=goal, changes=changes).told(*staying)
