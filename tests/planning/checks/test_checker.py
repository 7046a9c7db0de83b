"""The checker itself: it must find what is wrong, or nothing that it passes means anything."""

from __future__ import annotations

from dataclasses import replace

from checker import check
from planning_benches import bench, part, planned, see, want

from pico.model.lab import Margins
from pico.model.plan import Plan


def swap(margin: float = 2.0) -> tuple:
    setup = bench({"a": "block", "b": "block"}, margins=Margins(body=margin, fingers=margin))
    seen, wanted = see(setup, {"a": (300, 300), "b": (500, 300)}), want({"a": (500, 300), "b": (300, 300)})
    return setup, seen, wanted, planned(setup, seen, wanted)


def reordered(made: Plan, order: list[int]) -> Plan:
    return replace(made, operations=tuple(replace(made.operations[i], after=()) for i in order))


def test_a_good_plan_passes() -> None:
    assert check(*swap()) == []


def test_overlap_is_found_at_any_margin() -> None:
    for margin in (0.0, 2.0):
        setup, seen, wanted, made = swap(margin)
        assert any("mm from" in f for f in check(setup, seen, wanted, reordered(made, [1, 0, 2, 3])))


def test_a_missing_dependency_is_found_in_another_order() -> None:
    setup, seen, wanted, made = swap()
    loose = replace(made, operations=tuple(replace(o, after=()) for o in made.operations))
    assert any("another order" in f for f in check(setup, seen, wanted, loose))


def test_a_plan_that_stops_short_is_found() -> None:
    setup, seen, wanted, made = swap()
    assert any("ends at" in f for f in check(setup, seen, wanted, replace(made, operations=made.operations[:1])))


def test_staging_of_what_is_never_staged_is_found() -> None:
    _, seen, wanted, made = swap()
    strict = bench({"a": part(stage="never"), "b": part(stage="never")})
    assert any("never staged" in f for f in check(strict, seen, wanted, made))


def test_fingers_are_found_where_a_neighbor_is_tall_enough() -> None:
    setup = bench({"a": part("one_way"), "b": "block"})
    seen, wanted = see(setup, {"a": (300, 300), "b": (600, 300)}), want({"a": (500, 300), "b": (600, 300)})
    made = planned(setup, seen, wanted)
    beside = see(setup, {"a": (300, 300), "b": (563, 300)})
    wanted = want({"a": (500, 300), "b": (563, 300)})
    assert any("fingers at place" in f for f in check(setup, beside, wanted, made))


def test_two_things_at_one_time_on_one_resource_are_found() -> None:
    setup, seen, wanted, made = swap()
    hasty = replace(made, operations=tuple(replace(o, start=0.0) for o in made.operations))
    assert any("at one time" in f for f in check(setup, seen, wanted, hasty))
