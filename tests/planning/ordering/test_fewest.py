"""As few stagings as can be: against a search through everything on small tables, and what the plan says about it."""

from __future__ import annotations

import pytest
from checker import check
from exhaustive import Undecided, least_moves
from fuzzing import plan_case
from planning_benches import bench, moves, planned, see, want
from random_labs import random_case

from pico.model.lab import Box2, Region, Slot
from pico.model.plan import Staging
from pico.model.pose import Pose
from pico.motion.types import Joints, MovePath, Segment


@pytest.mark.parametrize(("seeds", "enough"), [(5, 1), pytest.param(20, 4, marks=pytest.mark.slow)])
def test_a_proven_plan_has_no_more_moves_than_any_other(seeds: int, enough: int) -> None:
    compared = 0
    for seed in range(7000, 7000 + seeds):
        case = random_case(seed, least=4, most=5)
        made = plan_case(case)
        if made.errored or not made.staging.count or any(o.reason.kind == "in_the_way" for o in made.operations):
            continue
        try:
            least = least_moves(case, limit=1500)
        except Undecided:
            continue
        assert made.staging.proven and len(moves(made)) == least, seed
        compared += 1
    assert compared >= enough


def test_two_rings_that_share_a_component_are_broken_there() -> None:
    # b stands at the goals of a and c, and both stand at its goal: a rail of 120 mm takes the room of two blocks
    setup = bench({"a": "block", "b": "rail", "c": "block"})
    seen = see(setup, {"a": (268, 300), "b": (500, 300), "c": (332, 300)})
    made = planned(setup, seen, want({"a": (468, 300), "b": (300, 300), "c": (532, 300)}))
    assert made.staging == Staging(count=1, lower_bound=1, proven=True)
    assert moves(made)[0][0] == "b"


def test_where_storage_has_room_for_less_the_plan_says_so() -> None:
    # two swaps far apart, one slot: one after the other, each through the slot
    setup = bench(dict.fromkeys("abcd", "block"), {"s1": Slot(x=60, y=60)})
    seen = see(setup, {"a": (200, 300), "b": (300, 300), "c": (500, 300), "d": (600, 300)})
    made = planned(setup, seen, want({"a": (300, 300), "b": (200, 300), "c": (600, 300), "d": (500, 300)}))
    assert made.staging == Staging(count=2, lower_bound=2, proven=True)
    assert [to for _, to in moves(made)].count("s1") == 2


def test_the_shortest_time_is_never_longer_than_that_of_the_fewest_moves() -> None:
    class Arm:
        """An arm whose hand moves 100 mm/s straight, and takes 5 s to pick and place."""

        def reach(self, *_: object) -> None:
            return None

        def travel(self, robot: str, a: Pose | None, b: Pose | None, *_: float) -> float:
            return a.distance(b) / 100 if a and b else 1.0

        def carry(self, robot: str, name: str, a: Pose, b: Pose, yaw: float) -> float:
            return 5 + a.distance(b) / 100

        def move(self, robot: str, name: str, a: Pose, b: Pose, yaw: float, standing: object, at: Joints) -> MovePath:
            seconds = self.travel(robot, Pose(*at) if at else None, a) + self.carry(robot, name, a, b, yaw)
            return MovePath(robot, name, (Segment("transit", (0.0, seconds), ((b.x, b.y), (b.x, b.y)), 50.0),))

        def park(self, robot: str, at: Joints, standing: object) -> MovePath:
            return MovePath(robot, None, (Segment("park", (0.0, 1.0), (at, at), 50.0),))

    for seed in range(20, 30):
        case = random_case(seed, least=6, most=10)
        few, fast = (
            planned(case.setup, case.seen, case.wanted, Arm(), prefer=prefer)  # type: ignore[arg-type]
            for prefer in ("fewest-moves", "shortest-time")
        )
        assert fast.errored == few.errored
        if not fast.errored:
            assert check(case.setup, case.seen, case.wanted, fast) == []
            assert few.staging.count <= fast.staging.count
            assert fast.makespan <= few.makespan + 1e-6
            if len({o.robot for o in few.operations}) == 1:
                assert few.bound == few.makespan, "so few moves are in the best order"


def test_the_free_table_is_used_where_a_lab_allows_it_and_slots_do_not_suffice() -> None:
    free = {"front": Region(area=Box2(x=(0, 200), y=(200, 500)), staging=True)}
    seen = {"a": (300, 300), "b": (500, 300)}
    wanted = want({"a": (500, 300), "b": (300, 300)})
    without, beside = bench({"a": "block", "b": "block"}, {}), bench({"a": "block", "b": "block"}, regions=free)
    alone = bench({"a": "block", "b": "block"}, {}, regions=free)
    assert planned(without, see(without, seen), wanted).errored
    assert moves(planned(beside, see(beside, seen), wanted))[0][1] == "s2"
    made = planned(alone, see(alone, seen), wanted)
    assert check(alone, see(alone, seen), wanted, made) == []
    assert made.staging == Staging(count=1, lower_bound=1, proven=True)
    x, y = map(float, moves(made)[0][1].split(","))
    assert 30 <= x <= 170 and 230 <= y <= 470
