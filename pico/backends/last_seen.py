"""Where the parts of a bench were last: what the cameras saw of them, where an arm put them down since, and which ones
hands took.

Kept as `seen.json` and `hands.json` in the folder of the bench, so that a part that something hides is not lost. It is
no truth: whoever looks asks the cameras first, and the pads say whether a hand holds anything.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from pico.base.state_file import StateFile
from pico.base.state_files import HANDS, SEEN
from pico.diagnostics import PicoError
from pico.model.observation import Observation, Uncertainty
from pico.model.operation import Operation, OperationResult
from pico.model.pose import Pose
from pico.model.record import as_json, record
from pico.model.setup import Setup
from pico.places.bench import BenchPlace

SWAPPED = "marker-swapped"
"""The code of a problem: a part may be another one than its marker says."""


@record
class LastSeen:
    """Where a part was last. `time`: on the clock of the bench [s]; `placed`: an arm put it there, and no camera has
    seen it since."""

    pose: Pose
    uncertainty: Uncertainty = Uncertainty()
    time: float = 0.0
    placed: bool = False

    @property
    def kept(self) -> str:
        """How its pose is known while something hides it."""
        return "placed" if self.placed else "remembered"


@record
class Taken:
    """The component that a hand was told to take, and where it then is, seen from the tool."""

    component: str
    pose: Pose


def recall_hands(place: BenchPlace) -> dict[str, Taken]:
    """Return what hands took last, by robot; nothing where that is not known."""
    return HANDS.read(HANDS.path(place.folder), _taken) or {}


def _taken(data: Mapping[str, Any]) -> dict[str, Taken]:
    return {
        robot: Taken(component=str(taken["component"]), pose=Pose(**taken["pose"]))
        for robot, taken in data["hands"].items()
    }


def remember_hands(place: BenchPlace, hands: Mapping[str, Taken]) -> None:
    """Keep what hands take, before they do; where that can't be written, the journal still knows the component."""
    _write(HANDS, place, {"hands": as_json(hands)})


def repeated(setup: Setup, component: str) -> Uncertainty:
    """Return how exactly an arm puts a part where it is to stand."""
    repeatability = setup.type_of(component).repeatability
    return Uncertainty(position=repeatability.position, yaw=repeatability.yaw)


def placed_at(setup: Setup, operation: Operation, result: OperationResult) -> LastSeen:
    """Return where a part is that an arm put down: where it was seen then, else where it was to be put."""
    after, name, time = result.after, operation.component, result.ended
    if after and after.pose and after.how in ("stereo", "known height", "in hand"):
        return LastSeen(pose=after.pose, uncertainty=after.uncertainty, time=time)
    pose = Pose(**operation.arguments["to"]["pose"])
    return LastSeen(pose=pose, uncertainty=repeated(setup, name), time=time, placed=True)


def recall(place: BenchPlace) -> dict[str, LastSeen]:
    """Return where parts were last; nothing where the file is missing or can't be read, for it is only a memory."""
    return SEEN.read(SEEN.path(place.folder), _parts) or {}


def _parts(data: Mapping[str, Any]) -> dict[str, LastSeen]:
    return {
        name: LastSeen(
            pose=Pose(**part["pose"]),
            uncertainty=Uncertainty(**part["uncertainty"]),
            time=float(part["time"]),
            placed=bool(part["placed"]),
        )
        for name, part in data["parts"].items()
    }


def noted(last: Mapping[str, LastSeen], seen: Observation) -> dict[str, LastSeen]:
    """Return the memory after an observation: what was seen just now replaces what was known of it, but for parts of
    which nobody can tell whether they are the ones that their markers say."""
    doubtful = {problem.address for problem in seen.problems if problem.code == SWAPPED}
    fresh = {
        name: LastSeen(pose=part.pose, uncertainty=part.uncertainty, time=seen.time)
        for name, part in seen.components.items()
        if part.pose is not None
        and part.presence == "seen"
        and part.how not in ("fixed", "remembered", "placed")
        and name not in doubtful
    }
    return {**last, **fresh}


def remember(place: BenchPlace, parts: Mapping[str, LastSeen]) -> None:
    """Keep where parts were last; where that can't be written it is forgotten, which harms nothing."""
    _write(SEEN, place, {"parts": as_json(parts)})


def _write(file: StateFile, place: BenchPlace, document: Mapping[str, Any]) -> None:
    with suppress(PicoError):
        file.write(file.path(place.folder), document, durable=False)
