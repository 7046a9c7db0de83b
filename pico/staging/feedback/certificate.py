"""Why no choice leaves the events an order: cycles of which every choice closes one, and none of which is needless."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from pico.staging.feedback.lazy import cover_of
from pico.staging.feedback.limit import Limit, WorkLeft
from pico.staging.feedback.literals import Clause, LiteralArc, Literals, bits
from pico.staging.feedback.problem import Cycle, Link
from pico.staging.feedback.walk import Pool, left_cycles


def certificate(
    edges: Sequence[LiteralArc], links: Sequence[Link], table: Literals, hints: Iterable[Clause], limit: Limit
) -> tuple[Cycle, ...]:
    """Return the cycles that make a problem impossible, shortest first. `hints`: cycles to begin with.

    The `table` has all literals alive again. Where the limit is reached some of them may be needless, or there is none.
    """
    escapes = _escapes(edges, links, table)
    pool = Pool()
    work = limit.work()
    pool.add(sorted({_simple(c.trail, links, escapes) for c in hints}, key=_rank))
    pool.add([_simple(e.trail, links, escapes) for e in edges if e.tail == e.head])
    enough = _smallest(pool.clauses) or _enough(edges, links, table, pool, work)
    needed = _needed(enough, table, limit.work()) if len(enough) > 1 else enough
    return tuple(tuple(links[n] for n in clause.trail) for clause in sorted(needed, key=_rank))


def _rank(clause: Clause) -> tuple[int, tuple[int, ...]]:
    return len(clause.trail), clause.trail


def _smallest(clauses: Sequence[Clause]) -> list[Clause]:
    """Return the shortest cycle that nothing breaks, if there is one."""
    return sorted((c for c in clauses if not c.escapes), key=_rank)[:1]


def _escapes(edges: Sequence[LiteralArc], links: Sequence[Link], table: Literals) -> dict[int, int]:
    """Return what escapes each original arc: leaving and arriving at once, any pick of the component."""
    own = {e.trail[0]: e.escapes for e in edges if len(e.trail) == 1}
    return {n: table.parts[link[0]]["pick"] for n, link in enumerate(links)} | own


def _simple(trail: Sequence[int], links: Sequence[Link], escapes: dict[int, int]) -> Clause:
    """Return a cycle within a closed walk that passes no event twice, and is more than one component's own two."""
    walk = list(trail)
    first: dict[tuple[int, str], int] = {}
    n = 0
    while n < len(walk):
        here = links[walk[n]][:2]
        if here not in first:
            first[here] = n
            n += 1
            continue
        loop, rest = walk[first[here] : n], walk[: first[here]] + walk[n:]
        own = [links[k][4] for k in loop]
        walk = rest if sorted(own) == ["same move", "same part"] or len(rest) < len(loop) else loop
        first, n = {}, 0
    mask = 0
    for k in walk:
        mask |= escapes[k]
    turn = walk.index(min(walk))
    return Clause(mask, tuple(walk[turn:] + walk[:turn]))


def _enough(
    edges: Sequence[LiteralArc], links: Sequence[Link], table: Literals, pool: Pool, work: WorkLeft
) -> list[Clause]:
    """Add cycles to the pool until no choice breaks them all; returns these, none where the work does not suffice."""
    escapes = _escapes(edges, links, table)
    members = [i for i in range(len(table.parts)) if table.of(i)]
    literals = list(bits(table.alive))
    cover, given = cover_of(literals, members, table), 0
    while not work.spent:
        for clause in pool.clauses[given:]:
            cover.one_of(bits(clause.escapes))
        given = len(pool.clauses)
        answer = cover.solve(work)
        if answer.infeasible:
            return pool.clauses
        if answer.chosen is None:
            break
        found = left_cycles(edges, sum(1 << literals[n] for n in answer.chosen))
        pool.add([_simple(c.trail, links, escapes) for c in found])
        if shortest := _smallest(pool.clauses):
            return shortest
    return []


def _needed(clauses: Sequence[Clause], table: Literals, work: WorkLeft) -> list[Clause]:
    """Return clauses none of which the others can do without, short ones preferred: QuickXplain (Junker, 2004)."""

    def among(given: list[Clause], fresh: bool, left: list[Clause]) -> list[Clause]:
        if fresh and _contradict(given, table, work):
            return []
        if len(left) == 1:
            return left
        first, second = left[: len(left) // 2], left[len(left) // 2 :]
        late = among(given + first, bool(first), second)
        return among(given + late, bool(late), first) + late

    return among([], False, sorted(clauses, key=_rank))


def _contradict(clauses: Sequence[Clause], table: Literals, work: WorkLeft) -> bool:
    """Whether no choice meets the clauses; not, where that is not known within the work left."""
    if work.spent:
        return False
    members = sorted(set[int]().union(*(table.components(c.escapes) for c in clauses)))
    literals = sorted(b for i in members for b in bits(table.of(i)))
    column = {b: n for n, b in enumerate(literals)}
    cover = cover_of(literals, members, table)
    for clause in clauses:
        cover.one_of(column[b] for b in bits(clause.escapes))
    return cover.solve(work).infeasible
