"""Operations: primitives with their arguments, as a plan orders them and a backend executes them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from itertools import count
from typing import Any, Literal

from pico.diagnostics import Diagnostic
from pico.model.observation import ObservedComponent, observed_from_json
from pico.model.primitive import Primitive, primitive
from pico.model.record import record

Outcome = Literal["done", "failed", "unknown"]
ReasonKind = Literal[
    "changed",
    "in_the_way",
    "staged",
    "stowed",
    "operator",
    "asked",
    "parked",
    "interlock",
    "held",
    "align",
]

OPEN = frozenset({"optimize", "operator", "teleoperate"})
"""Primitives that take as long as light or a person does."""
SLOW, SLACK = 1.5, 2.0
"""An operation is late that takes so many times as long as foretold, and so much more [s]."""


@record
class Reason:
    """Why an operation is in a plan.

    `changed`: its tunable differs. `stowed`: the state does not want it on the table. `in_the_way`: it is right where
    it is, but must make room for the components in `of`, whose space it overlaps by `overlap` mm. `staged`: it stands
    in a ring of components that block one another (`of`), and is put down in storage on its way. `operator`: only a
    person can do it. `asked`: somebody asked for this one operation (`pico do`).
    `parked`: a robot leaves the beam when the last of its work is done. `interlock`: a laser's shutter is closed while
    somebody works in its beam, and set as wanted afterwards; or what the goals in `of` need while they are sought.
    `held`: a hand that was stopped still holds it, and sets
    it down before anything else.
    """

    kind: ReasonKind
    of: tuple[str, ...] = ()
    overlap: float | None = None
    text: str = ""


@record
class Operation:
    """One node of a plan's graph.

    Arguments of `move` and `stow`: `from` and `to`, each `{"pose": {x, y, yaw}, "slot": name or absent}`, and
    `grasp_yaw` [deg], the direction in which the jaws close in the component's frame; where the robot holds it already,
    `from` says `"held": true` and where it then is, seen from above. Of `set`: `tunable`, `from`, `to`. Of `home`:
    `tunable`. Of `measure`: `measurable`; its `component` may be a camera over the bench. Of `park`: none; its
    `component` is the robot's name. Of `optimize`: `goal`, its name, `what` it is (as `pico.model.goal.Goal`), the
    `algorithm` with its `parameters`, and `from`, where its tunables stand, and the exposures that it may change on the
    way; `again`: the key of the one that it takes up. Of `verify`, which measures a goal where its tunables stand:
    `goal`, `what` and `from` as of `optimize`, and `was`, what was measured when it was met. Of `teleoperate`: `what`,
    the `tunables` that a person steers, by address, and `from`, where they stand; with a `robot`, which holds the
    component, `pose` is steered, and `grasp_yaw` is as of `move`. Of `operator`: `text`, and `to` where a component is
    to be moved. `resources` are what it holds while it runs (a robot, `motor/p1.angle`, the component itself): each
    does one thing at a time. `after`: ids of the operations that must be done first. `start`, `seconds`: predicted [s].
    """

    id: str
    primitive: str
    component: str
    arguments: Mapping[str, Any] = field(default_factory=dict)
    robot: str | None = None
    resources: tuple[str, ...] = ()
    after: tuple[str, ...] = ()
    reason: Reason
    start: float = 0.0
    seconds: float = 0.0
    nominal: float | None = None
    """What paths and speeds alone say [s], if `seconds` says what earlier operations took on the bench."""

    @property
    def kind(self) -> Primitive:
        """What its primitive is."""
        return primitive(self.primitive)

    @property
    def carries(self) -> bool:
        """Whether an arm takes its component elsewhere, to a goal or where a person steers it."""
        return self.kind.carries or (self.primitive == "teleoperate" and self.robot is not None)

    @property
    def makes_safe(self) -> bool:
        """Whether it is done whatever became of what it comes after: an arm parks, and a shutter closes."""
        closes = self.primitive == "set" and self.arguments.get("tunable") == "shutter"
        return self.kind.parks or (closes and self.arguments.get("to") == "closed")

    @property
    def aligns(self) -> bool:
        """Whether it is there to bring light back: a goal is sought, what that needs is set and set back, and what a
        commit recorded is measured."""
        return self.reason.kind == "align" or (self.reason.kind == "interlock" and bool(self.reason.of))

    def is_late(self, took: float) -> bool:
        """Whether it takes notably longer than foretold once it has taken so long [s]; what light or a person takes is
        open."""
        foretold = self.seconds > 0 and not (self.aligns or self.primitive in OPEN)
        return foretold and took > SLOW * self.seconds + SLACK

    @property
    def address(self) -> str:
        """See `address_of`."""
        return address_of(self.component, self.arguments)


_NEW = count(1)


def new_id() -> str:
    """Return an id for an operation of a plan in the making, which no other operation has in this process; the schedule
    of a plan numbers them from `op1` on."""
    return f"new{next(_NEW)}"


def address_of(component: str, arguments: Mapping[str, Any]) -> str:
    """Return what an operation is about: `p2`, or `p1.angle`, `cam.image` where it is one tunable or measurable, or the
    goal of an optimization."""
    if "goal" in arguments:
        return str(arguments["goal"])
    name = arguments.get("tunable") or arguments.get("measurable")
    return f"{component}.{name}" if name else component


def touched_by(component: str, arguments: Mapping[str, Any]) -> tuple[tuple[str, str], ...]:
    """Return the tunables that an operation changes, each with its component; `pose` where it names none."""
    begun = arguments.get("from", {}) if "what" in arguments else {}  # by address; of a part that is steered its pose
    searched = dict.fromkeys((*searched_by(arguments), *(address for address in begun if "." in address)))
    found = tuple((one, tunable) for one, _, tunable in (address.partition(".") for address in searched))
    return found or ((component, str(arguments.get("tunable", "pose"))),)


def searched_by(arguments: Mapping[str, Any]) -> Mapping[str, tuple[float, float] | None]:
    """Return the tunables that an optimization searches, or a person steers, with the bounds (None for none), by
    address: of its goal, and of the goals that may be sought before it; none of another operation."""
    found: dict[str, tuple[float, float] | None] = {}
    for one in (*(arguments.get("first") or ()), arguments):
        for address, bounds in one.get("what", {}).get("tunables", {}).items():
            wide = found.get(address) or bounds
            found[address] = (min(bounds[0], wide[0]), max(bounds[1], wide[1])) if bounds and wide else None
    return found


@record
class OperationResult:
    """What became of one operation: outcome, the diagnostic of a failure, the component before and after.

    `seconds` that it took; `ended`: the backend's clock when it was over [s].
    """

    key: str
    outcome: Outcome
    error: Diagnostic | None = None
    before: ObservedComponent | None = None
    after: ObservedComponent | None = None
    seconds: float = 0.0
    ended: float = 0.0
    data: Mapping[str, Any] = field(default_factory=dict)


def operation_from_json(data: Mapping[str, Any]) -> Operation:
    """Return the operation whose `as_json` gave `data`."""
    listed = {k: tuple(data[k]) for k in ("resources", "after") if k in data}
    why = data["reason"]
    reason = Reason(**{**why, "of": tuple(why.get("of", ()))})
    return Operation(**{**data, **listed, "reason": reason})


def result_from_json(data: Mapping[str, Any]) -> OperationResult:
    """Return the result whose `as_json` gave `data`."""
    found = data.get("error")
    return OperationResult(
        key=data["key"],
        outcome=data["outcome"],
        error=Diagnostic(**{k: v for k, v in found.items() if k != "source"}) if found else None,
        before=observed_from_json(data.get("before")),
        after=observed_from_json(data.get("after")),
        seconds=float(data["seconds"]),
        ended=float(data["ended"]),
        data=data["data"],
    )
