"""What is wrong with the operations of a plan: who would be lit, which light nobody lets out, who stands in the way."""

from __future__ import annotations

from pico.model.observation import left_standing
from pico.planning.checks.clearance import beams_in_the_way
from pico.planning.checks.emission import refused, uncovered
from pico.planning.checks.interlocks import unguarded
from pico.planning.passes.draft import Draft


def operations_checked(draft: Draft) -> Draft:
    """Return the plan with errors and warnings about lasers, and about arms that it leaves where they were stopped."""
    bench, robots = (draft.setup, draft.seen, draft.operations), {o.robot for o in draft.operations}
    return draft.told(*unguarded(*bench), *uncovered(*bench), *left_standing(draft.setup, draft.seen, robots))


def asked_checked(draft: Draft) -> Draft:
    """Return the plan of operations that somebody asked for with errors and warnings about lasers: light that nobody
    lets out is an error, and not left out."""
    bench = (draft.setup, draft.seen, draft.operations)
    return draft.told(*unguarded(*bench), *refused(*bench))


def beams_checked(draft: Draft) -> Draft:
    """Return the plan with a warning for each beam that its changes would put in the way of something."""
    if not draft.operations:
        return draft
    return draft.told(*beams_in_the_way(draft.setup, draft.seen, draft.goal.wanted, draft.changes))
