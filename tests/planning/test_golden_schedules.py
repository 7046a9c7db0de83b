"""When operations start, and what their graph says, for random lists of operations, kept as text: see `kept`."""

from __future__ import annotations

import random

from kept import differs

from pico.model.operation import Operation, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.planning.explaining.graph import graph_of
from pico.planning.passes.schedule import least_makespan, makespan, schedule

CHANGED = Reason(kind="changed")


def listed(rng: random.Random) -> list[Operation]:
    """Moves of two arms, parks, people and set-points that share parts and zones; some wait for others."""
    found: list[Operation] = []
    for n in range(rng.randint(2, 9)):
        robot = rng.choice(("arm1", "arm1", "arm2", None, None))
        primitive = rng.choice(("move", "stow", "park")) if robot else rng.choice(("set", "set", "home", "operator"))
        needs = [f"p{rng.randrange(3)}", *([robot] if robot else []), *(["zone"] if rng.random() < 0.3 else [])]
        after = tuple(f"a{e}" for e in range(n) if rng.random() < 0.2)
        found.append(Operation(
            id=f"a{n}", primitive=primitive, component=needs[0], robot=robot, after=after, resources=tuple(needs),
            reason=CHANGED, seconds=rng.choice((0.0, 0.1, 1.0, 2.5, 7 / 3, 10.0)),
        ))  # fmt: skip
    return found


def test_schedules_of_random_operations_are_the_ones_kept() -> None:
    lines: list[str] = []
    for seed in range(60):
        rng = random.Random(seed)
        made = schedule(listed(rng))
        bounds = [least_makespan(made, arms) for arms in (None, 0.0, 3.0, 50.0)]
        lines.append(f"seed {seed}: {makespan(made):.9g} s of at least {bounds}")
        plan = Plan(
            lab=LabRef(name="l", digest="d"), backend="sim", fidelity="kinematic", base=Base(), target=Target(),
            operations=made, makespan=makespan(made),
        )  # fmt: skip
        graph = graph_of(plan)
        for node in graph.nodes:
            o = node.operation
            needs, after = ",".join(o.resources), ",".join(o.after)
            lines.append(
                f"  {o.id} {o.primitive} {needs} {o.start:.9g}+{o.seconds:.9g} after {after};"
                f" from {node.earliest:.9g}, spare {node.spare:.9g}{' critical' * node.critical}"
            )
        edges = (f"{e.source}-{e.target} {e.after:d}{e.critical:d}{e.implied:d} {e.resources}" for e in graph.edges)
        lines.append(f"  {graph.length:.9g} s along {','.join(graph.path)}: {'; '.join(edges)}")
    assert not differs("schedules.txt", "\n".join(lines) + "\n")
