"""A local search for a choice without cycles: break a cycle that is left by whichever escape leaves the least amiss.

It finds answers fast, though not their proof, and on its way the cycles that matter. After WalkSAT (Selman, Kautz and
Cohen, 1994) with clause weights.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass, field

from pico.staging.feedback.digraph import cyclic_components, ordered, shortest_cycle
from pico.staging.feedback.literals import Clause, LiteralArc, Literals, bits
from pico.staging.feedback.shrink import successors


@dataclass(slots=True)
class Pool:
    """The clauses known so far, no two with the same literals, in the order found."""

    clauses: list[Clause] = field(default_factory=list)
    known: set[int] = field(default_factory=set)

    def add(self, found: Sequence[Clause]) -> None:
        for clause in found:
            if clause.escapes not in self.known:
                self.known.add(clause.escapes)
                self.clauses.append(clause)


def left_cycles(edges: Sequence[LiteralArc], chosen: int) -> list[Clause]:
    """Return short cycles that a choice leaves: through each event, then through the rest without the worst event."""
    holding: dict[tuple[int, int], LiteralArc] = {}
    for edge in edges:
        if not edge.escapes & chosen:
            rival = holding.get((edge.tail, edge.head))
            if rival is None or edge.escapes.bit_count() < rival.escapes.bit_count():
                holding[edge.tail, edge.head] = edge
    succ = ordered(successors(holding[key] for key in sorted(holding)))
    found: dict[int, Clause] = {}
    while parts := cyclic_components(succ):
        for part in parts:
            alive, hits = set(part), dict.fromkeys(part, 0)
            for v in part:
                cycle = shortest_cycle(succ, v, alive) or []
                for w in cycle:
                    hits[w] += 1
                clause = _clause([holding[a, b] for a, b in zip(cycle, cycle[1:] + cycle[:1], strict=True)])
                found.setdefault(clause.escapes, clause)
            worst = max(part, key=lambda v: (hits[v], -v))
            succ = {u: [w for w in heads if w != worst] for u, heads in succ.items() if u != worst}
    return list(found.values())


def _clause(cycle: Sequence[LiteralArc]) -> Clause:
    escapes, trail = 0, tuple[int, ...]()
    for edge in cycle:
        escapes |= edge.escapes
        trail += edge.trail
    return Clause(escapes, trail)


def walk(edges: Sequence[LiteralArc], pool: Pool, table: Literals, start: int, steps: int, below: float) -> int | None:
    """Return a choice without cycles that costs less than `below`, found from `start` in so many steps, or None.
    Cycles met on the way go to the `pool`."""
    rng = random.Random(0)
    chosen, burden = start, [1.0] * len(pool.clauses)
    for _ in range(steps):
        amiss = [n for n, c in enumerate(pool.clauses) if not c.escapes & chosen]
        if not amiss:
            found = left_cycles(edges, chosen)
            if not found:
                chosen = unstaged(edges, pool, table, chosen)
                return chosen if cost(table, chosen) < below - 1e-9 else None
            pool.add(found)
            burden += [1.0] * (len(pool.clauses) - len(burden))
            continue
        for n in amiss:
            burden[n] += 1.0
        target = pool.clauses[amiss[int(rng.random() * len(amiss))]]
        ways = [after for literal in bits(target.escapes) for after in turned(table, chosen, literal)]
        if not ways:
            return None
        marks = [_penalty(pool, burden, after) + cost(table, after) for after in ways]
        chosen = ways[min(range(len(ways)), key=lambda k: (marks[k], rng.random()))]
    return None


def _penalty(pool: Pool, burden: Sequence[float], chosen: int) -> float:
    return sum(b for c, b in zip(pool.clauses, burden, strict=True) if not c.escapes & chosen)


def cost(table: Literals, chosen: int) -> float:
    """Return the weight of what a choice stages."""
    return sum(table.weights[n] for n in bits(chosen & table.paid))


def turned(table: Literals, chosen: int, literal: int) -> list[int]:
    """Return the choices that differ in one component, and there so that `literal` is chosen."""
    i, name, _ = table.meaning[literal]
    part = {p: mask & table.alive for p, mask in table.parts[i].items()}
    rest, one = chosen & ~table.of(i), 1 << literal
    if name == "direct":
        return [rest | one]
    other = part["place" if name == "pick" else "pick"]
    kept = chosen & other
    return [rest | one | kept] if kept else [rest | one | 1 << n for n in bits(other)]


def unstaged(edges: Sequence[LiteralArc], pool: Pool, table: Literals, chosen: int) -> int:
    """Return a choice without cycles in which no component is staged that one other option could spare."""
    for n in sorted(bits(chosen & table.paid), key=lambda n: (-table.weights[n], n)):
        i = table.meaning[n][0]
        for b in bits(table.parts[i]["direct"] & table.alive):
            after = chosen & ~table.of(i) | 1 << b
            if all(c.escapes & after for c in pool.clauses) and not left_cycles(edges, after):
                chosen = after
                break
    return chosen


def first_choice(table: Literals, members: Sequence[int]) -> int:
    """Return a choice for these components: direct where they can be, the first option of each."""
    chosen = 0
    for i in members:
        part = {p: mask & table.alive for p, mask in table.parts[i].items()}
        for mask in [part["direct"]] if part["direct"] else [part["pick"], part["place"]]:
            chosen |= mask & -mask
    return chosen
