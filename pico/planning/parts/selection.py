"""A plan for some of the components: which are asked for, which these pull in, and what stays as it is."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.model.address import Named, addresses, holds, read_addresses, renaming_of
from pico.model.diff import Change
from pico.model.operation import Operation
from pico.model.setup import Setup
from pico.planning.parts.phrases import listed


@dataclass(frozen=True, slots=True)
class Selection:
    """What a plan is for: the `targets` (everything where there is none), without what is `exclude`d. `kept`: parts
    with samples, by name, that stay where they are, for nobody named them."""

    targets: Named = field(default_factory=dict)
    exclude: Named = field(default_factory=dict)
    kept: Mapping[str, str] = field(default_factory=dict)

    @property
    def everything(self) -> bool:
        return not self.targets and not self.exclude

    def chosen(self, name: str, tunable: str = "pose") -> bool:
        """Whether a tunable of a component is asked for."""
        return (not self.targets or holds(self.targets, name, tunable)) and not self.excluded(name, tunable)

    def excluded(self, name: str, tunable: str = "pose") -> bool:
        """Whether a tunable of a component is to be left as it is, whatever is in its way."""
        return holds(self.exclude, name, tunable) or (tunable == "pose" and name in self.kept)


EVERYTHING = Selection()


def selection(
    setup: Setup, targets: Collection[str], exclude: Collection[str], *, samples: bool = False
) -> Selection:  # fmt: skip
    """Return a selection; `p2` is a component, `p1.angle` one tunable of it. Parts with samples must be named to move,
    unless `samples` may.

    Raises PicoError for what the lab does not have, and for what is asked for and excluded.
    """
    known = {word for word in exclude if word.partition(".")[0] in {*setup.lab.inventory, *renaming_of(setup.lab)}}
    named, without = read_addresses(setup, {*targets}), read_addresses(setup, known)
    both = [name for name in addresses(named) if _covered(without, name)]
    if both:
        raise PicoError(
            [error("usage", f"{name} is both asked for and excluded", hint="name it once") for name in both]
        )
    held = {n: p.sample for n, p in setup.lab.inventory.items() if p.sample and not holds(named, n, "pose")}
    return Selection(named, without, {} if samples else held)


def _covered(without: Named, address: str) -> bool:
    component, _, tunable = address.partition(".")
    return without.get(component, frozenset()) is None or holds(without, component, tunable)


def done_by(operations: Sequence[Operation]) -> set[tuple[str, str]]:
    """Return the components and tunables that operations change; what an interlock sets is set back."""
    own = [o for o in operations if not o.kind.parks and o.reason.kind != "interlock"]
    return {(o.component, _tunable(o)) for o in own}


def _tunable(operation: Operation) -> str:
    return str(operation.arguments.get("tunable", "pose"))


def told(chosen: Selection, changes: Sequence[Change], operations: Sequence[Operation]) -> Iterator[Diagnostic]:
    """Yield what a selection pulls in besides what was asked for, and what it leaves as it is."""
    own = [o for o in operations if o.reason.kind not in ("parked", "interlock")]
    for name in sorted({o.component for o in own if not chosen.chosen(o.component, _tunable(o))}):
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
    rest = [c for c in changes if c.counts and (c.component, c.tunable) not in done]
    rest = [c for c in rest if c.tunable != "pose" or c.component not in chosen.kept]  # told by itself
    left = sorted({_name(chosen, c) for c in rest if not chosen.chosen(c.component, c.tunable)})
    if left:
        names = ", ".join(left[:6]) + (f" and {len(left) - 6} more" if len(left) > 6 else "")
        yield warning(
            "left", f"{names} {'differs' if len(left) == 1 else 'differ'} from the state wanted, and "
            f"{'stays' if len(left) == 1 else 'stay'} so", hint="a plan that names no component is for all of them",
        )  # fmt: skip


def samples_kept(chosen: Selection, changes: Sequence[Change]) -> Iterator[Diagnostic]:
    """Yield a warning for each part with a sample that stays where it is, though a state wants it elsewhere."""
    for change in changes:
        name = change.component
        if (
            change.tunable == "pose"
            and change.counts
            and name in chosen.kept
            and not holds(chosen.exclude, name, "pose")
        ):
            text = f"{name} stays where it is: it holds the sample {chosen.kept[name]}, which nobody asked to move"
            yield warning("sample", text, hint=f"name it to move it: `-- {name}`, `pico move {name} ...`", address=name)


def _name(chosen: Selection, change: Change) -> str:
    """Return `p2`, or `p2.pose` where something else of p2 was asked for."""
    apart = change.component in chosen.targets or chosen.exclude.get(change.component)
    return f"{change.component}.{change.tunable}" if apart else change.component
