"""A plan for some of the components: which are asked for, which these pull in, and what stays as it is."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error, warning
from pico.model.diff import Change
from pico.model.lab import Setup
from pico.model.operation import Operation
from pico.planning.phrases import listed


@dataclass(frozen=True, slots=True)
class Selection:
    """The components that a plan is for: the `targets` (all where there is none), without those `exclude`d."""

    targets: frozenset[str] = frozenset()
    exclude: frozenset[str] = frozenset()

    @property
    def everything(self) -> bool:
        return not self.targets and not self.exclude

    def chosen(self, name: str) -> bool:
        """Whether a component is asked for."""
        return (not self.targets or name in self.targets) and name not in self.exclude


EVERYTHING = Selection()


def selection(setup: Setup, targets: Collection[str], exclude: Collection[str]) -> Selection:
    """Return a selection; raises PicoError for a component that the lab does not have, or that is in both."""
    known = setup.lab.inventory
    found = [
        error("unknown-component", f"the lab has no component `{name}`", hint=did_you_mean(name, known))
        for name in sorted({*targets, *exclude}) if name not in known
    ] + [
        error("usage", f"{name} is both asked for and excluded", hint="name it once")
        for name in sorted({*targets} & {*exclude})
    ]  # fmt: skip
    if found:
        raise PicoError(found)
    return Selection(frozenset(targets), frozenset(exclude))


def done_by(operations: Sequence[Operation]) -> set[tuple[str, str]]:
    """Return the components and tunables that operations change; what an interlock sets is set back."""
    own = [o for o in operations if o.primitive != "park" and o.reason.kind != "interlock"]
    return {(o.component, str(o.arguments.get("tunable", "pose"))) for o in own}


def told(chosen: Selection, changes: Sequence[Change], operations: Sequence[Operation]) -> Iterator[Diagnostic]:
    """Yield what a selection pulls in besides what was asked for, and what it leaves as it is."""
    own = [o for o in operations if o.reason.kind not in ("parked", "interlock")]
    for name in sorted({o.component for o in own if not chosen.chosen(o.component)}):
        waiting = sorted({o.component for o in operations if name in o.reason.of} - {name})
        waiting = waiting or sorted({n for o in operations if o.component == name for n in o.reason.of})
        whom = listed(waiting) or "what was asked for"
        yield Diagnostic(
            severity="note",
            code="pulled-in",
            summary=f"{name} is moved as well: it is in the way of {whom}",
            address=name,
        )
    done = done_by(operations)
    left = sorted({c.component for c in changes if not c.tolerated and (c.component, c.tunable) not in done})
    left = [name for name in left if not chosen.chosen(name)]
    if left:
        names = ", ".join(left[:6]) + (f" and {len(left) - 6} more" if len(left) > 6 else "")
        yield warning(
            "left", f"{names} {'differs' if len(left) == 1 else 'differ'} from the state wanted, and "
            f"{'stays' if len(left) == 1 else 'stay'} so", hint="plan without --target and --exclude for all of them",
        )  # fmt: skip
