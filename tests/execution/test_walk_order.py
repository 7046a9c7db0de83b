"""The graph of a plan: order, resources, what is skipped, and graphs that are none."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.diagnostics import PicoError
from pico.execution.graph import Graph, ordered
from pico.model.operation import Operation, Reason


def op(id: str, *after: str, needs: tuple[str, ...] = ()) -> Operation:
    return Operation(id=id, primitive="set", component=id, after=after, resources=needs, reason=Reason(kind="changed"))


def ids(operations: list[Operation] | tuple[Operation, ...]) -> list[str]:
    return [o.id for o in operations]


def test_an_arm_takes_its_operations_in_the_order_of_the_plan() -> None:
    graph = Graph([op("a", needs=("arm",)), op("b", needs=("arm", "p1")), op("c", needs=("p1",)), op("d")])
    assert ids(graph.ready()) == ["a", "d"]
    graph.start(graph.operations[0])
    assert ids(graph.ready()) == ["d"]
    graph.finish(graph.operations[0], "done")
    assert ids(graph.ready()) == ["b", "d"]


def test_a_failure_skips_dependents_however_far_and_frees_its_resource() -> None:
    graph = Graph([op("a", needs=("arm",)), op("b", "a", needs=("arm",)), op("c", "b"), op("d", needs=("arm",))])
    graph.start(graph.operations[0])
    assert ids(graph.finish(graph.operations[0], "failed")) == ["b", "c"]
    assert ids(graph.ready()) == ["d"]


@pytest.mark.parametrize(
    ("operations", "text"),
    [
        ([op("a", "b"), op("b", "a")], "wait for one another"),
        ([op("a", "a")], "wait for one another"),
        ([op("a", "z")], "does not have"),
        ([op("a"), op("a")], "same id"),
    ],
)
def test_what_is_no_graph_is_refused(operations: list[Operation], text: str) -> None:
    with pytest.raises(PicoError, match=text):
        Graph(operations)


@st.composite
def graphs(draw: st.DrawFn) -> list[Operation]:
    count = draw(st.integers(1, 8))
    found = []
    for n in range(count):
        after = draw(st.sets(st.integers(0, n - 1))) if n else set()
        needs = tuple(sorted(draw(st.sets(st.sampled_from(["arm", "bus", "p1"])))))
        found.append(op(f"op{n}", *(f"op{a}" for a in sorted(after)), needs=needs))
    return draw(st.permutations(found))


@given(graphs(), st.randoms(use_true_random=False))
def test_every_walk_ends_with_dependencies_kept_and_resources_used_by_one_at_a_time(operations, random) -> None:  # type: ignore[no-untyped-def]
    graph, running, done = Graph(operations), [], []
    while True:
        for ready in graph.ready():
            graph.start(ready)
            running.append(ready)
        used = [r for o in running for r in o.resources]
        assert len(used) == len(set(used))
        if not running:
            break
        over = running.pop(random.randrange(len(running)))
        assert set(over.after) <= set(done)
        graph.finish(over, "done")
        done.append(over.id)
    assert sorted(done) == sorted(ids(operations))


@given(graphs())
def test_order_is_kept_where_it_can_be(operations: list[Operation]) -> None:
    found = ordered(operations)
    assert ordered(found) == found
    place = {o.id: i for i, o in enumerate(found)}
    assert all(place[a] < place[o.id] for o in found for a in o.after)
