"""Primitives: what can be asked of a bench, each with what planner, execution and recovery must know of it.

A plug-in brings more by the entry point `pico.primitives`; they are looked for when a name is none of PICO's own.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from functools import cache
from typing import Literal

from pico.diagnostics import Diagnostic, PicoError
from pico.model.record import record
from pico.plug_ins.calling import Interface, instance, loaded
from pico.plug_ins.known import entries

GROUP = "pico.primitives"


@record
class Primitive:
    """One primitive.

    `changes`: what of its component is another than before; `anything` where nobody can say. `by`: who does it; what a
    device does takes no arm. `mutating`: the bench is not as it was, so that what was measured before counts no more.
    `repeatable`: it may be done again where looking shows that it was not done, for its target is absolute.
    `arguments`: what a person gives, with the unit of a number, None for a word; those of `set` are the tunables.
    `seconds`: what a plan reckons with where nothing better is known [s]. `counted`: one and several of it in a tally.
    `requires`, `ensures`: what must hold of the bench before it is done, and afterwards; see
    `pico.planning.checks.conditions`.
    """

    name: str
    changes: Literal["pose", "tunable", "anything", "nothing"] = "nothing"
    by: Literal["arm", "device", "person"] = "device"
    mutating: bool = True
    repeatable: bool = False
    arguments: Mapping[str, str | None] = field(default_factory=dict)
    seconds: float = 1.0
    counted: tuple[str, str] = ("", "")
    requires: tuple[str, ...] = ()
    ensures: tuple[str, ...] = ()

    @property
    def carries(self) -> bool:
        """Whether an arm takes its component from one place to another."""
        return self.by == "arm" and self.changes == "pose"

    @property
    def drives(self) -> bool:
        """Whether a device drives one tunable to a value."""
        return self.by == "device" and self.changes == "tunable"

    @property
    def parks(self) -> bool:
        """Whether an arm only gets out of the way: done whatever became of what it comes after."""
        return self.by == "arm" and self.changes == "nothing"

    @property
    def by_hand(self) -> bool:
        """Whether a person does it."""
        return self.by == "person"


_PLACE = {"x": "mm", "y": "mm", "yaw": "deg", "turn": "deg", "slot": None, "after": None, "distance": "mm"}
OWN: Mapping[str, Primitive] = {
    p.name: p
    for p in (
        Primitive(
            name="move", changes="pose", by="arm", repeatable=True, arguments=_PLACE, counted=("move", "moves")
        ),
        Primitive(name="stow", changes="pose", by="arm", repeatable=True, counted=("move", "moves")),
        Primitive(name="park", by="arm", repeatable=True),
        Primitive(name="set", changes="tunable", repeatable=True, counted=("setting", "settings")),
        Primitive(
            name="home", changes="tunable", repeatable=True, arguments={"tunable": None}, counted=("homing", "homings")
        ),
        Primitive(name="scan", changes="tunable", arguments={"tunable": None}),
        Primitive(name="auto_range", changes="tunable", repeatable=True, arguments={"tunable": None}, seconds=2.0),
        Primitive(
            name="measure", mutating=False, repeatable=True, arguments={"measurable": None}, seconds=0.5,
            counted=("measurement", "measurements"),
        ),
        Primitive(
            name="optimize", changes="tunable", repeatable=True, seconds=20.0,
            counted=("optimization", "optimizations"),
        ),
        Primitive(
            name="teleoperate", changes="tunable", repeatable=True, seconds=30.0,
            counted=("teleoperation", "teleoperations"),
        ),
        Primitive(
            name="verify", changes="tunable", mutating=False, repeatable=True, seconds=1.0,
            counted=("goal measured", "goals measured"),
        ),
        Primitive(name="survey", changes="tunable", repeatable=True, seconds=60.0, counted=("survey", "surveys")),
        Primitive(name="operator", changes="anything", by="person", counted=("step by hand", "steps by hand")),
    )
}  # fmt: skip


def primitive(name: str) -> Primitive:
    """Return the primitive of that name. Of one that nobody here knows, as a plan or journal of somebody else may have
    it, everything is to be feared: it may change anything, and is not done again."""
    return OWN.get(name) or plugged_in().get(name) or Primitive(name=name, changes="anything")


def known() -> tuple[str, ...]:
    """Return the names of all primitives, PICO's own first."""
    return (*OWN, *sorted(plugged_in()))


INTERFACE = Interface(GROUP, {"": instance(Primitive)})


@cache
def plugged_in() -> Mapping[str, Primitive]:
    """Return the primitives that plug-ins bring, by name, without those that are broken; PICO's own can't be
    replaced."""
    return _loaded()[0]


def faults() -> Mapping[str, Diagnostic]:
    """Return what is wrong with the plug-ins' primitives that are broken, by the name of their entry point."""
    return _loaded()[1]


def _loaded() -> tuple[Mapping[str, Primitive], Mapping[str, Diagnostic]]:
    found: dict[str, Primitive] = {}
    wrong: dict[str, Diagnostic] = {}
    for name, entry in entries(GROUP).items():
        try:
            one = loaded(INTERFACE, entry)
        except PicoError as exc:
            wrong[name] = exc.diagnostics[0]
        else:
            if one.name not in OWN:
                found[one.name] = one
    return found, wrong
