"""What an arm can't reach or pass is found while planning: another grasp, another order, or a refusal that names it."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from planning_benches import bench, moves, part, planned, see, want

from pico.model.lab import Slot
from pico.model.pose import Pose
from pico.motion.types import Blocked, Joints, MovePath, Segment, StandingObject

Question = tuple[str, Pose, Pose, float, Mapping[str, StandingObject]]


class Arm:
    """An arm that takes 4 s a move and 1 s to park, and is in the way of what `blocks` says."""

    def __init__(
        self,
        blocks: Callable[[str, Pose, float, Mapping[str, StandingObject]], Blocked | None] = lambda *_: None,
        reach: Callable[[Pose, float], Blocked | None] = lambda *_: None,
    ) -> None:
        self.blocks, self.can_reach = blocks, reach
        self.asked: list[tuple[str, Joints | None, frozenset[str]]] = []

    def reach(self, robot: str, component: str, pose: Pose, grasp_yaw: float) -> Blocked | None:
        return self.can_reach(pose, grasp_yaw)

    def move(
        self, robot: str, component: str, start: Pose, goal: Pose, grasp_yaw: float,
        standing: Mapping[str, StandingObject], joints: Joints | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        self.asked.append((component, joints, frozenset(standing)))
        end = (goal.x,)
        path = MovePath(robot, component, (Segment("transit", (0.0, 4.0), (joints or (0.0,), end), 50.0),))
        return self.blocks(component, goal, grasp_yaw, standing) or path

    def park(self, robot: str, joints: Joints, standing: Mapping[str, StandingObject]) -> MovePath | Blocked:
        return MovePath(robot, None, (Segment("park", (0.0, 1.0), (joints, (0.0,)), 50.0),))


def test_times_are_those_of_the_paths_and_each_starts_where_the_last_ended() -> None:
    setup, arm = bench({"a": "block", "b": "block"}), Arm()
    seen = see(setup, {"a": (200, 300), "b": (500, 300)})
    made = planned(setup, seen, want({"a": (300, 300), "b": (600, 300)}), arm)
    assert [(o.start, o.seconds) for o in made.operations] == [(0, 4), (4, 4), (8, 1)]
    assert [joints for _, joints, _ in arm.asked] == [None, (300,)]


def test_a_grasp_that_is_out_of_reach_is_not_taken() -> None:
    arm = Arm(reach=lambda pose, yaw: Blocked("reach", "too far") if yaw == 0 and pose.x == 500 else None)
    setup = bench({"a": "block"})
    made = planned(setup, see(setup, {"a": (300, 300)}), want({"a": (500, 300)}), arm)
    assert made.operations[0].arguments["grasp_yaw"] == 90


def test_a_goal_out_of_reach_is_refused_in_the_arms_words() -> None:
    far = Blocked("reach", "arm1 ends 80 mm short of it", by=80.0, help="use another arm")
    arm = Arm(reach=lambda pose, _: far if pose.x == 700 else None)
    setup = bench({"a": "block"})
    made = planned(setup, see(setup, {"a": (300, 300)}), want({"a": (700, 300)}), arm)
    (found,) = made.diagnostics
    assert found.code == "unreachable"
    assert found.summary == "a can't be put down at (700, 300, 0°): arm1 ends 80 mm short of it"
    assert (found.detail, found.hint) == ("", "use another arm")


def test_a_path_that_a_part_blocks_waits_until_it_has_left() -> None:
    def near_b(component: str, goal: Pose, yaw: float, standing: Mapping[str, StandingObject]) -> Blocked | None:
        blocking = [n for n, s in standing.items() if n.startswith("b") and s.pose.x == 500 and component == "a"]
        return Blocked("collision", "it would hit b", "transit", blocking[0], 12.0) if blocking else None

    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (200, 300), "b": (500, 300)})
    made = planned(setup, seen, want({"a": (300, 300), "b": (600, 300)}), Arm(near_b))
    assert moves(made) == [("b", "600,300"), ("a", "300,300")]
    assert made.operations[1].after == (made.operations[0].id,)


def test_an_order_is_fixed_where_only_another_order_would_be_blocked() -> None:
    # bodies and fingers are far apart, and in the order planned (b first, it is nearer) nothing is in the way: but the
    # path of a would hit b where b came from
    def near_b(component: str, goal: Pose, yaw: float, standing: Mapping[str, StandingObject]) -> Blocked | None:
        blocking = [n for n, s in standing.items() if n.startswith("b") and s.pose.y == 400 and component == "a"]
        return Blocked("collision", "it would hit b", "transit", blocking[0], 12.0) if blocking else None

    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (100, 100), "b": (400, 400)})
    made = planned(setup, seen, want({"a": (200, 100), "b": (400, 200)}), Arm(near_b))
    assert moves(made) == [("b", "400,200"), ("a", "200,100")]
    assert made.operations[1].after == (made.operations[0].id,)


def test_a_path_that_what_stays_blocks_is_refused_and_names_it() -> None:
    def wall(component: str, goal: Pose, yaw: float, standing: Mapping[str, StandingObject]) -> Blocked | None:
        return Blocked("collision", "link 4 of arm1 would hit wall by 12.0 mm", "transit", "wall", 12.0)

    setup = bench({"a": "block", "wall": part(seating="bolted")})
    seen = see(setup, {"a": (300, 300), "wall": (600, 100)})
    made = planned(setup, seen, want({"a": (500, 300), "wall": (600, 100)}), Arm(wall))
    (found,) = made.diagnostics
    assert found.code == "blocked" and made.operations == ()
    assert found.summary.startswith("move of a to (500, 300, 0°) has no free path during transit: link 4 of arm1")
    assert found.detail == "in the way: wall by 12 mm"


def test_where_every_path_is_blocked_the_refusal_says_by_what() -> None:
    # each path that is asked for is blocked by another part wherever it stands, so the search for another one ends by
    # its limit
    def other(component: str, goal: Pose, yaw: float, standing: Mapping[str, StandingObject]) -> Blocked | None:
        names = [n for n in standing if not n.startswith(component)]
        return (
            Blocked("collision", f"it would hit {names[0]}", "approach", names[0], 12.0) if component == "a" else None
        )

    setup = bench({"a": "block", "b": "block"}, {f"s{n}": Slot(x=60 + 80 * n, y=60) for n in range(9)})
    seen = see(setup, {"a": (200, 300), "b": (500, 300)})
    made = planned(setup, seen, want({"a": (500, 300), "b": (200, 300)}), Arm(other))
    (found,) = made.diagnostics
    assert found.code == "blocked" and made.operations == ()
    assert "of a to" in found.summary and "no free path during approach: it would hit b" in found.summary


def test_without_moves_no_arm_is_asked() -> None:
    setup, arm = bench({"a": "block"}), Arm()
    planned(setup, see(setup, {"a": (300, 300)}), want({"a": (300, 300)}), arm)
    assert arm.asked == []
