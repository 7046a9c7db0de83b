"""What an operation is checked for before it moves and after, and what is said where it fails. For every backend."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, cast

from pico.backends.attempt import Failed
from pico.diagnostics import Diagnostic, error
from pico.model.catalog import Geometry, Tunable
from pico.model.diff import deviation
from pico.model.observation import Observation, ObservedComponent, ObservedValue, Presence
from pico.model.operation import Operation
from pico.model.pose import Pose, angle_between
from pico.model.quantities import Value
from pico.model.record import as_json
from pico.model.setpoint import refusal
from pico.model.setup import Setup
from pico.motion.types import Blocked, StandingObject

_PRESENCE = {"missing": "is not on the table", "held": "is in the gripper", "toppled": "lies on its side"}
_AGAIN = "plan again: it starts from what stands on the table now"


def places(operation: Operation) -> tuple[Pose, Pose, str | None]:
    """Return from where and to where an operation moves its component, and the slot that is its goal, if any."""
    try:
        start, goal = operation.arguments["from"], operation.arguments["to"]
        return Pose(**start["pose"]), Pose(**goal["pose"]), goal.get("slot")
    except (KeyError, TypeError) as exc:
        text = f"{operation.id} does not say from where to where {operation.component} is to be moved"
        raise Failed(error("bad-plan", text, hint="plan again", address=operation.component)) from exc


def require_ready(setup: Setup, seen: Observation, operation: Operation, start: Pose) -> Pose:
    """Return where the component of a move stands, within tolerance of `start`; raises Failed where it doesn't,
    or where the robot is not free."""
    name, robot = operation.component, operation.robot or "(none)"
    if robot not in setup.lab.robots:
        raise Failed(error("bad-plan", f"the bench has no robot {robot}", address=name))
    require_empty(seen, robot)
    pose = standing_pose(seen, name)
    tolerance = setup.type_of(name).pose.tolerance
    away, turned = pose.distance(start), abs(angle_between(start.yaw, pose.yaw))
    if away > tolerance.position or turned > tolerance.yaw:
        text = f"{name} stands {away:.3g} mm and {turned:.3g}° from where it was to be picked, {start}"
        raise Failed(error("not-there", text, hint=_AGAIN, address=name))
    return pose


def in_hand(operation: Operation) -> bool:
    """Return whether an operation sets down what its robot holds already."""
    start = operation.arguments.get("from")
    return isinstance(start, dict) and bool(start.get("held"))


def require_held(setup: Setup, seen: Observation, operation: Operation) -> Pose:
    """Return where the part is that a robot holds, seen from above; raises Failed where it holds another or none.
    A hand that holds something never opens for anything else."""
    name, robot = operation.component, operation.robot or "(none)"
    if robot not in setup.lab.robots:
        raise Failed(error("bad-plan", f"the bench has no robot {robot}", address=name))
    holding, pose = seen.robots[robot].holding, seen.components[name].pose
    if holding != name or pose is None:
        text = f"{robot} holds {holding or 'nothing'}, not {name}"
        raise Failed(error("not-held", text, hint=_AGAIN, address=name))
    return pose


def require_empty(seen: Observation, robot: str) -> None:
    """Raise Failed where a robot has something in its gripper."""
    holding = seen.robots[robot].holding
    if holding:
        hint = "`pico recover` sets it down; so does the next plan, before anything else"
        raise Failed(error("hand-full", f"{robot} still holds {holding}", hint=hint, address=holding))


def standing_pose(seen: Observation, name: str) -> Pose:
    """Return where a component stands; raises Failed where it doesn't."""
    body = seen.components.get(name, ObservedComponent(presence="missing"))
    if body.presence != "seen" or body.pose is None:
        raise not_standing(name, body.presence)
    return body.pose


def not_standing(name: str, presence: Presence) -> Failed:
    """Return the failure of a motion with a component that does not stand on the table."""
    text = f"{name} {_PRESENCE.get(presence, 'is not on the table')}"
    return Failed(error(presence, text, hint=_AGAIN, address=name))


def standing(setup: Setup, seen: Observation) -> dict[str, StandingObject]:
    """Return everything that stands on the table with its shape; a toppled part as if it stood there."""
    found = {
        name: StandingObject(body.pose, setup.type_of(name).geometry)
        for name, body in seen.components.items()
        if body.pose is not None and body.presence in ("seen", "toppled")
    }
    for name, thing in seen.unknown.items():
        found[name] = StandingObject(thing.pose, Geometry(footprint=thing.footprint, height=thing.height, mass=0.0))
    return found


def blocked(name: str, why: Blocked) -> Failed:
    """Return the failure of a motion that has no path on the table as it is."""
    return Failed(error("blocked", f"{name} cannot be moved: {why.text}", hint=_AGAIN, address=name))


def meets(name: str, robot: str, zone: str) -> Failed:
    """Return the failure of an arm whose way, found anew, comes where another one works."""
    text = f"{name} cannot be moved now: its way on the table as it is leads through {zone}, where {robot} works"
    return Failed(error("blocked", text, hint=_AGAIN, address=name))


def misplaced(setup: Setup, name: str, pose: Pose, goal: Pose, slot: str | None) -> Diagnostic | None:
    """Return what is said of a component that was put down and does not stand where it should, within its tolerance;
    None where it does."""
    if deviation(setup, name, pose, slot, goal) != "off":
        return None
    away, turned = pose.distance(goal), abs(angle_between(goal.yaw, pose.yaw))
    text = f"{name} stands {away:.3g} mm and {turned:.3g}° from its goal {slot or goal}"
    return error("misplaced", text, hint=_AGAIN, address=name)


