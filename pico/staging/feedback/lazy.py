"""The least cost of breaking all cycles of one part: a program over the cycles known, grown by those that are left."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from pico.staging.feedback.clauses import CLOSE, Cover, reached
from pico.staging.feedback.digraph import strong_components
from pico.staging.feedback.limit import WorkLeft
from pico.staging.feedback.literals import Clause, LiteralArc, Literals, bits
from pico.staging.feedback.shrink import minimal, successors
from pico.staging.feedback.walk import Pool, cost, first_choice, left_cycles, walk

THREES = 20_000
"""Up to so many cycles of three edges are looked at before the first program."""
MANY, ROUNDS = 40, 30
"""Components from which on cycles are sought before it by relaxations, which take a tenth of its time, and how many."""


@dataclass(frozen=True, slots=True)
class CoupledComponents:
    """Components whose choices bear on one another, and what is between them."""

    members: tuple[int, ...]
    edges: tuple[LiteralArc, ...]
    clauses: tuple[Clause, ...]


@dataclass(frozen=True, slots=True)
class Outcome:
    """The literals chosen (None: none known), a lower bound on the cost, whether there is proven to be no choice."""

    chosen: int | None
    bound: float
    infeasible: bool = False


def regions(edges: Sequence[LiteralArc], clauses: Sequence[Clause], table: Literals) -> list[CoupledComponents]:
    """Return the parts that a shrunk problem falls into, small ones first."""
    ring = {v: n for n, part in enumerate(strong_components(successors(edges))) for v in part}
    inside: dict[int, int] = {}
    for edge in edges:
        inside[ring[edge.tail]] = inside.get(ring[edge.tail], 0) | edge.escapes
    group: dict[int, set[int]] = {}
    for mask in [*inside.values(), *(c.escapes for c in clauses)]:
        together = set[int]().union(*(group.get(i, {i}) for i in table.components(mask)))
        group |= dict.fromkeys(together, together)
    found = {min(members): members for members in group.values()}
    return [
        CoupledComponents(
            tuple(sorted(members)),
            tuple(e for e in edges if table.components(inside[ring[e.tail]]) & members),
            tuple(c for c in clauses if table.components(c.escapes) & members),
        )
        for _, members in sorted(found.items(), key=lambda item: (len(item[1]), item[0]))
    ]


def solve_region(region: CoupledComponents, table: Literals, work: WorkLeft, steps: int) -> Outcome:
    """Return the cheapest choice for the components of a region; `steps` of local search before each program."""
    pool = Pool()
    pool.add(minimal([*region.clauses, *short_cycles(region.edges, table)]))
    best = walk(region.edges, pool, table, first_choice(table, region.members), steps, float("inf"))
    bound = 0.0
    literals = sorted(b for i in region.members for b in bits(table.of(i)))
    cover, column = cover_of(literals, region.members, table), {b: n for n, b in enumerate(literals)}
    given = 0
    if len(region.members) >= MANY:
        given, bound = _separated(region, table, pool, cover, column)
    while (best is None or not reached(cost(table, best), bound)) and not work.spent:
        given = _told(cover, pool, column, given)
        answer = cover.solve(work, None if best is None else frozenset(column[b] for b in bits(best)), bound)
        if answer.infeasible:
            return Outcome(None, float("inf"), True)
        bound = max(bound, answer.bound)
        if answer.chosen is None:
            break
        chosen = sum(1 << literals[n] for n in answer.chosen)
        best = _better(region, pool, table, chosen, best, steps)
    return Outcome(best, bound if best is None else min(bound, cost(table, best)))


def _told(cover: Cover, pool: Pool, column: Mapping[int, int], given: int) -> int:
    """Add the clauses of the pool behind those `given` to the program; return how many it has now."""
    for clause in pool.clauses[given:]:
        cover.one_of(column[b] for b in bits(clause.escapes))
    return len(pool.clauses)


def _separated(
    region: CoupledComponents, table: Literals, pool: Pool, cover: Cover, column: Mapping[int, int]
) -> tuple[int, float]:
    """Add cycles to pool and program, as long as the relaxed program, rounded, leaves some that it itself denies;
    return how many clauses the program has, and what every choice costs at least."""
    given, bound = 0, 0.0
    for _ in range(ROUNDS):
        given = _told(cover, pool, column, given)
        share, least = cover.relaxed()
        bound = max(bound, least)
        if not share:
            break
        most = [
            max(bits(group), key=lambda b: (share[column[b]], -b))
            for i in region.members for group in dict.fromkeys(table.groups(i))
        ]  # fmt: skip
        pool.add(left_cycles(region.edges, sum(1 << b for b in set(most))))
        if all(sum(share[column[b]] for b in bits(c.escapes)) > 1 - CLOSE for c in pool.clauses[given:]):
            break
    return given, bound


def _better(
    region: CoupledComponents, pool: Pool, table: Literals, chosen: int, best: int | None, steps: int
) -> int | None:
    """Return the better of `best` and what comes of the choice of a program; the cycles it leaves go to the pool."""
    ceiling = float("inf") if best is None else cost(table, best)
    found = left_cycles(region.edges, chosen)
    if not found:
        return chosen if cost(table, chosen) < ceiling else best
    pool.add(found)
    after = walk(region.edges, pool, table, chosen, steps, ceiling)
    return best if after is None else after


def cover_of(literals: Sequence[int], members: Sequence[int], table: Literals) -> Cover:
    """Return a program with one variable for each literal, in which each component takes its options."""
    column = {b: n for n, b in enumerate(literals)}
    cover = Cover([table.weights[b] for b in literals])
    for i in members:
        for group in dict.fromkeys(table.groups(i)):
            cover.exactly_one(column[b] for b in bits(group))
    return cover


def short_cycles(edges: Sequence[LiteralArc], table: Literals) -> list[Clause]:
    """Return the cycles of two edges, and those of three unless there are very many."""
    out: dict[int, dict[int, list[LiteralArc]]] = {}
    for edge in edges:
        out.setdefault(edge.tail, {}).setdefault(edge.head, []).append(edge)
    twos = list(_twos(out, table))
    threes = [clause for _, clause in zip(range(THREES), _threes(out, table), strict=False)]
    return [*twos, *threes]


def _twos(out: dict[int, dict[int, list[LiteralArc]]], table: Literals) -> Iterator[Clause]:
    for u, heads in out.items():
        for v in heads:
            if u < v:
                yield from _closed(heads[v], out.get(v, {}).get(u, ()), table)


def _threes(out: dict[int, dict[int, list[LiteralArc]]], table: Literals) -> Iterator[Clause]:
    for u, heads in out.items():
        for v in (v for v in heads if v > u):
            for w in (w for w in out.get(v, {}) if w > u and w != v and u in out.get(w, {})):
                paths = [LiteralArc(u, w, c.escapes, c.trail) for c in _closed(heads[v], out[v][w], table)]
                yield from _closed(paths, out[w][u], table)


def _closed(first: Sequence[LiteralArc], second: Sequence[LiteralArc], table: Literals) -> Iterator[Clause]:
    """Yield the pairs of which both may hold at once."""
    for a in first:
        for b in second:
            escapes = a.escapes | b.escapes
            if not table.always_escaped(escapes):
                yield Clause(escapes, a.trail + b.trail)
