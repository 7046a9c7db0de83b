"""Arms that are asked once: the same answers, for the same question without looking again."""

from __future__ import annotations

from typing import Any

from pico.model.catalog import Footprint, Geometry
from pico.model.pose import Pose
from pico.motion.types import StandingObject
from pico.planning.ordering.remembered import remembered

BLOCK = Geometry(footprint=Footprint(box=(60, 60)), height=100, mass=0.3)


class Counting:
    """Arms that answer with how often they were asked."""

    asked = 0

    def _next(self, *_: object) -> int:
        self.asked += 1
        return self.asked

    move = park = _next

    def travel(self, *_: object) -> float:
        return 7.0


def test_the_same_question_is_asked_once_and_any_other_anew() -> None:
    counting: Any = Counting()
    arms: Any = remembered(counting)
    here, there = {"b": StandingObject(Pose(1, 2), BLOCK)}, {"b": StandingObject(Pose(1, 3), BLOCK)}

    def ask(world: Any, joints: Any = None, *others: Any) -> Any:
        return arms.move("arm1", "a", Pose(0, 0), Pose(9, 9), 0.0, world, joints, *others)

    first = [ask(here), ask(there), ask(here, (0.1,)), ask(here, None, {"arm2": (0.0,)}), arms.park("arm1", (), here)]
    assert first == [1, 2, 3, 4, 5]
    assert [ask(dict(here)), ask(there), ask(here, (0.1,)), ask(here, None, {"arm2": (0.0,)})] == first[:4]
    assert arms.park("arm1", (), here) == 5 and arms.park("arm1", (0.1,), here) == 6
    assert arms.travel() == 7.0 and not hasattr(arms, "carry")
