"""Fewest components staged, with a way to move each, so that all events have an order; or why there is none."""

from __future__ import annotations

from collections.abc import Sequence

from pico.staging.feedback.certificate import certificate
from pico.staging.feedback.clauses import reached
from pico.staging.feedback.lazy import Outcome, regions, solve_region
from pico.staging.feedback.limit import Limit, WorkLeft
from pico.staging.feedback.literals import Clause, LiteralArc, Literals, edges_of, event, literals_of
from pico.staging.feedback.problem import Choice, PartEvent, StagingAnswer, StagingProblem
from pico.staging.feedback.shrink import shrink
from pico.staging.feedback.walk import cost, first_choice

STEPS = 60
"""Steps of local search before each program."""


def solve(problem: StagingProblem, limit: Limit | None = None) -> StagingAnswer:
    """Return the cheapest set of components to stage, with the options of all, so that no event waits for itself.

    Exact: `proven` says that no other choice is cheaper, or (`options` None) that there is none, for which `cycles`
    then stand. Otherwise the limit was reached: the best answer known, if any. The same problem and limit always give
    the same answer. Raises ValueError for a weight that is not above 0 or an arc to a component that is not there.
    """
    limit = limit or Limit()
    _check(problem)
    table = literals_of(problem)
    edges, links = edges_of(problem, table)
    everything, work = table.alive, limit.work()
    left, clauses = shrink(edges, table)
    outcome = _solve_all(left, clauses, table, work)
    table.alive = everything
    if outcome.infeasible:
        cycles = certificate(edges, links, table, clauses, limit)
        return StagingAnswer((), None, (), float("inf"), float("inf"), True, cycles)
    if outcome.chosen is None:
        return StagingAnswer((), None, (), float("inf"), outcome.bound, False)
    return _answer(problem, table, edges, outcome.chosen, outcome.bound)


def _check(problem: StagingProblem) -> None:
    count = len(problem.components)
    if any(not c.weight > 0 for c in problem.components):
        raise ValueError("weights must be above 0")
    arcs = [*problem.arcs, *(a for c in problem.components for o in (*c.direct, *c.pick, *c.place) for a in o.arcs)]
    named = {i for a in arcs for i in (a.before.component, a.after.component, *(j for j, _ in a.goals))}
    if any(not 0 <= i < count for i in named):
        raise ValueError(f"an arc names a component that is not among the {count}")


def _solve_all(edges: Sequence[LiteralArc], clauses: Sequence[Clause], table: Literals, work: WorkLeft) -> Outcome:
    """Solve region by region; components in none take the first option that is left."""
    if any(not c.escapes for c in clauses):
        return Outcome(None, float("inf"), True)
    found = regions(edges, clauses, table)
    inside = {i for region in found for i in region.members}
    alone = first_choice(table, [i for i in range(len(table.parts)) if i not in inside])
    chosen: int | None = alone
    bound = cost(table, alone)
    for region in found:
        outcome = solve_region(region, table, work, STEPS)
        if outcome.infeasible:
            return outcome
        bound += outcome.bound
        chosen = None if chosen is None or outcome.chosen is None else chosen | outcome.chosen
    return Outcome(chosen, bound)


def _answer(
    problem: StagingProblem, table: Literals, edges: Sequence[LiteralArc], chosen: int, bound: float
) -> StagingAnswer:
    choices = tuple(table.choice(chosen, i) for i in range(len(problem.components)))
    staged = tuple(i for i, c in enumerate(choices) if c.staged)
    weight = sum(problem.components[i].weight for i in staged)
    order = _order(choices, [e for e in edges if not e.escapes & chosen])
    proven = reached(weight, bound)
    return StagingAnswer(staged, choices, order, weight, weight if proven else bound, proven)


def _order(choices: Sequence[Choice], edges: Sequence[LiteralArc]) -> tuple[PartEvent, ...]:
    """Return the events in an order along all edges; a direct move is one, of two events."""
    import networkx as nx

    at = [2 * i + (half if c.staged else 0) for i, c in enumerate(choices) for half in (0, 1)]
    graph = nx.DiGraph((at[e.tail], at[e.head]) for e in edges if at[e.tail] != at[e.head])
    graph.add_nodes_from(at)
    order = nx.lexicographical_topological_sort(graph)
    return tuple(event(w) for v in order for w in ((v,) if choices[v // 2].staged else (v, v + 1)))
