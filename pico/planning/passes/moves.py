"""The moves of arms and people, in an order that never collides, or why there is none."""

from __future__ import annotations

from dataclasses import replace

from pico.model.plan import Staging
from pico.planning.checks.target import check_target
from pico.planning.checks.tethers import check_tethers
from pico.planning.passes.actors import actors, asides, hand_warnings
from pico.planning.passes.draft import Draft


def moves_ordered(draft: Draft) -> Draft:
    """Return the plan with the moves, and the parks at their end."""
    draft = replace(draft, staging=Staging(proven=True))
    if not draft.moving:
        return draft
    from pico.planning.explaining.proof import proof, standing_proof
    from pico.planning.explaining.refusal import explain, storage_note
    from pico.planning.ordering.remembered import remembered
    from pico.planning.ordering.solve import OrderedMoves, OrderingProblem, solve
    from pico.planning.passes.move_operations import move_operations

    movers, obstacles, put_off = actors(draft)
    draft = draft.told(*put_off)
    if not movers:
        return draft
    setup, goal = draft.setup, draft.goal
    impossible = check_target(setup, movers, obstacles, goal.source, alone=bool(goal.alone), motion=draft.motion)
    impossible += check_tethers(setup, movers, goal.source)
    if impossible:
        return replace(draft, blocking=standing_proof(setup, movers, obstacles, draft.motion)).told(*impossible)
    if goal.alone:
        movers = tuple(replace(m, stages=False) for m in movers)
    motion = remembered(draft.motion) if draft.motion else None
    answer = solve(OrderingProblem(
        setup, draft.seen, movers, tuple(obstacles), asides(draft, movers), motion,
        fastest=goal.prefer == "shortest-time",
    ))  # fmt: skip
    if not isinstance(answer, OrderedMoves):
        why = proof(answer)
        return replace(draft, blocking=why.blocking).told(*explain(answer, goal.source, why))
    operations, notes = move_operations(draft, answer)
    count, least = answer.staged, min(answer.staged, answer.least)
    return replace(
        draft, operations=(*draft.operations, *operations), bound=answer.tour.bound,
        staging=Staging(count=count, lower_bound=least, proven=count == least),
    ).told(*hand_warnings(draft, movers), *notes, *storage_note(answer))  # fmt: skip
