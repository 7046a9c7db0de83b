"""Every refusal has its certificate: constraints that make it impossible, without any one of them it is possible."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import pytest
from certificates import faults
from fuzzing import plan_case
from planning_benches import bench, part, planned, see, want
from random_labs import Case, random_case

from pico.model.lab import Margins, Slot
from pico.model.plan import Blocking
from pico.model.pose import Pose
from pico.motion.types import Blocked, Joints, MovePath, Segment, StandingObject
from pico.planning.explaining.certificate import Certificate
from pico.planning.explaining.proof import Proof

ROW = {"a": (300, 300), "b": (364, 300), "c": (428, 300)}


def refused(seeds: range, most: int) -> Counter[str]:
    """Plan labs, and assert that what is refused has a certificate that holds; count the kinds of constraints."""
    kinds = Counter[str]()
    for seed in seeds:
        case = random_case(seed, least=3, most=most)
        made = plan_case(case)
        if made.errored and all(d.code != "operator" for d in made.diagnostics):
            assert made.blocking is not None, (seed, [d.summary for d in made.diagnostics])
            assert faults(case, made.blocking) == [], seed
            kinds.update({c.kind for c in made.blocking})
    return kinds


def test_certificates_of_random_labs_hold_by_brute_force() -> None:
    kinds = refused(range(2000, 2120), 6)
    assert kinds["fingers"] > 1 and kinds["storage"] > 0, "too easy to mean anything"


@pytest.mark.slow
def test_certificates_of_many_random_labs_hold_by_brute_force() -> None:
    kinds = refused(range(4000, 4300), 5)
    assert kinds["fingers"] > 5 and kinds["storage"] > 5 and kinds["bodies"] > 5, "too easy to mean anything"


def test_a_row_too_narrow_for_fingers_is_not_blamed_on_storage() -> None:
    # 4 mm between the parts: the finger beside each would be where its neighbor stands
    setup = bench(dict.fromkeys("abc", part("one_way")), margins=Margins(body=2, fingers=2))
    seen, wanted = see(setup, ROW), want({"a": (364, 300), "b": (428, 300), "c": (300, 300)})
    made = planned(setup, seen, wanted)
    (found,) = made.diagnostics
    assert "storage would not help" in found.summary and "slot" not in f"{found.hint} {found.detail}"
    assert "fingers" in found.hint
    assert made.blocking and {c.kind for c in made.blocking} == {"fingers"}
    assert faults(Case(setup, seen, wanted), made.blocking) == []


def test_a_swap_without_a_free_slot_lacks_room_for_one_of_both() -> None:
    setup = bench({"a": "block", "b": "block", "kept": part(seating="bolted")}, {"s1": Slot(x=60, y=60)})
    seen = see(setup, {"a": (200, 300), "b": (400, 300), "kept": "s1"})
    wanted = want({"a": (400, 300), "b": (200, 300), "kept": "s1"})
    made = planned(setup, seen, wanted)
    assert made.blocking == (
        Blocking(kind="bodies", of="a", by="b"), Blocking(kind="storage", of="a"), Blocking(kind="storage", of="b"),
    )  # fmt: skip
    assert faults(Case(setup, seen, wanted), made.blocking) == []


def test_a_certificate_that_is_none_is_found_out() -> None:
    setup = bench({"a": "block", "b": "block"}, {"s1": Slot(x=60, y=60)})
    seen, wanted = see(setup, {"a": (200, 300), "b": (400, 300)}), want({"a": (400, 300), "b": (200, 300)})
    case = Case(setup, seen, wanted)
    storage = tuple(Blocking(kind="storage", of=name) for name in "ab")
    assert faults(case, (Blocking(kind="bodies", of="a", by="b"), *storage)) == [
        "these constraints do not make it impossible"
    ]


class Narrow:
    """An arm whose fingers hit the very part that they should hold; counts what it is asked."""

    asked = 0

    def reach(self, robot: str, component: str, pose: Pose, grasp_yaw: float) -> Blocked | None:
        return None

    def move(
        self, robot: str, component: str, start: Pose, goal: Pose, grasp_yaw: float,
        standing: Mapping[str, StandingObject], joints: Joints | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        self.asked += 1
        return Blocked("collision", f"a finger of arm1 would hit {component} by 13.0 mm", "descend", component, 13.0)

    def park(self, robot: str, joints: Joints, standing: Mapping[str, StandingObject]) -> MovePath | Blocked:
        return MovePath(robot, None, (Segment("park", (0.0, 1.0), (joints, (0.0,)), 50.0),))


def test_a_part_that_its_own_fingers_hit_is_refused_after_one_look_at_each_hold() -> None:
    setup, arm = bench({"a": "block"}, {f"s{n}": Slot(x=60 + 80 * n, y=60) for n in range(9)}), Narrow()
    made = planned(setup, see(setup, {"a": (300, 300)}), want({"a": (500, 300)}), arm)
    (found,) = made.diagnostics
    assert "a finger of arm1 would hit a by 13.0 mm" in found.summary and "slot" not in found.hint
    assert arm.asked == 2
    assert made.blocking == (Blocking(kind="path", of="a"),)


class Crowded(Narrow):
    """An arm that everything on the table is in the way of but what stands alone."""

    def move(
        self, robot: str, component: str, start: Pose, goal: Pose, grasp_yaw: float,
        standing: Mapping[str, StandingObject], joints: Joints | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        self.asked += 1
        others = sorted(n for n in standing if n.partition("@")[0] != component)
        if not others:
            return MovePath(robot, component, (Segment("transit", (0.0, 7.0), ((0.0,), (0.0,)), 50.0),))
        name = others[int(goal.x + goal.y + grasp_yaw) % len(others)]
        return Blocked("collision", f"it would hit {name} by 12.0 mm", "transit", name, 12.0)


def test_what_arms_have_no_path_for_is_not_blamed_on_storage() -> None:
    """However many paths are asked for: there is a certificate of paths, or a word that says why there is none."""
    setup = bench({"a": "block", "b": "block"}, {f"s{n}": Slot(x=60 + 80 * n, y=60) for n in range(4)})
    seen, wanted = see(setup, {"a": (200, 300), "b": (500, 300)}), want({"a": (500, 300), "b": (200, 300)})
    made = planned(setup, seen, wanted, Crowded())
    (found,) = made.diagnostics
    assert "path" in found.detail and "need them too" not in found.detail and "slot" not in found.hint
    if made.blocking is None:
        assert "the limit of the search" in found.detail
    else:
        assert "path" in {c.kind for c in made.blocking}


def test_a_refusal_without_certificate_says_what_is_not_proven(monkeypatch: pytest.MonkeyPatch) -> None:
    setup = bench({"a": part(stage="never"), "b": part(stage="never")})
    seen, wanted = see(setup, {"a": (200, 300), "b": (400, 300)}), want({"a": (400, 300), "b": (200, 300)})
    assert planned(setup, seen, wanted).blocking is not None
    monkeypatch.setattr("pico.planning.explaining.certificate.WORK", 1)
    made = planned(setup, seen, wanted)
    told = "there is no order, but which constraints are enough was not found within the limit of the search"
    assert made.blocking is None and made.diagnostics[0].detail.endswith(told)
    known, unknown = Certificate(True, (Blocking(kind="path", of="a"),)), Certificate(False)
    assert Proof(unknown, None, "200 blocked paths").doubt == (
        "this is no proof that there is no order: the search ended at its limit of 200 blocked paths"
    )
    assert "moves aside what is right" in Proof(known, unknown, "configurations").doubt
    assert Proof(known, known, "configurations").doubt == Proof(known, None, "configurations").doubt == ""
