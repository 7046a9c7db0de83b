"""A problem as bits: one for each option that may be chosen, and for each arc those options that keep it from holding.

An arc holds unless one of its `escapes` is chosen; a cycle is broken by any escape of any of its arcs. So a cycle is a
clause, the union of these bits, of which one at least must be chosen; a cycle without any is impossible to avoid.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from pico.staging.feedback.problem import (
    Arc,
    Choice,
    Component,
    Link,
    Option,
    Part,
    PartEvent,
    StagingProblem,
    arrives,
    leaves,
)

PARTS: tuple[Part, ...] = ("direct", "pick", "place")


@dataclass(frozen=True, slots=True)
class LiteralArc:
    """An arc between events by number. `trail`: the numbers of the original arcs that it stands for, in order."""

    tail: int
    head: int
    escapes: int
    trail: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Clause:
    """A cycle: the literals of which one must be chosen, and the original arcs."""

    escapes: int
    trail: tuple[int, ...]


@dataclass(slots=True)
class Literals:
    """The bits of a problem: for each component and part the union of its options, where each bit belongs, which are
    still `alive`, and which cost a staging (`paid`)."""

    parts: list[dict[Part, int]] = field(default_factory=list)
    meaning: list[tuple[int, Part, int]] = field(default_factory=list)
    weights: list[float] = field(default_factory=list)
    alive: int = 0
    paid: int = 0

    def groups(self, component: int) -> tuple[int, int]:
        """Return the two sets of literals of which exactly one is chosen: a direct move, or a pick and a place."""
        part = self.parts[component]
        return (part["direct"] | part["pick"]) & self.alive, (part["direct"] | part["place"]) & self.alive

    def of(self, component: int) -> int:
        """Return all literals of a component."""
        first, second = self.groups(component)
        return first | second

    def always_escaped(self, escapes: int) -> bool:
        """Whether every choice meets `escapes`, because it holds all options of some component's part."""
        return any(not g & ~escapes for i in self.components(escapes) for g in self.groups(i))

    def components(self, mask: int) -> set[int]:
        """Return the components that literals belong to."""
        return {self.meaning[n][0] for n in bits(mask)}

    def choice(self, chosen: int, component: int) -> Choice:
        """Return the options that are chosen for a component."""
        found: dict[str, int] = {}
        for n in bits(chosen & self.of(component)):
            _, part, option = self.meaning[n]
            found[part] = option
        return Choice(**found)


def bits(mask: int) -> Iterator[int]:
    """Yield the numbers of the bits of a mask, least first."""
    while mask:
        low = mask & -mask
        yield low.bit_length() - 1
        mask ^= low


def number(event: PartEvent) -> int:
    return 2 * event.component + (event.what == "arrives")


def event(number: int) -> PartEvent:
    return arrives(number // 2) if number % 2 else leaves(number // 2)


def literals_of(problem: StagingProblem) -> Literals:
    """Return the literals of a problem; a component that is never staged has none for picking and placing."""
    table = Literals()
    for i, component in enumerate(problem.components):
        part: dict[Part, int] = dict.fromkeys(PARTS, 0)
        for name in PARTS:
            for n in range(len(options_for(component, name))):
                part[name] |= 1 << len(table.meaning)
                table.paid |= part["pick"]
                table.meaning.append((i, name, n))
                table.weights.append(component.weight if name == "pick" else 0.0)
        table.parts.append(part)
    table.alive = (1 << len(table.meaning)) - 1
    return table


def options_for(component: Component, part: Part) -> tuple[Option, ...]:
    """Return the options of a part; none to pick and place what is never staged."""
    if part == "direct":
        return component.direct
    return (component.pick if part == "pick" else component.place) if component.may_be_staged else ()


def edges_of(problem: StagingProblem, table: Literals) -> tuple[list[LiteralArc], list[Link]]:
    """Return the edges of a problem and what each original arc is called.

    A direct move leaves and arrives at once: what must come before it arrives must come before it leaves. So each edge
    to an arrival has a twin to the leaving, escaped by staging too. (One edge from arrival to leaving would do, but it
    would close a ring with the one back that means nothing.)
    """
    edges: list[LiteralArc] = []
    links: list[Link] = []
    at_once: dict[int, int] = {}
    for i, part in enumerate(table.parts):
        links.append((i, "arrives", i, "leaves", "same move" if part["direct"] else "no way"))
        at_once[i] = len(links) - 1
        if not table.of(i):
            edges.append(LiteralArc(2 * i, 2 * i, 0, (at_once[i],)))
    for arc, escapes in _arcs(problem, table):
        tail, head, i = number(arc.before), number(arc.after), arc.after.component
        links.append((arc.before.component, arc.before.what, i, arc.after.what, arc.kind))
        edges.append(LiteralArc(tail, head, escapes, (len(links) - 1,)))
        if arc.after.what == "arrives" and tail != 2 * i and table.parts[i]["direct"]:
            edges.append(LiteralArc(tail, 2 * i, escapes | table.parts[i]["pick"], (len(links) - 1, at_once[i])))
    return edges, links


def _arcs(problem: StagingProblem, table: Literals) -> Iterator[tuple[Arc, int]]:
    """Yield every arc with the literals that escape it."""
    for i in range(len(problem.components)):
        yield Arc(leaves(i), arrives(i), "same part"), 0
    for arc in problem.arcs:
        yield arc, _other_goals(problem, table, arc)
    for i in range(len(problem.components)):
        for arc, escapes in _conditional(problem, table, i):
            yield arc, escapes | _other_goals(problem, table, arc)


def _conditional(problem: StagingProblem, table: Literals, i: int) -> Iterator[tuple[Arc, int]]:
    """Yield the arcs of the options of a component with the literals that escape them. An arc of a pick and of a place
    alike counts twice, since either brings it."""
    component, part = problem.components[i], table.parts[i]
    holds: dict[Arc, dict[Part, int]] = {}
    for n in bits(table.of(i)):
        _, name, option = table.meaning[n]
        for arc in options_for(component, name)[option].arcs:
            holds.setdefault(arc, dict.fromkeys(PARTS, 0))[name] |= 1 << n
    for arc, by in holds.items():
        if not by["pick"] and not by["place"]:
            yield arc, (part["direct"] & ~by["direct"]) | part["pick"]
        for half in ("pick", "place"):
            if by[half]:
                yield arc, (part["direct"] & ~by["direct"]) | (part[half] & ~by[half])


def _other_goals(problem: StagingProblem, table: Literals, arc: Arc) -> int:
    """Return the literals by which a component ends at another goal than the arc asks for."""
    escapes = 0
    for j, goal in arc.goals:
        for name in ("direct", "place"):
            for n in bits(table.parts[j][name]):
                if options_for(problem.components[j], name)[table.meaning[n][2]].goal != goal:
                    escapes |= 1 << n
    return escapes
