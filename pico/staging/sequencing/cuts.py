"""A lower bound from the assignment program, tightened by cuts that precedence implies.

After Balas, Fischetti and Pulleyblank, The precedence-constrained asymmetric traveling salesman polytope, Mathematical
Programming 68 (1995). With x(A : B) the number of arcs used from A to B, S a set of operations, T all else with the
start and the park, every order fulfills

    x(S - before(S) : T - before(S)) >= 1      the last of S comes before nothing in S, and is left for something in T
    x(T - after(S) : S - after(S)) >= 1        the first of S, in the same way
    x(S - X : T - X) >= 1                      i in S before j in T, X = before(i), after(j), start and park: between
                                               i and j nothing of X is met.

Sets that a fractional solution violates are smallest cuts; those of the first two are then widened from before(i) of
the one operation that the cut was looked for to before(S), which costs nothing and tightens much.
"""

from __future__ import annotations

from collections import abc

from pico.staging.sequencing.assignment import Assignment
from pico.staging.sequencing.flow import Network
from pico.staging.sequencing.problem import Effort, Masks, Tour
from pico.staging.sequencing.program import Cut, CutProgram

VIOLATED = 0.01
"""A cut is worth adding where so much is missing."""
SUPPORT = 1e-7
"""An arc used less than this is not used."""


def cut_bound(tour: Tour, order: abc.Sequence[int], floor: Assignment, limit: Effort) -> float:
    """Return a cost that no order of `tour` can beat, at least that of `floor`: after so many rounds of cuts, or as far
    as the pivots of `limit` lead. `order`: one that keeps the precedence."""
    program = CutProgram(tour, order, floor.excess, limit.pivots)
    bound = floor.bound
    known: dict[Cut, None] = {}
    pairs = _direct_pairs(tour.before)
    for turn in range(limit.rounds):
        bound = max(bound, program.bound())
        if turn + 1 == limit.rounds or program.pivots <= 0:
            break
        new = [c for c in violated(tour, pairs, program.used(SUPPORT)) if c not in known]
        if not new:
            break
        known |= dict.fromkeys(new)
        program.add(new)
    return bound


def violated(tour: Tour, pairs: abc.Iterable[tuple[int, int]], used: abc.Sequence[tuple[int, int, float]]) -> list[Cut]:
    """Return cuts that the arcs used, with their shares, do not fulfill, each once."""
    park, everything = tour.count, (2 << tour.count) - 1
    network = Network(tour.count + 1, used)
    found: dict[Cut, None] = {}
    for j, (earlier, later) in enumerate(zip(tour.before, tour.after, strict=True)):
        side = network.cut(j, park, earlier, 1 - VIOLATED)
        if side is not None:
            banned = _union(tour.before, side)
            found[side & ~banned, everything & ~side & ~banned] = None
        side = network.cut(park, j, later, 1 - VIOLATED)
        if side is not None:
            rest = everything & ~side & ~later
            banned = _union(tour.after, rest)
            found[everything & ~rest & ~banned, rest & ~banned] = None
    for i, j in pairs:
        banned = tour.before[i] | tour.after[j] | 1 << park
        side = network.cut(i, j, banned, 1 - VIOLATED)
        if side is not None:
            found[side, everything & ~side & ~banned] = None
    return list(found)


def _direct_pairs(before: Masks) -> list[tuple[int, int]]:
    """Return the pairs (i, j) where i comes before j and nothing has to come between."""
    pairs = []
    for j, earlier in enumerate(before):
        distant = _union(before, earlier)
        pairs += [(i, j) for i in _members(earlier & ~distant)]
    return pairs


def _members(mask: int) -> list[int]:
    return [k for k in range(mask.bit_length()) if mask >> k & 1]


def _union(masks: Masks, members: int) -> int:
    union = 0
    for k in _members(members):
        union |= masks[k]
    return union
