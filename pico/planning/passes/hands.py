"""Hands that were stopped on their way: what they hold is set down before all else, and arms that stand out park."""

from __future__ import annotations

from dataclasses import replace

from pico.model.observation import astray
from pico.planning.checks.emission import lets_out
from pico.planning.parts.setdown import park_operation, parked_first, set_downs
from pico.planning.passes.draft import Draft


def hands_emptied(draft: Draft) -> Draft:
    """Return the plan with what empties the hands; the bench is seen as it then is, and the arms that stay where they
    stand are in the way of the others."""
    found = set_downs(draft.setup, draft.seen, draft.motion)
    draft = replace(draft, seen=found.seen, operations=found.operations).told(*found.diagnostics)
    if not any(astray(draft.setup, found.seen)) and not any(hand.holding for hand in found.seen.robots.values()):
        return draft
    from pico.planning.parts.standing_arms import beside_standing

    return replace(draft, motion=beside_standing(draft.setup, found.seen, draft.motion))


def hands_first(draft: Draft) -> Draft:
    """Return the plan with all else after the hands are emptied, and a park of each robot that does nothing else."""
    first = [o for o in draft.operations if o.reason.kind == "held"]
    if not first:
        return draft
    last, rest = first[-1].id, draft.operations[len(first) :]
    out = [*first, *(replace(o, after=o.after or (last,)) for o in rest)]
    for robot in sorted({o.robot or "" for o in first} - {o.robot for o in rest}):
        out.append(park_operation(draft.setup, draft.seen, robot, (last,), draft.motion))
        last = out[-1].id  # one at a time: they may meet
    return replace(draft, operations=tuple(out))


def arms_parked(draft: Draft) -> Draft:
    """Return the plan with parks of the arms that were stopped with an empty hand, before all else; where only some of
    the bench is asked for, they stay, unless light comes out."""
    if not draft.only.everything and not any(lets_out(draft.setup, o) for o in draft.operations):
        return draft
    return replace(draft, operations=parked_first(draft.setup, draft.seen, draft.operations, draft.motion))
