"""What a picture of a bench shows: where everything is, where a plan takes it, and what is in whose way."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from pico.model.event import Event
from pico.model.lab import Setup
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.planning.blocking import moved_by, why_impossible
from pico.planning.contacts import Contact, ends_of
from pico.twin.beams import Place
from pico.twin.film import Caption
from pico.twin.marks import Mark
from pico.twin.placement import Placement

_CARRIES = ("move", "stow")


def places(setup: Setup, seen: Observation, in_space: Mapping[str, Placement]) -> dict[str, Place]:
    """Return where to draw each component: as observed; one in a gripper or on its side where it is in space, as far
    as the backend knows that."""
    found: dict[str, Place] = {}
    for name, part in seen.components.items():
        if name not in setup.lab.inventory:
            continue
        if part.presence == "seen" and part.pose:
            found[name] = part.pose
        elif part.presence in ("held", "toppled") and name in in_space:
            found[name] = in_space[name]
    return found


def goals(setup: Setup, plan: Plan) -> dict[str, Pose]:
    """Return where the components are to stand that a plan moves, or would have to."""
    ends = ends_of(setup, plan)
    return {name: ends[name].pose for name in moved_by(plan) if name in ends}


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
        shown = max(going.values(), key=lambda e: (e.data.get("primitive") in _CARRIES, e.time))
        phase = str(event.data.get("phase", "")) if event.operation == shown.operation else ""
        title = titles.get(shown.operation or "", f"{shown.component} {shown.data.get('primitive')}")
        carried = shown.component or "" if shown.data.get("primitive") in _CARRIES else ""
        found.append(Caption(event.time, f"{title} · {phase}" if phase and phase not in title else title, carried))
    return tuple(found)


def _amount(by: Contact) -> str:
    finger = "finger, " if by.kind == "finger" else ""
    return f"{finger}{by.overlap:.3g} mm" if by.overlap > 0 else f"{finger}{-by.overlap:.3g} mm apart"
