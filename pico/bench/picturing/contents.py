"""What a picture of a bench shows: where everything is, where a plan takes it, and what is in whose way."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pico.drawing.beams import Place
from pico.drawing.conflict_marks import Mark
from pico.drawing.film.film import Caption
from pico.drawing.steps import DrawnStep
from pico.model.catalog import ComponentType, Geometry
from pico.model.diff import Change, show_value
from pico.model.lab import Part
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.primitive import primitive
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.model.trace.event import Event
from pico.planning.checks.contacts import Contact, ends_of
from pico.planning.explaining.blocking import moved_by, why_impossible
from pico.twin.placement import Placement


def places(setup: Setup, seen: Observation, in_space: Mapping[str, Placement]) -> dict[str, Place]:
    """Return where to draw each component: as observed; one in a gripper or on its side where it is in space, as far
    as the backend knows that."""
    found: dict[str, Place] = {name: thing.pose for name, thing in seen.unknown.items() if name in setup.lab.inventory}
    for name, part in seen.components.items():
        if name not in setup.lab.inventory:
            continue
        if part.presence == "seen" and part.pose:
            found[name] = part.pose
        elif part.presence in ("held", "toppled") and name in in_space:
            found[name] = in_space[name]
    return found


def with_strangers(setup: Setup, seen: Observation) -> Setup:
    """Return the bench as it is drawn: with what stands there and is in no inventory, as blocks of its outline."""
    types, parts = dict(setup.catalog), dict(setup.lab.inventory)
    for name, thing in seen.unknown.items():
        shape = Geometry(footprint=thing.footprint, height=thing.height, mass=0.0)
        types[name] = ComponentType(name=name, title="not in the inventory", geometry=shape)
        parts[name] = Part(type=name, pose=thing.pose)
    return Setup(lab=replace(setup.lab, inventory=parts), catalog=types)


def standing(setup: Setup, state: LabState) -> dict[str, Place]:
    """Return where to draw each component of the inventory as a state wants it."""
    return {name: place_of(setup, state, name)[1] for name in setup.lab.inventory}


def wanted(state: LabState) -> dict[str, Mapping[str, Any]]:
    """Return the tunables that a state wants, by component."""
    return {name: part.values for name, part in state.components.items()}


def goals(setup: Setup, plan: Plan) -> dict[str, Pose]:
    """Return where the components are to stand that a plan moves, or would have to."""
    ends = ends_of(setup, plan)
    return {name: ends[name].pose for name in moved_by(plan) if name in ends}


def steps(plan: Plan) -> tuple[DrawnStep, ...]:
    """Return the operations of a plan, numbered in its order."""
    return tuple(_step(number, op, plan) for number, op in enumerate(plan.operations, 1))


def _step(number: int, op: Operation, plan: Plan) -> DrawnStep:
    before, after, tunable = (op.arguments.get(word) for word in ("from", "to", "tunable"))
    hand = "by hand, " if op.kind.by_hand else ""
    if (op.kind.carries or hand) and isinstance(before, Mapping) and isinstance(after, Mapping):
        words = f"{hand}{_place(before)} → {_place(after)}"
        return DrawnStep(number, op.component, words, op.component, Pose(**before["pose"]), Pose(**after["pose"]))
    if tunable is None:
        return DrawnStep(number, op.component, op.primitive)
    change = next((c for c in plan.changes if (c.component, c.tunable) == (op.component, tunable)), None)
    said = change.text if change and op.reason.kind != "interlock" else f"{show_value(before)} → {show_value(after)}"
    return DrawnStep(
        number, f"{op.component}.{tunable}", f"{hand}{said}" if op.primitive == "set" or hand else op.primitive
    )


def differences(setup: Setup, a: LabState, b: LabState, changes: Sequence[Change]) -> tuple[DrawnStep, ...]:
    """Return what differs from state `a` to `b`, numbered in the order of `changes`."""
    found = []
    for number, change in enumerate(changes, 1):
        name = change.component
        if change.tunable == "pose" and name in setup.lab.inventory:
            start, goal = place_of(setup, a, name)[1], place_of(setup, b, name)[1]
            found.append(DrawnStep(number, name, change.text, name, start, goal))
        else:
            title = name if change.tunable == "pose" else f"{name}.{change.tunable}"
            found.append(DrawnStep(number, title, change.text))
    return tuple(found)


def _place(where: Mapping[str, Any]) -> str:
    return str(where.get("slot") or Pose(**where["pose"]))


def marks(setup: Setup, plan: Plan) -> tuple[Mark, ...]:
    """Return what makes a plan impossible: goals that overlap, or who blocks whom in a ring."""
    clashes, blocks = why_impossible(setup, plan)
    return (
        *(Mark(c.a, c.b, _amount(c.by), goals=True) for c in clashes),
        *(Mark(b.blocker, b.blocked, _amount(b.by)) for b in blocks),
    )


def captions(events: Iterable[Event], titles: Mapping[str, str]) -> tuple[Caption, ...]:
    """Return what a film of a run says when. `titles`: of operations, by id; of several at once that of an arm's move
    is shown, and its component named where it is."""
    found, going = [], {}
    for event in events:
        if event.kind == "operation_started":
            going[event.operation] = event
        elif event.kind in ("operation_done", "operation_failed", "operation_unknown"):
            going.pop(event.operation, None)
        elif event.kind != "operation_progress" or event.operation not in going:
            continue
        if not going:
            found.append(Caption(event.time, ""))
            continue
        shown = max(going.values(), key=lambda e: (_carries(e), e.time))
        phase = str(event.data.get("phase", "")) if event.operation == shown.operation else ""
        title = titles.get(shown.operation or "", f"{shown.component} {shown.data.get('primitive')}")
        carried = shown.component or "" if _carries(shown) else ""
        found.append(Caption(event.time, f"{title} · {phase}" if phase and phase not in title else title, carried))
    return tuple(found)


def _amount(by: Contact) -> str:
    finger = "finger, " if by.kind == "finger" else ""
    return f"{finger}{by.overlap:.3g} mm" if by.overlap > 0 else f"{finger}{-by.overlap:.3g} mm apart"


def _carries(started: Event) -> bool:
    return primitive(str(started.data.get("primitive"))).carries
