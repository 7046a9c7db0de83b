"""The pieces that make an order of moves, against brute force and tables made for them."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import permutations

import pytest
from planning_benches import TYPES, Places, bench, part, planned, see, want
from random_labs import random_case
from test_paths_in_plans import Arm

from pico.geometry import separation
from pico.model.catalog import ComponentType, Footprint, Geometry, Grasp
from pico.model.lab import Box2, Region, Slot
from pico.model.observation import Observation
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.motion.types import Blocked, Joints, MovePath, StandingObject
from pico.motion.zones import shared_zones
from pico.planning import PlanGoal
from pico.planning.checks.contacts import footprint_at
from pico.planning.ordering.clock import FAR, HANDLING, SPEED, TURN, Clock
from pico.planning.ordering.conflicts import Conflicts
from pico.planning.ordering.fewest_stagings import BOUND
from pico.planning.ordering.realize import _arriving, _order, _peak, _Replay, _roomiest, realized, slots_needed
from pico.planning.ordering.relaxed import _shared, relaxation
from pico.planning.ordering.search import OrderedMove, ranked_storage
from pico.planning.ordering.several_arms import _near, work_of
from pico.planning.ordering.shorten import shortened, valid
from pico.planning.parts.movers import Hold
from pico.planning.parts.spots import MOST, with_spots
from pico.planning.passes.actors import actors, asides
from pico.planning.passes.comparison import compared
from pico.planning.passes.draft import Draft
from pico.staging.feedback import Component
from pico.staging.feedback import solve as fewest_staged

Act = tuple[int, str]


def table(setup: Setup, seen: Observation, wanted: Places, *, with_asides: bool = False) -> Conflicts:
    draft = compared(Draft(setup, None, seen, PlanGoal(want(wanted))))
    movers, obstacles, _ = actors(draft)
    if with_asides:
        movers = (*movers, *asides(draft, movers))
        obstacles = [o for o in obstacles if o.name not in {m.name for m in movers}]
    return Conflicts(setup, movers, obstacles, None, False)


def moves_of(made: Conflicts, *steps: tuple[int, int, int]) -> tuple[OrderedMove, ...]:
    return tuple(OrderedMove(i, start, goal, made.movers[i].holds[0], 0) for i, start, goal in steps)


def swap() -> Conflicts:
    setup = bench({"a": "block", "b": "block"})
    return table(setup, see(setup, {"a": (300, 300), "b": (500, 300)}), {"a": (500, 300), "b": (300, 300)})


# Which are in storage when.


def waiting(rng: random.Random) -> dict[Act, set[Act]]:
    """A few moves, staged and direct, each of which waits for some of others that come earlier in some order."""
    acts: list[Act] = []
    for i in range(rng.randint(1, 4)):
        acts += [(i, "leaves"), (i, "arrives")] if rng.random() < 0.8 else [(i, "direct")]
    rng.shuffle(acts)
    acts.sort(key=lambda act: rng.random() * 2 + (act[1] == "arrives"))
    order = {act: n for n, act in enumerate(acts)}
    before = {act: {e for e in acts[:n] if rng.random() < 0.3} for n, act in enumerate(acts)}
    for i, what in acts:
        if what == "arrives" and order[i, "leaves"] < order[i, "arrives"]:
            before[i, "arrives"].add((i, "leaves"))
    return before


def orders(before: dict[Act, set[Act]]) -> Iterator[tuple[Act, ...]]:
    for order in permutations(sorted(before)):
        if all(before[act] <= set(order[:n]) for n, act in enumerate(order)):
            yield order


def test_no_order_has_fewer_in_storage_at_one_time_than_the_roomiest() -> None:
    rng, better = random.Random(2), 0
    for _ in range(400):
        before = waiting(rng)
        if len(before) > 6 or any(
            (i, "leaves") in before and (i, "leaves") not in before[i, "arrives"] for i, _ in before
        ):
            continue
        roomiest, usual = _roomiest(before), _order(before)
        for order in (roomiest, usual):
            assert sorted(order) == sorted(before)
            assert all(before[act] <= set(order[:n]) for n, act in enumerate(order))
        least = min(map(_peak, orders(before)))
        assert _peak(roomiest) == least <= _peak(usual)
        better += least < _peak(usual)
    assert better, "in some the usual order is not the roomiest"


def test_an_order_stages_what_it_should_and_brings_everybody_home() -> None:
    staged = 0
    for seed in range(900, 930):
        case = random_case(seed, least=4, most=7)
        movers, obstacles, _ = actors(compared(Draft(case.setup, None, case.seen, PlanGoal(case.wanted))))
        made = Conflicts(case.setup, movers, obstacles, None, False)
        problem = relaxation(made)
        for mover, component in zip(movers, problem.components, strict=True):
            i = movers.index(mover)
            ways = [(goal, way.hold) for goal in mover.goals for way in made.ways(i, 0, goal)]
            assert [option.name for option in component.direct] == ways
        answer = fewest_staged(problem, BOUND)
        steps = realized(made, problem, answer) if answer.options is not None else None
        if steps is None:
            continue
        assert valid(made, steps) is not None
        times = Counter(s.mover for s in steps)
        assert times == {i: 2 if i in answer.staged else 1 for i in range(len(movers))}
        assert {s.mover: s.goal in movers[s.mover].finished for s in steps} == dict.fromkeys(range(len(movers)), True)
        staged += len(answer.staged)
        assert slots_needed(problem, answer) <= len(answer.staged)
    assert staged > 5


def test_of_many_none_is_weighed_and_the_order_still_holds() -> None:
    before: dict[Act, set[Act]] = {}
    for i in range(12):
        before[i, "leaves"] = set()
        before[i, "arrives"] = {(i, "leaves"), (i + 1, "leaves")} if i < 11 else {(i, "leaves")}
    order = _roomiest(before)
    assert order == _order(before) and sorted(order) == sorted(before) and _peak(order) == 1
    assert _arriving(before, [(11, "leaves"), (10, "leaves")]) == [
        (11, "leaves"), (10, "leaves"), (10, "arrives"), (11, "arrives")
    ]  # fmt: skip
    assert _peak([]) == 0 and _peak([(0, "direct"), (1, "leaves"), (2, "leaves"), (1, "arrives")]) == 2


# Shorter orders.


def test_two_moves_that_one_would_do_are_one() -> None:
    setup = bench({"a": "block", "b": "block"})
    made = table(setup, see(setup, {"a": (300, 300), "b": (500, 300)}), {"a": (600, 400), "b": (400, 400)})
    storage = made.movers[0].staging[0]
    detour = moves_of(made, (0, 0, storage), (1, 0, 1), (0, storage, 1))
    short = shortened(made, detour)
    assert sorted((s.mover, s.start, s.goal) for s in short) == [(0, 0, 1), (1, 0, 1)]
    assert shortened(made, short) == short and valid(made, short) == short
    there_and_back = moves_of(made, (0, 0, storage), (0, storage, 0), (1, 0, 1), (0, 0, 1))
    assert len(shortened(made, there_and_back)) == 2


def test_what_a_swap_needs_stays() -> None:
    made = swap()
    storage = made.movers[0].staging[0]
    steps = moves_of(made, (0, 0, storage), (1, 0, 1), (0, storage, 1))
    assert [(s.mover, s.start, s.goal) for s in shortened(made, steps)] == [(s.mover, s.start, s.goal) for s in steps]
    assert valid(made, moves_of(made, (0, 0, 1), (1, 0, 1))) is None, "b stands there"
    assert valid(made, moves_of(made, (0, storage, 1))) is None, "a is not there"


def test_what_is_right_need_not_go_away_and_come_back() -> None:
    setup = bench({"a": "block", "b": "block"})
    places: Places = {"a": (200, 300), "b": (600, 300)}
    made = table(setup, see(setup, places), {"a": (300, 400), "b": (600, 300)}, with_asides=True)
    (a, b), storage = made.movers, made.movers[1].staging[0]
    assert (a.name, a.right, b.name, b.right) == ("a", False, "b", True)
    for there in (moves_of(made, (1, 0, storage), (0, 0, 1), (1, storage, 1)), moves_of(made, (1, 0, 1), (0, 0, 1)),
                  moves_of(made, (0, 0, 1), (1, 0, storage), (1, storage, 0))):  # fmt: skip
        assert [(s.mover, s.goal) for s in shortened(made, there)] == [(0, 1)]


# What must come before what.


def test_a_part_that_is_right_may_stay_and_one_that_is_not_may_not() -> None:
    setup = bench({"a": "block", "b": "block"})
    places: Places = {"a": (200, 300), "b": (600, 300)}
    made = table(setup, see(setup, places), {"a": (300, 400), "b": (600, 300)}, with_asides=True)
    mine, other = relaxation(made).components
    assert other.direct[0].name is None and None not in [o.name for o in mine.direct]
    assert (mine.weight, other.weight) == (1.0, 2.0)
    assert [c.weight for c in relaxation(made, (5.0, 7.0)).components] == [5.0, 7.0]
    assert _shared(Component((), (), ())) == []


def test_a_swap_must_wait_for_each_other_and_a_pair_apart_for_nobody() -> None:
    problem = relaxation(swap())
    arcs = {(a.before.component, a.before.what, a.after.component, a.after.what) for a in problem.arcs}
    assert arcs == {(0, "leaves", 1, "arrives"), (1, "leaves", 0, "arrives")}
    setup = bench({"a": "block", "b": "block"})
    apart = table(setup, see(setup, {"a": (100, 300), "b": (600, 300)}), {"a": (200, 400), "b": (700, 400)})
    assert relaxation(apart).arcs == ()


def test_storage_that_nobody_wants_comes_first_then_the_nearer() -> None:
    slots = {"s1": Slot(x=60, y=60), "s2": Slot(x=260, y=60), "s3": Slot(x=460, y=60)}
    setup = bench({"a": "block", "b": "block"}, slots)
    made = table(setup, see(setup, {"a": (300, 300), "b": (600, 300)}), {"a": (300, 400), "b": "s2"})
    ranked = [made.movers[0].places[p].slot for p in ranked_storage(made, 0, (0, 1))]
    assert list(dict.fromkeys(ranked)) == ["s3", "s1", "s2"]
    alone = [made.movers[0].places[p].slot for p in ranked_storage(made, 0, (0,))]
    assert alone[0] == "s2"


# Room on the table.


def test_free_spots_keep_out_of_everybodys_way_and_in_their_region() -> None:
    kinds = {**TYPES, "disc": ComponentType(
        name="disc", title="Disc",
        geometry=Geometry(footprint=Footprint(disc=25), height=100, mass=0.2, grasp=Grasp(height=80, width=20)),
    )}  # fmt: skip
    region = {"front": Region(area=Box2(x=(10, 210), y=(150, 290)), staging=True),
              "back": Region(area=Box2(x=(300, 700), y=(350, 480)))}  # fmt: skip
    for kind, half in (("disc", 25.0), ("block", 30.0)):
        setup = Setup(lab=bench({"a": part(kind), "b": "block"}, regions=region).lab, catalog=kinds)
        made = table(setup, see(setup, {"a": (40, 220), "b": (500, 300)}), {"a": (600, 100), "b": (500, 400)})
        on_table = with_spots(setup, made.movers, tuple(made.obstacles.values()))
        mover = on_table[0]
        spots = [mover.places[p].pose for p in mover.staging if mover.places[p].slot is None]
        assert 0 < len(spots) <= MOST
        assert set(mover.places[: len(made.movers[0].places)]) == set(made.movers[0].places)
        for pose in spots:
            assert 10 + half <= pose.x <= 210 - half and 150 + half <= pose.y <= 290 - half
            assert (pose.x - 10) % 20 == 0 and (pose.y - 150) % 20 == 0
        shapes = [made.shape(0, 0), *(footprint_at(setup, "a", pose) for pose in spots)]
        assert all(separation(p, q) > 2.0 for n, p in enumerate(shapes) for q in shapes[:n])
        nearest = min(
            (Pose(x, y) for x in range(10, 211, 20) for y in range(150, 291, 20)
             if 10 + half <= x <= 210 - half and 150 + half <= y <= 290 - half
             and separation(footprint_at(setup, "a", Pose(x, y)), shapes[0]) > 2.0),
            key=lambda p: (p.distance(Pose(600, 100)), p.x, p.y),
        )  # fmt: skip
        assert (spots[0].x, spots[0].y) == (nearest.x, nearest.y)


# Times.


def test_without_an_arm_to_tell_times_go_by_distance() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (300, 300, 20), "b": (500, 300)})
    made = table(setup, seen, {"a": (300, 420, 20), "b": (500, 100)})
    clock = Clock(made, seen, None)
    one = OrderedMove(0, 0, 1, Hold("arm1", 90.0), 0)
    two = OrderedMove(1, 0, 1, Hold("arm1", 0.0), 0)
    assert not clock.told
    assert clock.loaded(one) == pytest.approx(HANDLING + 120 / SPEED)
    assert clock.loaded(replace(one, hold=Hold(None))) == 0.0
    assert clock.start(one) == pytest.approx(((100**2 + 200**2) ** 0.5) / SPEED)
    assert clock.end(two) == pytest.approx(((100**2 + 400**2) ** 0.5) / SPEED)
    way, turn = ((200**2 + 120**2) ** 0.5) / SPEED, 70 / TURN
    assert clock.between(one, two) == pytest.approx(max(way, turn)) and turn > way
    assert clock.between(replace(one, hold=Hold("arm1", 0.0)), two) == pytest.approx(way)
    assert clock.around((one, two), 0) == pytest.approx(clock.start(one) + clock.loaded(one) + clock.between(one, two))
    assert clock.around((one, two), 1) == pytest.approx(clock.between(one, two) + clock.loaded(two) + clock.end(two))


def test_what_an_arm_tells_is_asked_for_the_places_and_grasps_of_a_move() -> None:
    class Telling:
        asked: list[tuple[object, ...]] = []  # noqa: RUF012

        def travel(self, *given: object) -> float:
            self.asked.append(("travel", *given))
            return float("inf") if given[1] is None else 2.0

        def carry(self, *given: object) -> float:
            self.asked.append(("carry", *given))
            return float("inf") if given[1] == "b" else 5.0

    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (300, 300), "b": (500, 300)})
    made = table(setup, seen, {"a": (300, 420), "b": (500, 100)})
    clock = Clock(made, seen, Telling())  # type: ignore[arg-type]
    one, two = OrderedMove(0, 0, 1, Hold("arm1", 90.0), 0), OrderedMove(1, 0, 1, Hold("arm1", 30.0), 0)
    assert clock.told
    assert (clock.loaded(one), clock.loaded(two)) == (5.0, 0.0)
    assert (clock.start(one), clock.again(one), clock.between(one, two), clock.end(one)) == (FAR, FAR, 2.0, 2.0)
    a, b, c = Pose(300, 300), Pose(300, 420), Pose(500, 300)
    assert Telling.asked == [
        ("carry", "arm1", "a", a, b, 90.0), ("carry", "arm1", "b", c, Pose(500, 100), 30.0),
        ("travel", "arm1", None, a, 0.0, 90.0), ("travel", "arm1", None, a, 0.0, 90.0),
        ("travel", "arm1", b, c, 90.0, 30.0), ("travel", "arm1", b, None, 90.0, 0.0),
    ]  # fmt: skip


# Arms.


class Stuck(Arm):
    """An arm that can't park while `b` stands where it stood."""

    def park(self, robot: str, joints: Joints, standing: Mapping[str, StandingObject]) -> MovePath | Blocked:
        blocked = Blocked("collision", "link 3 would hit b", "park", "b", 4.0)
        return blocked if standing["b"].pose.x == 500 else super().park(robot, joints, standing)