def require_back(setup: Setup, name: str, part: ObservedComponent, start: Pose) -> None:
    """Raise Failed where a tool does not stand where it stood."""
    if part.presence != "seen" or part.pose is None:
        raise not_standing(name, part.presence)
    if wrong := misplaced(setup, name, part.pose, start, None):
        raise Failed(wrong)


def off(pose: Pose, goal: Pose, before: Sequence[Pose] = ()) -> dict[str, Any]:
    """Return what a placement measured of itself: how far off its goal a part stands [mm, deg], and where it `stood` at
    first, each time before it was set right."""
    found = {"error_mm": pose.distance(goal), "error_deg": abs(angle_between(goal.yaw, pose.yaw))}
    return {**found, "stood": [as_json(one) for one in before]} if before else found


def setpoint(setup: Setup, operation: Operation) -> tuple[str, Tunable]:
    """Return the tunable that an operation sets or homes; raises Failed where the component has none such."""
    name, tunable = operation.component, str(operation.arguments.get("tunable"))
    if name not in setup.lab.inventory or tunable not in setup.type_of(name).tunables:
        raise Failed(error("bad-plan", f"{name} has no tunable {tunable}", address=f"{name}.{tunable}"))
    return tunable, setup.type_of(name).tunables[tunable]


def require_value(name: str, tunable: str, kind: Tunable, value: Any) -> Value:
    """Return `value`; raises Failed where the tunable does not take it."""
    why = refusal(kind, value)
    if why:
        raise Failed(error("range", f"{name}.{tunable} {why}", address=f"{name}.{tunable}"))
    return cast(Value, value)


def require_dark(setup: Setup, seen: Observation, operation: Operation) -> None:
    """Raise Failed where an arm would work in the open beam of a laser whose shutter can be closed, unless the lab
    allows it. The shutter is read back here, whatever the plan closed before."""
    if setup.lab.policy.open_beam:
        return
    for name, body in sorted(seen.components.items()):
        if not has_shutter(setup, name, body.values) or body.presence == "missing":
            continue
        shutter = body.values["shutter"]
        if shutter.status != "known" or shutter.value != "closed":
            what = shutter.value if shutter.status == "known" else "not known to be closed"
            text = f"{operation.robot} must not work in the beam: the shutter of {name} is {what}"
            raise Failed(error("open-beam", text, hint=f"`pico set {name} shutter=closed`; {_AGAIN}", address=name))


def has_shutter(setup: Setup, name: str, values: Mapping[str, ObservedValue]) -> bool:
    """Return whether a part is a laser with a shutter that closes by itself, and has a value."""
    if name not in setup.lab.inventory or setup.type_of(name).optics.element != "source":
        return False
    shutter = setup.type_of(name).tunables.get("shutter")
    closes = shutter is not None and shutter.mover in ("motor", "electronics") and "closed" in shutter.choices
    return closes and "shutter" in values


LOST = frozenset({"dropped", "missed-grasp", "slipped", "unseen"})
"""The failures of a motion after which it must be said where the part is."""


def dropped(robot: str, name: str) -> Diagnostic:
    """Return what is said of a part that fell out of the hand."""
    return error("dropped", f"{robot} dropped {name}", address=name)


def found_again(said: Diagnostic, name: str, part: ObservedComponent, hand: str = "") -> Diagnostic:
    """Return what is said of a part that was lost, with where it is now and what to do about it; `hand`: what a hand
    is on this bench."""
    by_hand = f"put it upright by hand{hand}, then plan again"
    pose = part.pose
    if pose is None:
        return replace(said, summary=f"{said.summary}; no camera shows where it is now", hint=by_hand)
    if part.presence == "toppled":
        where = f"it lies on its side at x = {pose.x:.0f}, y = {pose.y:.0f}"
        return replace(said, summary=f"{said.summary}; {where}", hint=by_hand)
    tidy = Pose(round(pose.x, 1) + 0.0, round(pose.y, 1) + 0.0, round(pose.yaw, 1) + 0.0)
    return replace(said, summary=f"{said.summary}; it stands at {tidy}", hint=_AGAIN)


def jammed(robot: str, name: str) -> Diagnostic:
    """Return what is said of an arm that stopped by itself."""
    text = f"{robot} stopped by itself on the way and holds {name}"
    return error("jammed", text, hint="the next plan sets it down first; `pico recover` does only that", address=name)


def axis_jammed(address: str) -> Diagnostic:
    """Return what is said of an axis that did not get there."""
    return error("jammed", f"{address} stopped on the way: nobody knows where it stands", hint=_AGAIN, address=address)


def frame_lost() -> Diagnostic:
    """Return what is said of a measurement that did not come."""
    return error("frame", "what was measured got lost on the way", hint="measure again")


def no_answer(address: str) -> Diagnostic:
    """Return what is said of an axis that did not answer, and was read to be elsewhere."""
    return error("timeout", f"{address} did not answer, and is not where it should be", hint=_AGAIN, address=address)


def unseen(name: str) -> Diagnostic:
    """Return what is said of a part that was put down and that no look showed."""
    text = f"{name} was put down, and no camera saw it since: nobody knows whether it stands right"
    return error("unseen", text, hint="plan again: it looks first", address=name)


def put_back(name: str, where: str) -> Diagnostic:
    """Return what is said of a part that was brought back, because that was nearer than its goal."""
    return Diagnostic("note", "put-back", f"{name} was put back to {where}, which was nearer", address=name)


def left(name: str) -> Diagnostic:
    """Return what is said of a part that was not gripped any more."""
    return Diagnostic("note", "put-back", f"{name} was left where it stands", address=name)


STOPPED = error("stopped", "it was stopped on the way; the gripper holds what it held", hint=_AGAIN)
