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
from typing import Any

from pico.staging.sequencing.flow import Network
from pico.staging.sequencing.problem import Masks, Tour

Cut = tuple[int, int]
"""Two sets of operations as bits, the start and the park among them as bit m: one arc at least goes from the first to
the second."""

VIOLATED = 0.01
"""A cut is worth adding where so much is missing."""
SUPPORT = 1e-7
"""An arc used less than this is not used."""
SLACK = 1e-7
"""By so much an arc may be worth more to the program than it says; all arcs of an order together are taken off."""


def cut_bound(tour: Tour, bound: float, rounds: int) -> float:
    """Return a cost that no order of `tour` can beat, at least `bound`, after so many rounds of cuts."""
    arcs = [(i, j) for i in range(tour.count + 1) for j in range(tour.count + 1) if tour.follows(i, j)]
    scale = max(abs(tour.arcs[i][j]) for i, j in arcs) or 1.0
    program = _assignment_program(tour, arcs, scale)
    known: dict[Cut, None] = {}
    pairs = _direct_pairs(tour.before)
    for turn in range(rounds):
        program.run()
        value = program.getInfo().objective_function_value
        bound = max(bound, scale * (value - SLACK * (tour.count + 1)))
        if turn + 1 == rounds:
            break
        shares = program.getSolution().col_value
        used = [(i, j, x) for (i, j), x in zip(arcs, shares, strict=True) if x > SUPPORT]
        new = [c for c in violated(tour, pairs, used) if c not in known]
        if not new:
            break
        known |= dict.fromkeys(new)
        _add(program, arcs, new)
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


def _assignment_program(tour: Tour, arcs: abc.Sequence[tuple[int, int]], scale: float) -> Any:
    """Return the program in which every operation is entered and left once; its costs are at most 1."""
    import highspy
    import numpy as np

    program: Any = highspy.Highs()  # type: ignore[no-untyped-call]
    for option, value in (("output_flag", False), ("threads", 1), ("random_seed", 0)):
        program.setOptionValue(option, value)
    for i, j in arcs:
        program.addCol(tour.arcs[i][j] / scale, 0.0, 1.0, 0, np.empty(0, np.int32), np.empty(0))
    ends = np.array(arcs)
    for k in range(tour.count + 1):
        for end in (0, 1):
            _add_row(program, np.flatnonzero(ends[:, end] == k), 1.0)
    return program


def _add(program: Any, arcs: abc.Sequence[tuple[int, int]], cuts: abc.Iterable[Cut]) -> None:
    import numpy as np

    ends = np.array(arcs)
    nodes = int(ends.max()) + 1
    for out, into in cuts:
        leaves, enters = (np.array([mask >> k & 1 for k in range(nodes)], bool) for mask in (out, into))
        _add_row(program, np.flatnonzero(leaves[ends[:, 0]] & enters[ends[:, 1]]), float("inf"))


def _add_row(program: Any, columns: Any, most: float) -> None:
    """Add 1 <= sum of the columns <= most."""
    import numpy as np

    program.addRow(1.0, most, len(columns), columns.astype(np.int32), np.ones(len(columns)))