def test_what_would_leave_an_arm_that_can_not_park_is_refused() -> None:
    setup = bench({"a": "block", "b": part(seating="bolted")})
    seen = see(setup, {"a": (200, 300), "b": (500, 300)})
    made = planned(setup, seen, want({"a": (300, 300), "b": (500, 300)}), Stuck())
    assert made.operations == () and [(d.severity, d.code, d.summary, d.detail) for d in made.diagnostics] == [(
        "error", "blocked", "after it brings a to (300, 300, 0°) arm1 can't park: link 3 would hit b",
        "in the way: b by 4 mm",
    )]  # fmt: skip


def test_an_arm_parks_where_what_kept_it_from_that_has_gone() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (200, 300), "b": (500, 300)})
    made = planned(setup, seen, want({"a": (300, 300), "b": (600, 300)}), Stuck())
    assert [o.primitive for o in made.operations] == ["move", "move", "park"] and made.diagnostics == ()


def test_a_move_is_in_a_zone_where_the_arm_comes_there_straight_from_its_base() -> None:
    arms = {"arm1": Robot(mount=Mount(x=200, y=250, yaw=0)), "arm2": Robot(mount=Mount(x=1400, y=250, yaw=180))}
    parts = dict.fromkeys("abcd", "block")
    setup = bench(parts, robots=arms)
    setup = replace(setup, lab=replace(setup.lab, table=replace(setup.lab.table, size=(1600, 500))))
    (zone,) = shared_zones(setup)
    (left, right) = min(x for x, _ in zone.corners), max(x for x, _ in zone.corners)
    assert 400 < left < right < 1200
    seen = see(setup, {"a": (left - 300, 450), "b": (800, 250), "c": (left - 70, 250), "d": (right + 250, 250)})
    made = table(setup, seen, {"a": (left - 300, 100), "b": (800, 400), "c": (left - 70, 400), "d": (right + 250, 100)})
    near = {
        (made.movers[i].name, arm): _near(made, zone, OrderedMove(i, 0, 1, Hold(arm), 0), 0)
        for i in range(4)
        for arm in ("arm1", "arm2", "other")
    }
    assert {key for key, said in near.items() if said} == {
        ("a", "arm2"), ("b", "arm1"), ("b", "arm2"), ("c", "arm1"), ("c", "arm2"), ("d", "arm1"),
    }  # fmt: skip


