"""The graph of a plan: its critical path is as long as the plan, and whatever lies on it has no time to spare."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st
from planning_benches import bench, planned, see, want

from pico.model.operation import Operation, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.planning.explaining.graph import graph_of
from pico.planning.passes.schedule import makespan, schedule

SECONDS = st.integers(0, 40).map(lambda n: n / 4)


def op(index: int, seconds: float, resources: tuple[str, ...] = (), after: tuple[int, ...] = ()) -> Operation:
    robot = next((r for r in resources if r.startswith("arm")), None)
    return Operation(
        id=f"a{index}", primitive="move" if robot else "set", component=f"c{index}", robot=robot, resources=resources,
        after=tuple(f"a{e}" for e in after), reason=Reason(kind="changed"), seconds=seconds,
    )  # fmt: skip


def plan_with(operations: list[Operation]) -> Plan:
    timed = schedule(operations)
    return Plan(
        lab=LabRef(name="bench", digest=""), backend="sim", fidelity="kinematic", base=Base(), target=Target(),
        operations=timed, makespan=makespan(timed),
    )  # fmt: skip


@st.composite
def plans(draw: st.DrawFn, seconds: st.SearchStrategy[float] = SECONDS) -> Plan:
    operations = []
    for n in range(draw(st.integers(1, 9))):
        arm = draw(st.sampled_from([(), ("arm1",), ("arm2",)]))
        others = draw(st.sets(st.sampled_from(["motor/a", "motor/b", "part"]), max_size=2))
        arms = [e for e in range(n) if operations[e].robot]
        waits = draw(st.sets(st.sampled_from(arms if arm else range(n)), max_size=2)) if (arms if arm else n) else set()
        operations.append(op(n, draw(seconds), (*arm, *sorted(others)), tuple(sorted(waits))))
    return plan_with(operations)


@given(plans())
def test_the_critical_path_is_as_long_as_the_plan(plan: Plan) -> None:
    graph = graph_of(plan)
    starts = {o.id: o for o in plan.operations}
    on_it = [starts[i] for i in graph.path]
    assert abs(sum(o.seconds for o in on_it) - plan.makespan) < 1e-4
    assert abs(graph.length - plan.makespan) < 1e-4
    assert on_it[0].start == 0.0
    for a, b in pairwise(on_it):
        assert abs(a.start + a.seconds - b.start) < 1e-4


@given(plans(st.integers(1, 40).map(float)))
def test_spare_time_is_what_an_operation_may_take_longer(plan: Plan) -> None:
    graph = graph_of(plan)
    for node in graph.nodes:
        assert node.spare == 0.0 or not node.critical
        longer = [
            replace(o, seconds=o.seconds + (node.spare + 1.0 if o.id == node.operation.id else 0.0))
            for o in plan.operations
        ]
        late = graph_of(replace(plan, operations=tuple(longer)))
        assert abs(late.length - plan.makespan - 1.0) < 1e-4


@given(plans())
def test_an_implied_edge_tells_nothing_new(plan: Plan) -> None:
    graph = graph_of(plan)
    drawn = {(e.source, e.target) for e in graph.edges if not e.implied}
    for edge in graph.edges:
        reached, front = set(), {edge.source}
        while front:
            front = {b for a, b in drawn if a in front} - reached
            reached |= front
        assert edge.target in reached


def test_a_motor_beside_the_arm_is_not_on_the_path() -> None:
    graph = graph_of(plan_with([op(0, 5, ("arm1",)), op(1, 7, ("arm1",)), op(2, 4, ("motor/a",))]))
    assert graph.length == 12
    beside = next(n for n in graph.nodes if n.operation.component == "c2")
    assert (beside.critical, beside.spare) == (False, 8)


def test_the_order_of_a_resource_is_an_edge_that_names_it() -> None:
    graph = graph_of(plan_with([op(0, 5, ("arm1",)), op(1, 7, ("arm1", "part")), op(2, 4, ("part",))]))
    named = {(e.source, e.target): e.resources for e in graph.edges}
    assert ("arm1",) in named.values()
    assert ("part",) in named.values()


def test_a_real_plan() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (200, 300), "b": (400, 300)})
    plan = planned(setup, seen, want({"a": (400, 300), "b": (200, 300)}))
    graph = graph_of(plan)
    assert abs(graph.length - plan.makespan) < 1e-3
    assert len(graph.nodes) == len(plan.operations)


def test_a_plan_without_operations_has_an_empty_graph() -> None:
    graph = graph_of(plan_with([]))
    assert (graph.nodes, graph.edges, graph.path, graph.length) == ((), (), (), 0.0)
