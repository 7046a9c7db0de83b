"""Why plans of random labs are as they are, kept as text: see `kept`."""

from __future__ import annotations

from collections.abc import Iterator

from fuzzing import plan_case
from kept import differs
from random_labs import random_case

from pico.planning.explaining.explain import Explanation, explain
from pico.planning.explaining.graph import graph_of


def told(why: Explanation) -> Iterator[str]:
    for step in why.steps:
        spare = " critical" if step.critical else f" spare {step.spare:g}"
        yield f"  {step.operation.id} {step.operation.component}{spare} {step.change.text if step.change else ''}"
        for wait in step.waits_for:
            yield f"    waits for {wait.operation} {wait.component} until {wait.until:g}, {wait.resource}"
            yield from (f"      {b.kind}: {b.text}" for b in wait.because)
        yield from (f"    holds up {wait.operation} {wait.component}" for wait in step.holds_up)
    yield f"  {why.fewer.moved} parts in {why.fewer.moves} moves"
    yield from (f"    ring: {'; '.join(block.text for block in ring)}" for ring in why.fewer.rings)
    yield from (f"  clash: {clash.a} {clash.b} {clash.by.text}" for clash in why.clashes)
    yield from (f"  block: {block.text}" for block in why.blocks)


def test_explanations_of_random_labs_are_the_ones_kept() -> None:
    lines: list[str] = []
    for seed in range(200, 225):
        case = random_case(seed, least=3, most=9)
        made = plan_case(case)
        graph = graph_of(made)
        lines += [f"seed {seed}: {', '.join(graph.path)} in {graph.length:g} of {made.makespan:g} s"]
        lines += [
            f"  {e.source} to {e.target} {e.after:d}{e.critical:d}{e.implied:d} {e.resources}" for e in graph.edges
        ]
        lines += told(explain(case.setup, made))
    assert not differs("explanations.txt", "\n".join(lines) + "\n")
