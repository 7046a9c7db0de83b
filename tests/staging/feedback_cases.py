"""Small random problems and their exhaustive answers, independent of the solver: every set, every choice is tried."""

from __future__ import annotations

import random
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from itertools import combinations, product

from pico.staging.feedback import Arc, Choice, Component, Cycle, Option, PartEvent, StagingProblem, arrives, leaves


def acyclic(vertices: Iterable[object], arcs: Iterable[tuple[object, object]]) -> bool:
    sorter: TopologicalSorter[object] = TopologicalSorter(dict.fromkeys(vertices, ()))
    for u, v in arcs:
        sorter.add(v, u)
    try:
        sorter.prepare()
    except CycleError:
        return False
    return True


def random_digraph(rng: random.Random) -> tuple[list[list[int]], dict[int, float], set[int]]:
    """Return successors, weights and forbidden vertices of a graph of up to nine vertices, self-loops included."""
    n = rng.randint(1, 9)
    density = rng.choice((0.1, 0.2, 0.3, 0.5))
    arcs = [[v for v in range(n) if rng.random() < (density if u != v else 0.03)] for u in range(n)]
    whole = rng.random() < 0.5
    weights = {v: float(rng.randint(1, 4)) if whole else rng.choice((0.25, 0.7, 1.0, 1.9)) for v in range(n)}
    if rng.random() < 0.4:
        weights = dict.fromkeys(range(n), 1.0)
    forbidden = {v for v in range(n) if rng.random() < 0.25} if rng.random() < 0.4 else set[int]()
    return arcs, weights, forbidden


def least_feedback(successors: list[list[int]], weights: dict[int, float], forbidden: set[int]) -> float | None:
    """Return the least weight of a feedback vertex set, None where there is none."""
    every = range(len(successors))
    best: float | None = None
    for size in range(len(successors) + 1):
        for chosen in combinations([v for v in every if v not in forbidden], size):
            weight = sum(weights[v] for v in chosen)
            if best is not None and weight >= best:
                continue
            rest = [v for v in every if v not in chosen]
            if acyclic(rest, [(u, v) for u in rest for v in successors[u] if v not in chosen]):
                best = weight
    return best


def all_to_move(
    successors: Sequence[Collection[int]], weights: Mapping[int, float] | None = None, forbidden: Collection[int] = ()
) -> StagingProblem:
    """Return the problem of components that each leave before their successors arrive; the `forbidden` are never
    staged, what succeeds itself never moves directly. To stage the cheapest is to meet every cycle of the digraph.
    """
    one, cost, parts = (Option(0),), weights or {}, []
    for i, following in enumerate(successors):
        staged = () if i in forbidden else one
        parts.append(Component(() if i in following else one, staged, staged, cost.get(i, 1.0)))
    return StagingProblem(
        tuple(parts), tuple(Arc(leaves(u), arrives(v)) for u, vs in enumerate(successors) for v in vs)
    )


def random_problem(rng: random.Random) -> StagingProblem:
    """Return two to four components with a few options each; some never staged, some never direct, some with two
    goals; weights one, whole or broken."""
    n = rng.randint(2, 4)
    goals = [2 if rng.random() < 0.2 else 1 for _ in range(n)]
    weights = rng.choice(((1.0,), (1.0, 2.0, 3.0), (0.4, 1.0, 2.3)))
    fill = rng.choice((0.1, 0.2, 0.35))
    parts = [_component(rng, i, goals, rng.choice(weights), fill) for i in range(n)]
    arcs = [a for i in range(n) for a in _arcs(rng, i, goals, fill / 2, ("body",))]
    return StagingProblem(tuple(parts), tuple(arcs))


def _component(rng: random.Random, i: int, goals: list[int], weight: float, fill: float) -> Component:
    def options(least: int, most: int, kinds: tuple[str, ...]) -> tuple[Option, ...]:
        return tuple(
            Option(f"o{k}", tuple(_arcs(rng, i, goals, fill, kinds)), rng.randrange(goals[i]))
            for k in range(rng.randint(least, most))
        )

    staged = rng.random() < 0.75
    direct = options(0 if rng.random() < 0.15 else 1, 3, ("pick", "place"))
    pick, place = (options(1, 2, ("pick",)), options(1, 2, ("place",))) if staged else ((), ())
    return Component(direct, pick, place, weight)


def _arcs(rng: random.Random, i: int, goals: list[int], fill: float, kinds: tuple[str, ...]) -> Iterator[Arc]:
    """Yield arcs as fingers and bodies bring them: what `i` does, against `j` where it stands and where it ends."""
    for j in range(len(goals)):
        for kind in kinds:
            mine = leaves(i) if kind == "pick" else arrives(i)
            if j != i and rng.random() < fill:
                yield Arc(leaves(j), mine, kind)
            if j != i and kind != "body" and rng.random() < fill:
                at = ((j, rng.randrange(goals[j])),) if goals[j] > 1 and rng.random() < 0.7 else ()
                yield Arc(mine, arrives(j), f"{kind} {at}", at)


def choices(component: Component) -> list[Choice]:
    """Return every way to move a component."""
    direct = [Choice(direct=n) for n in range(len(component.direct))]
    picks, places = range(len(component.pick)), range(len(component.place))
    return direct + [Choice(pick=p, place=q) for p in picks for q in places]


def all_choices(problem: StagingProblem) -> Iterator[tuple[Choice, ...]]:
    return product(*(choices(c) for c in problem.components))


def holding(problem: StagingProblem, made: tuple[Choice, ...]) -> list[Arc]:
    """Return the arcs that hold under a choice for each component."""
    arcs, ends = list(problem.arcs), []
    for component, choice in zip(problem.components, made, strict=True):
        taken = (component.direct[choice.direct],) if choice.direct is not None else (
            component.pick[choice.pick or 0], component.place[choice.place or 0])  # fmt: skip
        arcs += [a for option in taken for a in option.arcs]
        ends.append(taken[-1].goal)
    return [a for a in arcs if all(ends[j] == goal for j, goal in a.goals)]


def possible(problem: StagingProblem, made: tuple[Choice, ...]) -> bool:
    """Whether all events have an order under a choice; a direct move is one event."""

    def node(event: PartEvent) -> object:
        return event if made[event.component].staged else event.component

    arcs = [(node(a.before), node(a.after)) for a in holding(problem, made)]
    arcs += [(leaves(i), arrives(i)) for i, c in enumerate(made) if c.staged]
    return acyclic([], arcs)


def weight_of(problem: StagingProblem, made: tuple[Choice, ...]) -> float:
    return sum(p.weight for p, c in zip(problem.components, made, strict=True) if c.staged)


def least_staging(problem: StagingProblem) -> float | None:
    """Return the least weight of what is staged, None where no choice leaves an order."""
    weights = sorted({weight_of(problem, made): None for made in all_choices(problem)})
    for weight in weights:
        if any(weight_of(problem, m) == weight and possible(problem, m) for m in all_choices(problem)):
            return weight
    return None


def closes(problem: StagingProblem, made: tuple[Choice, ...], cycle: Cycle) -> bool:
    """Whether every link of a cycle holds under a choice, and each ends where the next begins."""
    present = {(a.before.component, a.before.what, a.after.component, a.after.what, a.kind) for a in
               holding(problem, made)}  # fmt: skip
    for link, after in zip(cycle, cycle[1:] + cycle[:1], strict=True):
        if link[2:4] != after[:2]:
            return False
        always = link[4] == "same part" and link[0] == link[2]
        at_once = link[4] == "same move" and not made[link[0]].staged
        if not (always or at_once or link in present):
            return False
    return True
