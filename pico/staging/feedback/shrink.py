"""Makes a problem small before it is solved: arcs that close no cycle, options that are never better, and events that
can be led past. Nothing of it changes the least cost of an answer.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from pico.staging.feedback.digraph import strong_components
from pico.staging.feedback.literals import Clause, LiteralArc, Literals, bits

FILL = 2
"""How many more edges than it takes away leading past an event may bring."""


def shrink(edges: Sequence[LiteralArc], table: Literals) -> tuple[list[LiteralArc], list[Clause]]:
    """Return the edges and clauses that are left; literals that need not be chosen die in `table`.

    A clause without literals: there is no answer.
    """
    left = [e for e in edges if e.tail != e.head]
    clauses = [Clause(e.escapes, e.trail) for e in edges if e.tail == e.head]
    while True:
        before = (table.alive, len(left), len(clauses))
        left = on_cycles(strongest(living(left, table)))
        clauses = minimal(living_clauses(clauses, table))
        left, found = led_past(left, table)
        clauses = minimal([*clauses, *found])
        if any(not c.escapes for c in clauses):
            return left, clauses
        table.alive &= ~never_better(left, clauses, table)
        if (table.alive, len(left), len(clauses)) == before:
            return left, clauses


def living(edges: Iterable[LiteralArc], table: Literals) -> list[LiteralArc]:
    """Return the edges that may hold, escaped by living literals only."""
    found = []
    for edge in edges:
        escapes = edge.escapes & table.alive
        if not table.always_escaped(escapes):
            found.append(edge if escapes == edge.escapes else LiteralArc(edge.tail, edge.head, escapes, edge.trail))
    return found


def living_clauses(clauses: Iterable[Clause], table: Literals) -> list[Clause]:
    """Return the clauses that are not met by every choice, with living literals only."""
    found = [Clause(c.escapes & table.alive, c.trail) for c in clauses]
    return [c for c in found if not table.always_escaped(c.escapes)]


def strongest(edges: Iterable[LiteralArc]) -> list[LiteralArc]:
    """Return the edges without those that hold only where another between the same events holds."""
    kept: dict[tuple[int, int], list[LiteralArc]] = {}
    for edge in sorted(edges, key=lambda e: (e.escapes.bit_count(), len(e.trail), e.trail)):
        rivals = kept.setdefault((edge.tail, edge.head), [])
        if not any(r.escapes & ~edge.escapes == 0 for r in rivals):
            rivals.append(edge)
    return [e for rivals in kept.values() for e in rivals]


def minimal(clauses: Iterable[Clause]) -> list[Clause]:
    """Return the clauses without those that another implies."""
    kept: list[Clause] = []
    for clause in sorted(clauses, key=lambda c: (c.escapes.bit_count(), len(c.trail), c.trail)):
        if not any(k.escapes & ~clause.escapes == 0 for k in kept):
            kept.append(clause)
    return kept


def successors(edges: Iterable[LiteralArc]) -> dict[int, set[int]]:
    """Return the out-neighbors of each event that has an edge."""
    succ: dict[int, set[int]] = {}
    for edge in edges:
        succ.setdefault(edge.tail, set()).add(edge.head)
        succ.setdefault(edge.head, set())
    return succ


def on_cycles(edges: Sequence[LiteralArc]) -> list[LiteralArc]:
    """Return the edges within strong components."""
    part = {v: n for n, component in enumerate(strong_components(successors(edges))) for v in component}
    return [e for e in edges if part[e.tail] == part[e.head]]


def led_past(edges: Sequence[LiteralArc], table: Literals) -> tuple[list[LiteralArc], list[Clause]]:
    """Remove events one after the other, leading every path through them past, while that brings few new edges."""
    before: dict[int, list[LiteralArc]] = {}
    after: dict[int, list[LiteralArc]] = {}
    for edge in edges:
        after.setdefault(edge.tail, []).append(edge)
        before.setdefault(edge.head, []).append(edge)
    found: list[Clause] = []
    queue = sorted({e.tail for e in edges} | {e.head for e in edges}, reverse=True)
    queued = set(queue)
    while queue:
        v = queue.pop()
        queued.discard(v)
        into, out = before.get(v, []), after.get(v, [])
        if len(into) * len(out) > 4 * (len(into) + len(out)):
            continue
        paths = strongest(_joined(into, out, table))
        if len(paths) > len(into) + len(out) + FILL:
            continue
        near = {e.tail for e in into} | {e.head for e in out}
        _take_away(v, into, out, before, after)
        for path in paths:
            if path.tail == path.head:
                found.append(Clause(path.escapes, path.trail))
            elif not any(e.escapes & ~path.escapes == 0 for e in after[path.tail] if e.head == path.head):
                _put(path, before, after)
        queue += sorted(near - queued, reverse=True)
        queued |= near
    return [e for v in sorted(after) for e in after[v]], found


def _joined(into: Iterable[LiteralArc], out: Sequence[LiteralArc], table: Literals) -> list[LiteralArc]:
    """Return the paths of two edges, without those of which the two exclude one another."""
    paths = []
    for a in into:
        for b in out:
            escapes = a.escapes | b.escapes
            if not table.always_escaped(escapes):
                paths.append(LiteralArc(a.tail, b.head, escapes, a.trail + b.trail))
    return paths


def _take_away(
    v: int,
    into: list[LiteralArc],
    out: list[LiteralArc],
    before: dict[int, list[LiteralArc]],
    after: dict[int, list[LiteralArc]],
) -> None:
    for edge in into:
        after[edge.tail].remove(edge)
    for edge in out:
        before[edge.head].remove(edge)
    before.pop(v, None)
    after.pop(v, None)


def _put(path: LiteralArc, before: dict[int, list[LiteralArc]], after: dict[int, list[LiteralArc]]) -> None:
    """Add an edge; those that hold only where it holds go."""
    for edge in [e for e in after[path.tail] if e.head == path.head and path.escapes & ~e.escapes == 0]:
        after[path.tail].remove(edge)
        before[path.head].remove(edge)
    after[path.tail].append(path)
    before[path.head].append(path)


def never_better(edges: Sequence[LiteralArc], clauses: Sequence[Clause], table: Literals) -> int:
    """Return literals that can be given up: another of the same part escapes whatever they escape, or one direct option
    whatever any staged move escapes."""
    escaped: dict[int, int] = {}
    for n, mask in enumerate([*(e.escapes for e in edges), *(c.escapes for c in clauses)]):
        for literal in bits(mask):
            escaped[literal] = escaped.get(literal, 0) | 1 << n
    dead = 0
    for part in table.parts:
        for mask in part.values():
            dead |= _dominated(list(bits(mask & table.alive)), escaped)
        staged = (part["pick"] | part["place"]) & table.alive
        reach = 0
        for b in bits(staged):
            reach |= escaped.get(b, 0)
        if staged and any(not reach & ~escaped.get(b, 0) for b in bits(part["direct"] & table.alive & ~dead)):
            dead |= staged
    return dead


def _dominated(literals: Sequence[int], escaped: dict[int, int]) -> int:
    dead = 0
    for a in literals:
        mine = escaped.get(a, 0)
        for b in literals:
            if a == b or dead >> b & 1:
                continue
            theirs = escaped.get(b, 0)
            if not mine & ~theirs and (mine != theirs or b < a):
                dead |= 1 << a
                break
    return dead
