"""A plan as a graph: what each operation waits for, how much time it has to spare, and which path decides the end."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

from pico.model.operation import Operation
from pico.model.plan import Plan
from pico.model.record import record

_NEAR = 1e-3
"""Two moments that differ by less are the same: times in a plan are rounded to 1e-6 s each."""


@record
class Dependency:
    """`target` starts when `source` is done: because the plan says so (`after`), because both need the `resources`
    named, or both. `critical`: both lie on the critical path, one after the other. `implied`: other edges lead there
    as well, so that a drawing can do without it."""

    source: str
    target: str
    after: bool
    resources: tuple[str, ...]
    critical: bool
    implied: bool


@record
class ScheduledOperation:
    """One operation. `earliest`: when it can start at all [s]; `spare`: by how much it may start later than that
    without the plan ending later [s]. `critical`: it lies on the critical path."""

    operation: Operation
    earliest: float
    spare: float
    critical: bool


@record
class PlanGraph:
    """The operations of a plan in its order, the edges between them, and the ids along the critical path.

    `length` is the sum of what the operations on the critical path take [s]: the makespan, where no operation of the
    plan starts later than it could.
    """

    plan: str
    makespan: float
    length: float
    path: tuple[str, ...]
    nodes: tuple[ScheduledOperation, ...]
    edges: tuple[Dependency, ...]


def graph_of(plan: Plan) -> PlanGraph:
    """Return the graph of a plan: `after` edges, the order in which operations use each resource, the critical path.

    The critical path method: earliest starts forward, latest starts backward (Kelley and Walker, 1959).
    """
    import networkx as nx

    operations = {o.id: o for o in plan.operations}
    order = _in_order(plan.operations)
    links = _links(plan.operations, order)
    graph = nx.DiGraph(list(links))
    graph.add_nodes_from(order)
    earliest, rest = _earliest(operations, order, graph.pred), _rest(operations, order, graph.succ)
    length = max((earliest[i] + rest[i] for i in order), default=0.0)
    path = _critical(operations, order, graph.pred, earliest, rest, length)
    steps = set(pairwise(path))
    direct = steps | set(nx.transitive_reduction(graph).edges)
    return PlanGraph(
        plan=plan.digest, makespan=plan.makespan, length=round(length, 6), path=path,
        nodes=tuple(
            ScheduledOperation(operation=o, earliest=round(earliest[i], 6), critical=i in path,
                 spare=_spare(length - earliest[i] - rest[i]))
            for i, o in operations.items()
        ),
        edges=tuple(
            Dependency(source=a, target=b, after=a in operations[b].after, resources=resources,
                 critical=(a, b) in steps, implied=(a, b) not in direct)
            for (a, b), resources in links.items()
        ),
    )  # fmt: skip


def _spare(seconds: float) -> float:
    return round(seconds, 6) if seconds > _NEAR else 0.0


def _in_order(operations: Sequence[Operation]) -> tuple[str, ...]:
    """Return the ids by start and end, each after all that it waits for, whatever their times say."""
    import networkx as nx

    graph = nx.DiGraph((e, o.id) for o in operations for e in o.after)
    graph.add_nodes_from(o.id for o in operations)
    rank = {o.id: (o.start, o.start + o.seconds, n) for n, o in enumerate(operations)}
    return tuple(nx.lexicographical_topological_sort(graph, rank.__getitem__))


def _links(operations: Sequence[Operation], order: Sequence[str]) -> dict[tuple[str, str], tuple[str, ...]]:
    """Return who waits for whom, and for which resources: each goes from one operation to the next that needs it."""
    found: dict[tuple[str, str], tuple[str, ...]] = {(e, o.id): () for o in operations for e in o.after}
    needs = {o.id: o.resources for o in operations}
    users: dict[str, list[str]] = {}
    for i in order:
        for resource in needs[i]:
            users.setdefault(resource, []).append(i)
    for resource, turn in sorted(users.items()):
        for pair in pairwise(turn):
            found[pair] = (*found.get(pair, ()), resource)
    return found


def _earliest(
    operations: Mapping[str, Operation], order: Sequence[str], before: Mapping[str, Iterable[str]]
) -> dict[str, float]:
    starts: dict[str, float] = {}
    for i in order:
        starts[i] = max((starts[e] + operations[e].seconds for e in before[i]), default=0.0)
    return starts


def _rest(
    operations: Mapping[str, Operation], order: Sequence[str], behind: Mapping[str, Iterable[str]]
) -> dict[str, float]:
    """Return how long it takes at least from the start of each operation to the end of the plan [s]."""
    rest: dict[str, float] = {}
    for i in reversed(order):
        rest[i] = operations[i].seconds + max((rest[e] for e in behind[i]), default=0.0)
    return rest


def _critical(
    operations: Mapping[str, Operation], order: Sequence[str], before: Mapping[str, Iterable[str]],
    earliest: Mapping[str, float], rest: Mapping[str, float], length: float,
) -> tuple[str, ...]:  # fmt: skip
    """Return one path without spare time, from an operation that starts at once to the one that ends last."""
    tight = [i for i in order if abs(length - earliest[i] - rest[i]) < _NEAR]
    path = [i for i in tight if abs(earliest[i] + operations[i].seconds - length) < _NEAR][-1:]
    while path and before[path[-1]]:
        ends = {e: earliest[e] + operations[e].seconds for e in before[path[-1]]}
        last = max(ends, key=lambda e: (round(ends[e], 6), order.index(e)))
        path.append(last)
    return tuple(reversed(path))
