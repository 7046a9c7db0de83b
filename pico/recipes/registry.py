"""Steps by name: a file each of `pico.recipes.steps`; a plug-in brings more by the entry point `pico.recipe_steps`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, Protocol, cast

from pico import registered
from pico.manifest.text.tree import Node
from pico.plug_ins.calling import Interface, function, instance
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.recipe import Name
from pico.recipes.scope import Scope

FOLDER = "pico.recipes.steps"
GROUP = "pico.recipe_steps"
CONTROL: Mapping[str, str] = {
    "scan": "tunables are set to each value, measurables `read` there: scan: {p1.angle: {from: 1, to: 5, count: 9}}",
    "foreach": "steps for each value of a list, or each combination: foreach: {tilt: [0, 15, 30]}",
    "if": "steps where something holds, `else` others: if: cam.power > 200",
    "while": "steps while something holds, at most `most` times: while: cam.power < 200",
    "let": "names get values: let: {half: (a.y - b.y) / 2}",
    "assert": "what must hold, with a `message`: assert: spot.x < 5",
    "call": "another recipe, told `with` what, known `as` what: call: null_scan",
}
"""Steps that are the language itself: what they do, and an example after `: `."""


@dataclass(frozen=True)
class Kind:
    """What a file of FOLDER declares: `what` the step does, an `example` of it, and the keys that may stand beside it,
    each with what it says. `asks`: it waits for a person, who answers in `words`, or has the `keys` of a terminal;
    empty: for nobody. `within`: it is done in the open run that the steps before it
    began; any other ends that first, for it needs a run that is over, or nobody knows how long it takes."""

    what: str
    example: str
    keys: Mapping[str, str] = ()  # type: ignore[assignment]
    asks: Literal["", "words", "keys"] = ""
    within: bool = False


@dataclass(frozen=True)
class Given:
    """What was read of a step: terms and plain values by name, and the names that its result has, `""` for itself."""

    values: Mapping[str, Any]
    names: Mapping[str, Name] = ()  # type: ignore[assignment]
    measured: tuple[str, ...] = ()


class StepFile(Protocol):
    """A file of FOLDER."""

    KIND: Kind

    def read(self, reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
        """Read a step: `body` is what stands under its name, `beside` the values of its other keys."""
        ...

    def run(self, doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Do it, with the values of its terms; return its result by name, as JSON data. Raises PicoError where it
        fails."""
        ...


INTERFACE = Interface(
    GROUP, {"KIND": instance(Kind), "read": function, "run": function},
    {"read": instance(Given), "run": instance(Mapping)},
)  # fmt: skip


def own() -> tuple[str, ...]:
    """Return the names of the steps that PICO brings but those of the language itself; imports none."""
    return registered.own(FOLDER, GROUP)


def known() -> tuple[str, ...]:
    """Return the names of all steps but those of the language itself; imports none."""
    return tuple(registered.modules(FOLDER, GROUP))


def step_file(name: str) -> StepFile:
    """Return the file of a step; raises KeyError for a name that there is not, and PicoError
    for a plug-in that is broken."""
    return cast(StepFile, registered.module(INTERFACE, name))
