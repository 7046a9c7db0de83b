"""Measuring: arms park, what the measurable needs is set, and set back when it is done."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from pico.model.arming import LaserClass
from pico.model.catalog import Measurable
from pico.model.observation import Observation, astray
from pico.model.operation import Operation, Reason, new_id
from pico.model.primitive import primitive
from pico.model.quantities import Value
from pico.model.record import record
from pico.model.setpoint import set_seconds
from pico.model.setup import Setup
from pico.motion.types import Motion
from pico.planning.checks.emission import unlicensed
from pico.planning.checks.interlocks import CLOSED
from pico.planning.parts.setdown import park_operation


@record
class Need:
    """A tunable that a measurement wants at a `value`; `live`: as it was read back, None where nobody knows."""

    component: str
    tunable: str
    value: Value
    live: Value | None

    @property
    def address(self) -> str:
        """`laser.shutter`."""
        return f"{self.component}.{self.tunable}"

    @property
    def opens(self) -> bool:
        """Whether it lets a beam through."""
        return self.tunable == "shutter" and self.value != CLOSED


def needed(setup: Setup, seen: Observation, component: str, measurable: Measurable) -> Iterator[Need]:
    """Yield what a measurable needs: of its component where that has such a tunable, else of all on the bench."""
    for tunable, value in measurable.needs.items():
        having = [n for n in sorted(setup.lab.inventory) if tunable in setup.type_of(n).tunables]
        for name in [component] if component in having else having:
            part = seen.components.get(name)
            if part is not None and part.presence != "missing":
                live = part.values.get(tunable)
                known = live.value if live is not None and live.status == "known" else None
                yield Need(component=name, tunable=tunable, value=value, live=known)


def granted(setup: Setup, seen: Observation, needs: Iterable[Need]) -> list[Need]:
    """Return what may be set of what measurements need: no light of a laser that nobody lets emit is let out for them,
    which then say that it was not."""
    return [n for n in needs if not unlicensed(setup, seen, [setting(setup, n, n.live, n.value, (), "")])]


def unlit(setup: Setup, seen: Observation, wanted: Sequence[tuple[str, str]]) -> dict[str, LaserClass]:
    """Return the lasers that measurements want to emit and nobody lets, each with its class."""
    needs = [n for c, name in wanted for n in needed(setup, seen, c, setup.measurable_of(c, name))]
    return unlicensed(setup, seen, [setting(setup, n, n.live, n.value, (), "") for n in needs if n.live != n.value])


def kept_shut(setup: Setup, seen: Observation, need: Need) -> bool:
    """Return whether what was set for a measurement is not set back, for that would let light out that nobody lets."""
    if need.live is None:
        return False
    return bool(unlicensed(setup, seen, [setting(setup, need, need.value, need.live, (), "")]))


def measuring(
    setup: Setup, seen: Observation, wanted: Sequence[tuple[str, str]], reason: Reason, motion: Motion | None
) -> list[Operation]:
    """Return the operations that measure each of `wanted`, a component and a measurable, one after the other.

    Arms that stand out park first, and what is needed is set, shutters opened when they have parked; afterwards that is
    set back, in so far as it is known.
    """
    out = [park_operation(setup, seen, robot, (), motion) for robot in astray(setup, seen) if wanted]
    parks = [op.id for op in out]
    waits: list[str] = []
    for component, name in wanted:
        needs = granted(setup, seen, needed(setup, seen, component, setup.measurable_of(component, name)))
        closed = bool(parks) and not waits  # while an arm parks
        wants = [n for n in needs if n.live != n.value or (closed and n.opens)]
        text = f"to measure {component}.{name}"
        out += [setting(setup, n, n.live, n.value, [*waits, *(parks if n.opens else ())], text) for n in wants]
        measured = _measure(setup, component, name, [op.id for op in out], reason)
        text = f"as it was before {component}.{name} was measured"
        back = [(n, n.live) for n in wants if n.live != n.value and not kept_shut(setup, seen, n)]
        undone = [setting(setup, n, n.value, live, [measured.id], text) for n, live in back if live is not None]
        out += [measured, *undone]
        waits = [measured.id, *(op.id for op in undone)]
    return out


def _measure(setup: Setup, component: str, name: str, after: Sequence[str], reason: Reason) -> Operation:
    return Operation(
        id=new_id(), primitive="measure", component=component, arguments={"measurable": name}, after=tuple(after),
        resources=(component, *sorted(setup.lab.robots)), reason=reason, seconds=primitive("measure").seconds,
    )  # fmt: skip


def setting(setup: Setup, need: Need, before: Value | None, after: Value, waits: Sequence[str], text: str) -> Operation:
    """Return the operation that sets what is needed, or sets it back."""
    kind = setup.type_of(need.component).tunables[need.tunable]
    return Operation(
        id=new_id(), primitive="set", component=need.component, reason=Reason(kind="interlock", text=text),
        arguments={"tunable": need.tunable, "from": before, "to": after}, after=tuple(waits),
        resources=(need.address, need.component), seconds=set_seconds(kind, before, after),
    )  # fmt: skip