def test_what_two_arms_have_to_do_is_told_by_arm_with_the_ways_of_each() -> None:
    class Telling:
        def travel(self, robot: str, a: Pose | None, b: Pose | None, *_: float) -> float:
            far = {"arm1": 1.0, "arm2": 100.0}[robot]
            return far * (a.distance(b) if isinstance(a, Pose) and b else 7.0 if a is None else 3.0)

        def carry(self, robot: str, name: str, a: Pose, b: Pose, yaw: float) -> float:
            return 50.0 + a.distance(b)

    arms = {f"arm{n}": Robot(mount=Mount(x=x, y=250)) for n, x in ((1, 0), (2, 5000))}
    setup = bench(dict.fromkeys("abc", "block"), robots=arms)
    seen = see(setup, {"a": (100, 300), "b": (300, 300), "c": (600, 300)})
    made = table(setup, seen, {"a": (100, 400), "b": (300, 100), "c": (600, 100)})
    steps = [OrderedMove(i, 0, 1, Hold(arm), 0) for i, arm in enumerate(("arm1", "arm2", "arm1"))]
    work = work_of(Clock(made, seen, Telling()), steps)  # type: ignore[arg-type]
    assert (work.arms, work.arm, work.zones) == (2, (0, 1, 0), ())
    assert work.loaded == (150.0, 250.0, 250.0)
    assert work.start == work.again == (7.0, 700.0, 7.0) and work.end == (3.0, 300.0, 3.0)
    there, back = Pose(100, 400).distance(Pose(600, 300)), Pose(600, 100).distance(Pose(100, 300))
    assert work.between == ((0.0, 0.0, there), (0.0, 0.0, 0.0), (back, 0.0, 0.0))
    assert work.before == work.enters == work.stays == (frozenset(),) * 3
    assert (work.of(0), work.of(1)) == ((0, 2), (1,))
    assert [work.arrival(j) for j in range(3)] == [7.0, 700.0, 7.0]


def test_slots_for_an_order_are_looked_for_in_so_many_moves_and_no_more() -> None:
    made = swap()
    order: list[Act] = [(0, "leaves"), (1, "direct"), (0, "arrives")]
    enough, too_few = _Replay(made, order, 3), _Replay(made, order, 2)
    assert enough.run() and not too_few.run()
    storage = made.movers[0].staging
    assert [(s.mover, s.start == 0, s.goal in storage) for s in enough.steps] == [
        (0, True, True), (1, True, False), (0, False, False)
    ]  # fmt: skip
    assert valid(made, enough.steps) is not None
    assert not _Replay(made, [(0, "direct"), (1, "direct")], 1000).run(), "they stand in one another's way"
    assert not _Replay(made, [(1, "direct"), (0, "leaves"), (0, "arrives")], 1000).run()
