"""The values that light found on a bench, against the numbers of a state: which of them a plan to that state keeps."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Protocol

from pico.diagnostics import Diagnostic, PicoError, warning
from pico.manifest.changes import differences
from pico.model.address import holds, read_addresses
from pico.model.observation import Observation, live_state
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.planning.aligned_values import GoalMet, equal, left_to_light, off_by_goal

if TYPE_CHECKING:
    from pico.edge.contract import Edge
    from pico.edge.network.remotes import Place
    from pico.history.lab.folder import LabFolder
    from pico.runs.memory import Memory

_EVIDENCE = {"sim": ("kinematic", "physics"), "emulated": ("emulated",)}
"""Of which evidence a commit's goals must be to count on a bench, by its name; on any other only those of hardware."""
_BACK = 20
"""Commits that are looked back for the one that recorded how a goal stood."""


class Bench(Protocol):
    """A bench with its lab's folder and its edge; `pico.bench.opened` is one."""

    @property
    def folder(self) -> LabFolder: ...

    @property
    def edge(self) -> Edge: ...

    @property
    def place(self) -> Place: ...


def with_own_values(
    opened: Bench, seen: Observation, wanted: LabState, *, revision: str | None = None, named: Collection[str] = ()
) -> Observation:
    """Return an observation with the tunables that stay at their live values when the bench is brought to a state.

    revision: where the state comes from; the manifest for None. named: components and tunables that somebody asked for:
    these are driven. Where the journal can't be read none stays, and whoever needs it says why.
    """
    off = {a for addresses in off_by_goal(opened.folder.setup, seen, wanted).values() for a in addresses}
    asked = read_addresses(opened.folder.setup, named) if off and named else {}
    off = {a for a in off if not holds(asked, *a.split("."))}
    if not off:
        return replace(seen, aligned=None)
    try:
        return own_values(opened.folder, opened.edge.memory, seen, wanted, opened.place.title, revision, off)
    except PicoError:
        return replace(seen, aligned=None)


def own_values(
    folder: LabFolder, memory: Memory | None, seen: Observation, wanted: LabState, bench: str,
    revision: str | None = None, among: Collection[str] | None = None,
) -> Observation:  # fmt: skip
    """Return an observation with the tunables that stay, `among` some by address, as `with_own_values` does. Raises
    PicoError where the journal can't be read."""
    setup = folder.setup
    off = off_by_goal(setup, seen, wanted)
    addresses = {a for some in off.values() for a in some}
    if memory is None or not addresses:
        return replace(seen, aligned=None)
    from pico.runs.when_met import not_set_by_plans

    met, own = [*met_here(setup, memory, off)], not_set_by_plans(memory, addresses)
    found = left_to_light(setup, seen, wanted, met, own)
    if found:  # what commits recorded takes longer to read, and only drives what would stay
        recorded = _recorded(folder, bench, revision, off)
        found = left_to_light(setup, seen, wanted, [*met, *recorded], own)
    kept = {address: one for address, one in found.items() if among is None or address in among}
    return replace(seen, aligned=kept or None)


def met_here(setup: Setup, memory: Memory | None, goals: Collection[str]) -> Iterator[GoalMet]:
    """Yield when goals of the Lab, by name, were met on this bench, the last time first. Raises PicoError."""
    from pico.runs.when_met import met_before

    if memory is not None:
        yield from met_before(memory, {name: as_json((setup.lab.goals or {})[name]) for name in goals})


def found_by_light(setup: Setup, memory: Memory | None, seen: Observation) -> dict[str, GoalMet]:
    """Return the tunables whose live values are those with which a goal was met, of the lab or ready-made, by address,
    each with the last search of it that met its goal. Raises PicoError if the journal can't be read."""
    from pico.runs.when_met import met_at_all

    found, sought = dict[str, GoalMet](), set[str]()
    for one, what in met_at_all(memory) if memory else ():
        tuned = {a for a in what.get("tunables") or () if a in one.values and _known(setup, a)}
        live = {a: seen.known_values.get(c, {}).get(t) for a in tuned for c, _, t in [a.partition(".")]}
        known = {a: value for a, value in live.items() if value is not None}
        if known.keys() == tuned and one.with_values(setup, known):
            found |= dict.fromkeys(tuned - sought, one)
        sought |= tuned
    return found


def not_held(setup: Setup, state: LabState, seen: Observation, found: Mapping[str, GoalMet]) -> tuple[Diagnostic, ...]:
    """Return a warning for each goal some of whose values, `found` by address, a committed state does not hold."""
    live, values = live_state(setup, seen, sure=True), {a: one.values[a] for a, one in found.items()}
    changes = differences(setup, state, live, None, values)
    missed: dict[str, list[str]] = {}
    for address in sorted(found):
        component, _, tunable = address.partition(".")
        if tunable in changes.get(component, {}):
            missed.setdefault(found[address].goal, []).append(address)
    return tuple(_not_held(goal, addresses) for goal, addresses in missed.items())


def _not_held(goal: str, addresses: Sequence[str]) -> Diagnostic:
    them = "it" if len(addresses) == 1 else "them"
    text = f"{goal} found {' and '.join(addresses)}, and the commit does not hold {them}"
    hint = f"`pico capture {' '.join(addresses)}` writes {them} into the manifest"
    return warning("aligned", text, hint=hint)


def _known(setup: Setup, address: str) -> bool:
    component, _, tunable = address.partition(".")
    return component in setup.lab.inventory and tunable in setup.type_of(component).tunables


def never_set(setup: Setup, memory: Memory | None, seen: Observation, wanted: LabState) -> set[str]:
    """Return the tunables that stay at their live values (`seen.aligned`) and never had the number of a state on this
    bench, by address: somebody edited it, and nothing drove it there. Raises PicoError."""
    from pico.runs.when_met import ever_stood

    if memory is None:
        return set(seen.aligned or ())
    found = set[str]()
    for address in seen.aligned or ():
        component, _, tunable = address.partition(".")
        fits = partial(equal, setup, address, wanted.components[component].values[tunable])
        if not ever_stood(memory, address, fits):
            found.add(address)
    return found


def _recorded(
    folder: LabFolder, bench: str, revision: str | None, off: Collection[str]
) -> Iterator[GoalMet]:  # fmt: skip
    """Yield how goals were met as the commit of a state recorded it, or one before it that gives their tunables the
    same numbers."""
    from pico.history.runs.recorded_light import recorded_light

    head = folder.head() if folder.repository else None
    commit = folder.history().resolve(revision).id if revision else head.commit if head else None
    counted = _EVIDENCE.get(bench, ("hardware",))
    for _ in range(_BACK):
        if commit is None:
            return
        try:
            state, found = folder.state_at(commit), recorded_light(folder, commit, counted)
        except PicoError:
            return
        poses = {name: place_of(folder.setup, state, name)[1] for name in folder.setup.lab.inventory}
        for goal, last in found.goals.items():
            if goal in off and last:
                yield GoalMet(goal, "", last, poses)
        parents = folder.history().resolve(commit).parents
        commit = parents[0] if parents and not found.goals.keys() & set(off) else None
