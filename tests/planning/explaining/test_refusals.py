"""What a person reads where a state is not possible: both components, by how much, what would help."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from certificates import faults
from checker import check
from planning_benches import bench, part, planned, see, want
from random_labs import Case

from pico.diagnostics import Position, SourceRange
from pico.model.lab import Box2, KeepOut, Margins, Slot, Tether
from pico.model.plan import Blocking, Plan
from pico.model.pose import Pose
from pico.model.robot import Gripper, Mount, Robot
from pico.planning.explaining.refusal import storage_note


def test_an_overlap_names_both_the_depth_and_the_nearest_free_place() -> None:
    setup = bench({"lx": "block", "p2": "block"})
    seen = see(setup, {"lx": (200, 420), "p2": (520, 420)})
    line = SourceRange("state/table.yaml", Position(14, 7), Position(14, 13), "      x: 505")
    asked: list[str] = []

    def source(address: str) -> SourceRange:
        asked.append(address)
        return line

    made = planned(setup, seen, want({"lx": (505, 420), "p2": (520, 420)}), source=source)
    (found,) = made.diagnostics
    assert found.code == "impossible" and made.errored and made.operations == ()
    assert found.summary == "lx cannot stand at (505, 420, 0°): it would overlap p2 by 45 mm"
    assert found.label == "p2 stands at (520, 420); the bases need 62 mm between centers along x"
    assert found.hint == "nearest free place along x is x = 458; or give p2 another place"
    assert found.source is line and set(asked) == {"lx.pose.x"}


def test_the_nearest_free_place_may_lie_across() -> None:
    parts = {"a": (400, 200), "left": (300, 300), "right": (420, 300), "back": (352, 420), "front": (300, 200)}
    setup = bench(dict.fromkeys(parts, "block"))
    (found,) = planned(setup, see(setup, parts), want({**parts, "a": (332, 300)})).diagnostics
    x, y = (float(word.rsplit(" ", 1)[1]) for word in found.hint.split(";")[0].split(", "))
    assert (x, y) != (332.0, 300.0) and found.hint.startswith("nearest free place is x = ")
    assert not planned(setup, see(setup, parts), want({**parts, "a": (int(x), int(y))})).errored


def test_in_the_nearest_free_place_fingers_have_room() -> None:
    setup = bench({"a": "one_way", "wall": "block"})  # the jaws close along x
    seen = see(setup, {"a": (100, 100), "wall": (400, 300)})
    (found,) = planned(setup, seen, want({"a": (440, 300), "wall": (400, 300)})).diagnostics
    x = float(found.hint.split(";")[0].rsplit(" ", 1)[1])
    assert found.hint.startswith("nearest free place along x is x = ") and x > 470
    assert not planned(setup, seen, want({"a": (x, 300), "wall": (400, 300)})).errored


def test_the_slots_offered_take_the_part_and_may_lie_beside_the_table() -> None:
    slots = {
        "taken": Slot(x=400, y=300), "small": Slot(x=480, y=300, fits=20), "beside": Slot(x=900, y=300),
        "mouth": Slot(x=400, y=370, capture=45),
    }  # fmt: skip
    gantry = {"arm1": Robot(model="gantry", mount=Mount(x=0, y=0))}
    setup = bench({"a": part(home="taken"), "wall": part(pose=Pose(400, 300))}, slots, robots=gantry)
    seen = see(setup, {"a": (100, 100), "wall": (400, 300)})
    (found,) = planned(setup, seen, want({"a": "taken", "wall": (400, 300)})).diagnostics
    assert found.hint.split(";")[0] == "choose a free slot: beside"
    assert not planned(setup, seen, want({"a": "beside", "wall": (400, 300)})).errored


def test_two_goals_that_overlap_are_told_once() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (200, 420), "b": (300, 420)})
    made = planned(setup, seen, want({"a": (505, 420), "b": (520, 420)}))
    assert len(made.diagnostics) == 1
    assert "b is to stand at (520, 420)" in made.diagnostics[0].detail


def test_goals_that_keep_less_than_the_margin_are_told_by_how_much() -> None:
    setup = bench({"a": "block", "b": "block"}, margins=Margins(body=4, fingers=0))
    seen = see(setup, {"a": (200, 420), "b": (300, 420)})
    (found,) = planned(setup, seen, want({"a": (437, 420), "b": (500, 420)})).diagnostics
    assert found.summary == (
        "a cannot stand at (437, 420, 0°): it would come within 3 mm of b, and 4 mm must stay free"
    )
    assert found.detail == "b is to stand at (500, 420); the bases need 64 mm between centers along x"


def keeping_out(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Plan:
    """A block goes to (500, 300), its jaws closing along x: its fingers are 15 to 39 mm from there, as low as 90 mm."""
    zone = KeepOut(area=Box2(x=x, y=y), z=z)
    setup = bench({"a": part("one_way")}, keep_out={"lamp": zone})
    return planned(setup, see(setup, {"a": (200, 300)}), want({"a": (500, 300)}))


def test_fingers_keep_out_of_a_zone_that_the_part_itself_leaves_free() -> None:
    beside = ((532.0, 560.0), (290.0, 310.0))
    (found,) = keeping_out(*beside, (100, 300)).diagnostics
    assert (found.severity, found.code) == ("error", "blocked")
    assert not keeping_out((540.0, 560.0), (290.0, 310.0), (100, 300)).errored
    assert not keeping_out(*beside, (0, 80)).errored  # it ends below the fingers


def test_a_zone_above_a_part_is_not_in_its_way() -> None:
    between_the_fingers = ((490.0, 510.0), (315.0, 328.0))
    assert not keeping_out(*between_the_fingers, (150, 300)).errored
    (found,) = keeping_out(*between_the_fingers, (130, 300)).diagnostics
    assert "it would reach into keep-out lamp" in found.summary


def test_nobody_is_told_to_move_what_is_bolted() -> None:
    setup = bench({"a": "block", "laser": part(seating="bolted")})
    seen = see(setup, {"a": (200, 420), "laser": (520, 420)})
    (found,) = planned(setup, seen, want({"a": (505, 420), "laser": (520, 420)})).diagnostics
    assert found.hint == "nearest free place along x is x = 458"


VACUUM = {"arm1": Robot(mount=Mount(x=400, y=500), gripper=Gripper(fingers="none"))}


def test_parts_may_be_turned_in_their_slots_to_have_room_beside_one_another() -> None:
    slots = {"s1": Slot(x=100, y=100), "s2": Slot(x=165, y=100), "edge": Slot(x=700, y=40)}
    setup = bench({"a": "rail", "b": "rail", "c": "rail"}, slots, robots=VACUUM)
    seen = see(setup, {"a": (300, 300), "b": (500, 300), "c": (300, 200)})
    wanted = want({"a": "s1", "b": "s2", "c": (300, 200)})
    made = planned(setup, seen, wanted)
    assert made.diagnostics == () and check(setup, seen, wanted, made) == []
    beside = bench({"a": "rail"}, {"s1": Slot(x=40, y=100)}, robots=VACUUM)  # 120 mm along x, 60 mm along y
    assert not planned(beside, see(beside, {"a": (300, 300)}), want({"a": "s1"})).errored
    narrow = bench({"a": "rail"}, {"s1": Slot(x=20, y=100)}, robots=VACUUM)
    (found,) = planned(narrow, see(narrow, {"a": (300, 300)}), want({"a": "s1"})).diagnostics
    assert found.summary == "a cannot stand at (20, 100, 0°) (s1): it would stick out 40 mm over the table's edge"


def test_goals_that_can_not_be_carry_what_they_break_and_no_more() -> None:
    lamp = {"lamp": KeepOut(area=Box2(x=(600, 700), y=(100, 200)), z=(50, 90))}
    parts = {"a": "block", "b": "block", "c": "block", "cam": part(tether=Tether(anchor=(400, 0), length=400))}
    slots = {"s1": Slot(x=60, y=60), "tight": Slot(x=160, y=60, fits=40)}
    setup = bench(parts, slots, keep_out=lamp)
    start = {"a": (100, 400), "b": (200, 400), "c": (300, 400), "cam": (400, 300)}
    for goals, blocking in (
        ({"a": (505, 420), "b": (520, 420)}, Blocking(kind="bodies", of="a", by="b")),
        ({"a": (320, 410)}, Blocking(kind="stays", of="a")),
        ({"a": (790, 300)}, Blocking(kind="stays", of="a")),
        ({"a": (650, 150)}, Blocking(kind="stays", of="a")),
        ({"a": "tight"}, Blocking(kind="stays", of="a")),
        ({"cam": (700, 450)}, Blocking(kind="reach", of="cam")),
    ):
        seen, wanted = see(setup, start), want({**start, **goals})
        made = planned(setup, seen, wanted)
        assert made.blocking == (blocking,), goals
        if blocking.kind != "reach":  # the checker knows no cables
            assert faults(Case(setup, seen, wanted), made.blocking or ()) == []


def test_every_impossible_goal_is_told_at_once() -> None:
    setup = bench(
        {"a": "block", "b": "block", "c": part("rail"), "d": "block"},
        {"s1": Slot(x=60, y=60), "tight": Slot(x=160, y=60, fits=50)},
        keep_out={"beam": KeepOut(area=Box2(x=(600, 700), y=(100, 200)), z=(50, 90), reason="open beam")},
    )
    seen = see(setup, {"a": (100, 400), "b": (200, 400), "c": (350, 400), "d": (500, 400)})
    made = planned(setup, seen, want({"a": (790, 300), "b": (650, 150), "c": "tight", "d": (500, 400)}))
    assert [d.summary for d in made.diagnostics] == [
        "a cannot stand at (790, 300, 0°): it would stick out 20 mm over the table's edge",
        "b cannot stand at (650, 150, 0°): it would reach into keep-out beam",
        "c does not fit in tight: it reaches 67.1 mm from its center, the slot takes 50 mm",
    ]


def test_a_ring_that_nothing_breaks_is_printed_as_a_chain() -> None:
    names = ("m1", "m2", "m3")
    setup = bench({n: part(stage="never") for n in names})
    spots = [(200, 300), (400, 300), (600, 300)]
    seen = see(setup, dict(zip(names, spots, strict=True)))
    made = planned(setup, seen, want(dict(zip(names, spots[1:] + spots[:1], strict=True))))
    (found,) = made.diagnostics
    assert found.code == "impossible"
    assert found.summary == "m1, m3 and m2 block one another in a ring that no storage slot breaks"
    assert found.detail.splitlines() == [
        "m1 must leave before m3 arrives (bodies overlap by 60 mm)",
        "m3 must leave before m2 arrives (bodies overlap by 60 mm)",
        "m2 must leave before m1 arrives (bodies overlap by 60 mm)",
        "m1: stage: never",
        "m3: stage: never",
        "m2: stage: never",
    ]
    assert found.hint == "allow staging of m1, m3 or m2, with one slot free within reach"


def test_a_ring_says_that_the_slots_are_taken() -> None:
    setup = bench({"m1": "block", "m2": "block", "kept": part(seating="bolted")}, {"s1": Slot(x=60, y=60)})
    seen = see(setup, {"m1": (200, 300), "m2": (400, 300), "kept": "s1"})
    made = planned(setup, seen, want({"m1": (400, 300), "m2": (200, 300), "kept": "s1"}))
    assert "m1: every slot that takes it is occupied" in made.diagnostics[0].detail


def test_fingers_without_room_name_what_they_would_touch() -> None:
    setup = bench({"a": part("one_way"), "wall": part(seating="bolted")}, margins=Margins(body=2, fingers=2))
    seen = see(setup, {"a": (300, 300), "wall": (600, 300)})
    made = planned(setup, seen, want({"a": (536, 300), "wall": (600, 300)}))
    (found,) = made.diagnostics
    assert found.code == "blocked"
    assert found.summary == (
        "a can't be put down at (536, 300, 0°): a finger of the gripper would touch wall by 5 mm, every grasp yaw tried"
    )


def test_where_slots_do_not_suffice_the_refusal_says_how_many_would() -> None:
    # every two block one another: two must be in storage at a time, and one slot is free
    setup = bench(dict.fromkeys("abc", "rail"), {"s1": Slot(x=80, y=40)})
    seen = see(setup, {"a": (300, 300), "b": (300, 363), "c": (300, 426)})
    made = planned(setup, seen, want({"a": (250, 363, 90), "b": (313, 363, 90), "c": (376, 363, 90)}))
    (found,) = made.diagnostics
    assert "free 2 slots within reach that take them" in found.hint


@pytest.mark.parametrize(("slots", "says"), [(1, "with 1 free slot within"), (2, "with 2 free slots within")])
def test_a_note_on_storage_counts_slots(slots: int, says: str) -> None:
    answer: Any = SimpleNamespace(staged=2, least=1, slots=slots)
    (note,) = storage_note(answer)
    assert note.hint == f"{says} reach 1 would do"
