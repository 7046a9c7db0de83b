"""From the bench as it was seen to the state wanted: a plan, or why there is none."""

from pico.planning.compile import plan
from pico.planning.single import (
    again,
    arm_one,
    do_one,
    home_one,
    measure,
    move_one,
    optimize_one,
    park,
    set_one,
    survey,
    teleoperate_one,
)

__all__ = [
    "again", "arm_one", "do_one", "home_one", "measure", "move_one", "optimize_one", "park", "plan", "set_one",
    "survey", "teleoperate_one",
]  # fmt: skip
