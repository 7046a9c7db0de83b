"""What is right is moved only where there is no other way, and then no more of it than must be."""

from __future__ import annotations

from checker import check
from planning_benches import Places, bench, moves, planned, see, want

from pico.model.lab import Box2, Region
from pico.model.plan import Staging

ROW: Places = {"a": (600, 400), "b": (365, 300), "near": (215, 300), "beside": (300, 380), "front": (300, 220)}


def test_only_the_part_in_the_way_makes_room() -> None:
    # the jaws close along x and have no room beside b; what else stands near the goal of a is in nobody's way
    setup = bench({"a": "one_way", **dict.fromkeys(("b", "near", "beside", "front"), "block")})
    seen, wanted = see(setup, ROW), want({**ROW, "a": (300, 300)})
    made = planned(setup, seen, wanted)
    assert check(setup, seen, wanted, made) == []
    assert [name for name, _ in moves(made)] == ["b", "a", "b"]
    assert made.staging == Staging(count=1, lower_bound=1, proven=True)


def test_a_free_table_that_does_not_help_keeps_nobody_from_making_room() -> None:
    free = {"front": Region(area=Box2(x=(500, 760), y=(20, 160)), staging=True)}
    setup = bench({"a": "one_way", **dict.fromkeys(("b", "near", "beside", "front"), "block")}, regions=free)
    seen, wanted = see(setup, ROW), want({**ROW, "a": (300, 300)})
    made = planned(setup, seen, wanted)
    assert check(setup, seen, wanted, made) == []
    assert [name for name, _ in moves(made)] == ["b", "a", "b"]
