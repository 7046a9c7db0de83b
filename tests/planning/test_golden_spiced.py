"""Plans, refusals and explanations of random labs of every kind, kept as text: see `kept`. A few labs a test, so that
each is cheap; see `spiced_labs` for what is in them."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator

import pytest
from kept import differs
from spiced_labs import Spiced, move_alone, plan_spiced, spiced_case
from test_golden_explanations import told as told_why

from pico.diagnostics import PicoError
from pico.model.plan import Plan
from pico.planning.explaining.explain import explain, kind_of
from pico.planning.explaining.graph import graph_of

EACH = 10
"""Labs a test."""


def told(made: Plan) -> Iterator[str]:
    """All that a plan says, on few lines: what is done when, with what and after what, and what is said about it."""
    count = made.staging
    yield (
        f"  staged {count.count} of at least {count.lower_bound}{'' if count.proven else ', not proven'}; "
        f"{made.makespan:.9g} s of at least {made.bound}; absent {made.absent}; exit {made.exit_code}"
    )
    yield from (f"  {rule['text']}" for rule in made.policy)
    yield from (f"  changes {c.component}.{c.tunable}: {c.text}{' tolerated' * c.tolerated}" for c in made.changes)
    for d in made.diagnostics:
        yield f"  {d.severity} {d.code} {d.address}: {d.summary} | {d.detail} | {d.hint}"
    for o in made.operations:
        what = " ".join(f"{k} {v}" for k, v in o.arguments.items() if k not in ("from", "text"))
        yield f"  {o.id} {o.primitive} {o.component} {what}: {o.start:.9g}+{o.seconds:.9g} after {','.join(o.after)}"
        why = o.reason
        yield f"    with {','.join(o.resources)}: {why.kind} {why.of} {why.overlap} {why.text}"


def told_of_one(case: Spiced, made: Plan) -> Iterator[str]:
    """Why a plan does what it does with one part, and how that would be moved alone."""
    setup, graph, names = case.case.setup, graph_of(made), sorted(case.lab.inventory)
    name = names[len(made.operations) % 3]
    yield f"  why {name}: {' '.join(kind_of(made, n) for n in names)}"
    why = explain(setup, made, name)
    yield from (f"  {line}" for line in (*told_why(why), *(f"  said: {d.code} {d.address}" for d in why.diagnostics)))
    edges = (f"{e.source}{e.target}{e.after:d}{e.critical:d}{e.implied:d}{e.resources}" for e in graph.edges)
    all_of_it = "\n".join([*told_why(explain(setup, made)), *edges])
    shown = hashlib.sha256(all_of_it.encode()).hexdigest()[:12]
    yield f"  path {','.join(graph.path)} in {graph.length:g} s; the whole explanation and its graph: {shown}"
    try:
        alone = move_alone(case, name)
    except PicoError as refused:
        yield f"  {name} alone: {refused}"
        return
    yield f"  {name} alone: {', '.join(f'{o.primitive} {o.reason.kind} {o.after}' for o in alone.operations)}"
    yield from (f"    {d.code}: {d.summary}" for d in alone.diagnostics)


@pytest.mark.parametrize("first", range(0, 120, EACH))
def test_plans_of_labs_of_every_kind_are_the_ones_kept(first: int) -> None:
    lines: list[str] = []
    for seed in range(first, first + EACH):
        case = spiced_case(seed)
        lines += [f"seed {seed}: {' '.join(case.spices)}", *told(made := plan_spiced(case)), *told_of_one(case, made)]
    assert not differs(f"spiced_{first:03}.txt", "\n".join(lines) + "\n")
