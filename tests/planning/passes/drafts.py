"""Small plans in the making, for the tests of passes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from planning_benches import SLOTS, TALL, TYPES, Places, bench, part, see, want

from pico.model.catalog import ComponentType, OpticalElement, Parameter, Restore, Tunable
from pico.model.lab import Slot
from pico.model.observation import ObservedRobot
from pico.model.operation import Operation, Reason
from pico.model.setup import Setup
from pico.planning import PlanGoal
from pico.planning.passes.draft import Draft

REQUEST = Restore(kind="request")
THREE = {**SLOTS, "s3": Slot(x=260, y=60)}
HERE: Places = {"a": (300, 300), "b": (500, 300), "laser": (100, 420)}
LASER = ComponentType(
    name="laser", title="Laser", geometry=TALL, seating="bolted", optics=OpticalElement(element="source"),
    tunables={
        "shutter": Tunable(datatype="choice", choices=("open", "closed"), settle=50, restore=REQUEST),
        "emission": Tunable(datatype="bool", settle=5000, restore=REQUEST),
    },
)  # fmt: skip
STRONG = {"power": Parameter(value=500, unit="mW"), "wavelength": Parameter(value=800, unit="nm")}
"""Of a laser that nobody lets emit, unless somebody arms it."""
LIT: dict[str, dict[str, Any]] = {"laser": {"shutter": "open", "emission": True}, "a": {"angle": 0.0}}


def lit(*, strong: bool = False, **lab: Any) -> Setup:
    """A bench with a laser, and two blocks that the arm moves."""
    setup = bench({"a": "block", "b": part(home="s2"), "laser": part("laser", pose=(100, 420))}, THREE, **lab)
    kind = replace(LASER, parameters=STRONG) if strong else LASER
    return Setup(lab=setup.lab, catalog={**TYPES, "laser": kind})


def begun(
    setup: Setup, places: Places = HERE, wanted: Places | None = None, values: Any = None, then: Any = None, **goal: Any
) -> Draft:  # fmt: skip
    """A plan from parts at `places`, with tunables at `values`, to where they are `wanted`, with tunables at `then`."""
    known = LIT if values is None else values
    seen = see(setup, places, known)
    return Draft(setup, None, seen, PlanGoal(want({**places, **(wanted or {})}, then), **goal))


def holding(draft: Draft, name: str) -> Draft:
    """The same with a part in the hand of arm1."""
    parts = {**draft.seen.components, name: replace(draft.seen.components[name], presence="held")}
    robots = {"arm1": ObservedRobot(joints=(), holding=name)}
    return replace(draft, seen=replace(draft.seen, components=parts, robots=robots))


def op(name: str, *after: str, robot: str | None = None, **more: Any) -> Operation:
    """An operation that is called as its component; of a robot a move."""
    given: dict[str, Any] = {"primitive": "move" if robot else "set", "component": name, "seconds": 1.0} | more
    resources = (robot, name) if robot else (name,)
    return Operation(
        id=name, robot=robot, after=after, **({"resources": resources, "reason": Reason(kind="changed")} | given)
    )


def setting(name: str, tunable: str, to: Any, *after: str) -> Operation:
    """An operation that sets a tunable, called `laser.shutter`."""
    return replace(op(name, *after, arguments={"tunable": tunable, "to": to}), id=f"{name}.{tunable}")


def waits(operations: Iterable[Operation]) -> dict[str, tuple[str, ...]]:
    """What each operation waits for, all by what they do: `arm1` a park, `laser shutter open` a setting."""
    listed = [*operations]
    called = {o.id: _called(o) for o in listed}
    return {called[o.id]: tuple(called[e] for e in o.after) for o in listed}


def _called(one: Operation) -> str:
    said = (one.component, one.arguments.get("tunable"), one.arguments.get("to"))
    return " ".join(str(word) for word in said if isinstance(word, bool | int | float | str))
