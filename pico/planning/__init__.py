"""From the bench as it was seen to what is wanted: a plan, or why there is none."""

from pico.planning.passes.goal import PlanGoal
from pico.planning.planner import Planner
from pico.planning.single import (
    arm_one,
    do_one,
    home_one,
    measure,
    move_one,
    optimize_one,
    park,
    set_values,
    survey,
    teleoperate_one,
)

__all__ = [
    "PlanGoal", "Planner", "arm_one", "do_one", "home_one", "measure", "move_one", "optimize_one", "park", "set_values",
    "survey", "teleoperate_one",
]  # fmt: skip
