"""What is in a gripper, by three witnesses: the bench or a camera names it, the journal knows the last pick, and the
distance between the pads says how wide it is."""

from __future__ import annotations

from dataclasses import replace

from pico.model.observation import Observation, ObservedRobot
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.runs.journal import Journal


def with_picks(setup: Setup, journal: Journal, seen: Observation) -> Observation:
    """Return the observation with, for each hand that holds something, where that stood before it was picked.

    Raises PicoError where the journal can't be read.
    """
    robots = {name: _with_pick(setup, journal, name, robot) for name, robot in seen.robots.items()}
    return replace(seen, robots=robots)


def _with_pick(setup: Setup, journal: Journal, name: str, robot: ObservedRobot) -> ObservedRobot:
    pick = journal.last_pick(name) if robot.holding or robot.opening is not None else None
    if pick is None:
        return robot
    part = robot.holding or (pick.component if _fits(setup, pick.component, robot.opening) else None)
    if part != pick.component:
        return robot
    return replace(robot, holding=part, picked=Pose(**pick.arguments["from"]["pose"]))


def _fits(setup: Setup, component: str, opening: float | None) -> bool:
    grasp = setup.type_of(component).geometry.grasp if component in setup.lab.inventory else None
    return grasp is not None and opening is not None and grasp.fits(opening)
