"""Why a plan is as it is: every edge of the order stands for something that can be measured on the table."""

from __future__ import annotations

import pytest
from fuzzing import plan_case
from hypothesis import given, settings
from hypothesis import strategies as st
from planning_benches import bench, part, planned, see, want
from random_labs import random_case

from examples import examples
from pico.diagnostics import PicoError
from pico.geometry import placed, separation
from pico.model.lab import Slot
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.planning.checks.contacts import Contact, spot_of
from pico.planning.explaining.blocking import blocks_of, ring_through, why_impossible
from pico.planning.explaining.explain import explain, kind_of

MOVES = ("move", "stow", "operator")


def swap(**stage: str) -> tuple[Setup, Plan]:
    """Two blocks change places, 60 mm wide each; one has to step aside."""
    setup = bench({n: part(stage=stage.get(n, "allowed")) for n in ("a", "b")})
    seen = see(setup, {"a": (200, 300), "b": (400, 300)})
    return setup, planned(setup, seen, want({"a": (400, 300), "b": (200, 300)}))


def chain() -> tuple[Setup, Plan]:
    """`a` must leave before `b` takes its place, with 35 mm in common."""
    setup = bench({"a": "block", "b": "block", "far": "block"})
    seen = see(setup, {"a": (200, 300), "b": (600, 300), "far": (700, 100)})
    return setup, planned(setup, seen, want({"a": (400, 300), "b": (225, 300), "far": (700, 100)}))


def test_an_edge_says_by_how_much_the_bases_would_overlap() -> None:
    setup, plan = chain()
    (step,) = explain(setup, plan, "b").steps
    (wait,) = [w for w in step.waits_for if w.resource is None]
    assert wait.component == "a"
    assert wait.because[0].contact == Contact(kind="base", overlap=35.0, margin=2.0)
    assert wait.because[0].text == "if a still stood at (200, 300, 0°), their bases would overlap by 35 mm"


def test_what_waits_is_told_from_both_ends() -> None:
    setup, plan = chain()
    (a,), (b,) = explain(setup, plan, "a").steps, explain(setup, plan, "b").steps
    (held,) = [w for w in a.holds_up if w.component == "b"]
    (wait,) = [w for w in b.waits_for if w.component == "a"]
    assert held.because == wait.because
    assert wait.until == pytest.approx(a.operation.start + a.operation.seconds)
    assert b.operation.start >= wait.until - 1e-6


def test_a_finger_that_would_touch_is_told_with_its_depth() -> None:
    setup = bench({"a": part("one_way"), "b": part("one_way")})
    seen = see(setup, {"a": (300, 300), "b": (100, 300)})
    plan = planned(setup, seen, want({"a": (600, 300), "b": (364, 300)}))
    contacts = [c.contact for s in explain(setup, plan, "b").steps for w in s.waits_for for c in w.because]
    # jaws 30 wide open 10 beside it, 14 thick: 39 mm from its center, 25 from the next base
    assert {(c.kind, c.overlap) for c in contacts if c} == {("finger", 5.0)}


@settings(deadline=None, max_examples=examples(30))
@given(st.integers(0, 100_000))
def test_every_edge_between_two_moves_stands_for_a_contact(seed: int) -> None:
    case = random_case(seed, least=4, most=14)
    plan = plan_case(case)
    by_id = {o.id: o for o in plan.operations}
    for step in explain(case.setup, plan).steps:
        for wait in step.waits_for:
            other = by_id[wait.operation]
            if wait.resource or other.primitive not in MOVES or step.operation.primitive not in MOVES:
                continue
            if other.component == step.operation.component:
                assert [b.kind for b in wait.because] == ["own"]
                continue
            assert wait.because and all(b.contact for b in wait.because), (seed, step.operation.id, wait)
            for because in wait.because:
                contact = because.contact  # rounding may put what is just inside the margin on its edge
                assert contact and contact.overlap >= -max(contact.margin, 1e-3) - 1e-6


def test_an_overlap_is_what_the_footprints_have_in_common() -> None:
    setup, plan = chain()
    a, b = (next(o for o in plan.operations if o.component == n) for n in "ab")
    at, to = spot_of(setup, a.arguments["from"]), spot_of(setup, b.arguments["to"])
    assert at and to
    shape = setup.type_of("a").geometry.footprint
    assert -separation(placed(shape, at.pose), placed(shape, to.pose)) == pytest.approx(35)


def test_a_stop_on_the_way_is_explained_by_its_ring() -> None:
    setup, plan = swap()
    fewer = explain(setup, plan).fewer
    assert (fewer.moved, fewer.moves) == (2, 3)
    (ring,) = fewer.rings
    assert {(b.blocker, b.blocked, b.by.overlap) for b in ring} == {("a", "b", 60.0), ("b", "a", 60.0)}
    assert explain(setup, plan, "a").fewer.rings[0][0].blocker == "a"


def test_without_a_stop_there_is_no_ring_to_tell() -> None:
    setup, plan = chain()
    fewer = explain(setup, plan).fewer
    assert (fewer.moved, fewer.moves, fewer.rings) == (2, 2, ())


def test_an_impossible_ring_is_told_as_who_blocks_whom() -> None:
    setup, plan = swap(a="never", b="never")
    assert plan.errored
    found = explain(setup, plan)
    assert {(b.blocker, b.blocked) for b in found.blocks} == {("a", "b"), ("b", "a")}
    assert found.clashes == () and found.steps == ()
    assert explain(setup, plan, "a").blocks == found.blocks
    assert kind_of(plan, "a") == "impossible"


def test_goals_that_overlap_are_a_clash_of_two() -> None:
    setup = bench({"a": "block", "b": "block", "c": "block"})
    seen = see(setup, {"a": (200, 420), "b": (520, 420), "c": (700, 100)})
    plan = planned(setup, seen, want({"a": (505, 420), "b": (520, 420), "c": (700, 200)}))
    clashes, blocks = why_impossible(setup, plan)
    assert [(c.a, c.b, c.by.overlap) for c in clashes] == [("a", "b", 45.0)]
    assert blocks == ()


def test_a_plan_that_can_be_applied_has_nothing_impossible() -> None:
    setup, plan = swap()
    assert why_impossible(setup, plan) == ((), ())


def test_a_ring_by_fingers_says_that_every_grasp_was_tried() -> None:
    setup = bench({"a": part("one_way"), "b": part("one_way")}, {"s1": Slot(x=60, y=60)})
    seen = see(setup, {"a": (300, 300), "b": (364, 300)})
    plan = planned(setup, seen, want({"a": (300, 100), "b": (364, 100)}))
    blocks = blocks_of(setup, plan)
    assert {(b.blocker, b.blocked, b.every_grasp) for b in blocks} == {("a", "b", True), ("b", "a", True)}
    assert len(ring_through("a", blocks)) == 2
    assert "every grasp angle tried" in blocks[0].text


def test_what_a_plan_leaves_alone() -> None:
    setup, plan = chain()
    assert explain(setup, plan, "far").steps == ()
    assert kind_of(plan, "far") == "stays"


def test_an_unknown_component_is_named() -> None:
    setup, plan = chain()
    with pytest.raises(PicoError, match="no component `lar`"):
        explain(setup, plan, "lar")
