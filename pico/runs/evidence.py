"""What a commit rests on: of each tunable that it changes, what brought the bench there.

The rule: a state at which the bench did not stand, beyond tolerance, is `planned`, whoever asked for it. Otherwise each
tunable that the commit changes, or that a run in it changed, counts as what brought it there: the last run in which an
operation on it succeeded, if it still stands where that left it; else (a hand, another program) whatever looked. The
commit has the weakest of them. Where it changes none of them, it keeps the evidence of the commit before.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable
from datetime import datetime

from pico.base import clock
from pico.model.comparing.drift import drift_of
from pico.model.diff import deviation, diff_observed, value_deviation
from pico.model.observation import Observation
from pico.model.operation import Operation, touched_by
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.model.trace.run import STRENGTH
from pico.runs.document import weakest
from pico.runs.journal import Success
from pico.runs.memory import Memory

Tunables = Collection[tuple[str, str]]
"""Tunables by component and name; `pose` for where it stands."""
DELIBERATE = ("single", "recipe", "optimizer", "teleoperation", "recording")
"""Causes of runs that lead to no state of a manifest: what they leave on the bench is there to be captured."""
_BACK = ("undo", "redo")
"""Causes of runs that take another one back."""


def stands(setup: Setup, seen: Observation, state: LabState) -> bool:
    """Return whether the bench as observed stands as a state says, within its tolerances."""
    return all(change.tolerated for change in drift_of(setup, seen, state))


def evidence(
    setup: Setup,
    memory: Memory | None,
    seen: Observation,
    state: LabState,
    changed: Tunables,
    *,
    observed: str,
    before: str,
) -> str:
    """Return what a commit of `state` rests on.

    `changed`: the tunables that it changes; `observed`: what an observation counts as; `before`: the evidence of the
    commit before, empty for none. Raises PicoError where the journal can't be read.
    """
    if not stands(setup, seen, state):
        return "planned"
    known = _restored(setup, changed)
    if not known:
        return before if before in STRENGTH and before != "planned" else observed
    brought = _brought(setup, memory, state, known)
    return min((brought.get(one) or observed for one in known), key=lambda e: STRENGTH.get(e, 0))


def _restored(setup: Setup, changed: Tunables) -> list[tuple[str, str]]:
    """Return the tunables among some that the bench has, and that are more than a request."""
    return [(c, t) for c, t in changed if c in setup.lab.inventory and not setup.requests(c, t)]


def by_hand(
    setup: Setup, memory: Memory | None, seen: Observation, state: LabState, changed: Tunables, *, stood: bool
) -> set[tuple[str, str]]:
    """Return which of the tunables that a commit of `state` changes a hand changed on the bench.

    It stands there, and the last operation on it left it elsewhere; or there was none, and it `stood` as the commit
    before says. What else no run changed was written into the manifest. Raises PicoError where the journal can't be
    read.
    """
    known = _restored(setup, changed)
    if not known or not stands(setup, seen, state):
        return set()
    brought = _brought(setup, memory, state, known)
    return {one for one in known if (brought[one] is None if one in brought else stood)}


def never_here(
    setup: Setup, memory: Memory | None, seen: Observation, state: LabState, *, stood: datetime | None = None
) -> set[tuple[str, str]]:
    """Return the tunables in which the bench differs from a state that it never had here, as far as anybody knows.

    It had it where the last operation on the tunable led there, or came before it `stood` so when somebody committed
    it, or a run reached the whole of it; where no operation ever changed it, if it stood so then, or is at home. Then a
    hand has changed it since. What a single operation changed is as somebody wanted it. Raises PicoError where the
    journal can't be read.
    """
    off = {(c.component, c.tunable) for c in diff_observed(setup, seen, state) if c.counts}
    if off and memory and _reached(memory, state):
        return set()
    known = _last_said(setup, memory, state, off, stood) if off and memory else {}
    return {one for one in off if not known.get(one, stood is not None or _at_home(setup, state, one))}


def _reached(memory: Memory, state: LabState) -> bool:
    """Return whether a run here reached the whole of a state, wherever the bench was brought since."""
    for run in reversed(memory.runs()):
        seen = memory.about(run.run)[1]
        plan = json.loads(memory.document(run.run) or "{}") if seen and seen.get("reached") else {}
        if plan and plan["target"]["state"] == state.as_json():
            return True
    return False


def _last_said(
    setup: Setup, memory: Memory, state: LabState, tunables: Tunables, stood: datetime | None
) -> dict[tuple[str, str], bool]:
    """Return of tunables on which operations succeeded whether the last one is no reason to doubt a state."""
    found: dict[tuple[str, str], bool] = {}
    taken_back = set[tuple[str, tuple[str, str]]]()
    for success in memory.successes({component for component, _ in tunables}):
        told = [about.get("cause", {}) for about in memory.about(success.run)[0]]
        undone = {str(cause.get("of")) for cause in told if cause.get("kind") in _BACK}
        for one in _changed(success.operation) & (set(tunables) - found.keys()):
            if (success.run, one) in taken_back:
                continue
            if undone:  # neither of the two counts: the tunable is as before the run that was taken back
                taken_back |= {(run, one) for run in undone}
                continue
            causes = {cause.get("kind") for cause in told}
            before = stood is not None and clock.parse(success.at).replace(microsecond=0) <= stood
            found[one] = before or bool(causes & set(DELIBERATE)) or _there(setup, state, one, success)
    return found


def _at_home(setup: Setup, state: LabState, one: tuple[str, str]) -> bool:
    component, tunable = one
    return tunable == "pose" and place_of(setup, state, component)[0] == setup.lab.inventory[component].home


def _brought(
    setup: Setup, memory: Memory | None, state: LabState, tunables: Tunables
) -> dict[tuple[str, str], str | None]:
    """Return the evidence of the runs that brought tunables where a state has them; None or nothing for other ones."""
    found: dict[tuple[str, str], str | None] = {}
    wanted = set(tunables)
    for success in memory.successes({component for component, _ in wanted}) if memory else ():
        for one in _changed(success.operation) & (wanted - found.keys()):
            found[one] = _of_run(memory, success.run) if memory and _there(setup, state, one, success) else None
        if len(found) == len(wanted):
            break
    return found


def _changed(operation: Operation) -> set[tuple[str, str]]:
    """Return which tunables an operation changes, by component and name."""
    if operation.kind.carries:
        return {(operation.component, "pose")}
    leaves = operation.kind.drives and operation.kind.mutating
    return set(touched_by(operation.component, operation.arguments)) if leaves else set()


def _there(setup: Setup, state: LabState, one: tuple[str, str], success: Success) -> bool:
    """Whether a state has a tunable where its component was observed after an operation."""
    component, tunable = one
    kind, part = setup.type_of(component), success.after
    found = (success.last or {}).get(f"{component}.{tunable}")
    if found is not None and component in state.components and tunable in state.components[component].values:
        return value_deviation(kind.tunables[tunable], found, state.components[component].values[tunable]) != "off"
    if part is None or success.operation.component != component:
        return False
    if tunable == "pose":
        place = place_of(setup, state, component)
        return part.pose is not None and deviation(setup, component, part.pose, *place) != "off"
    value, own = part.values.get(tunable), kind.tunables.get(tunable)
    if component in state.components and tunable in state.components[component].by_light:
        return value is not None and value.value is not None  # how it stands is told by its goal
    goal_value = state.components[component].values.get(tunable) if component in state.components else None
    if value is None or value.value is None or goal_value is None or own is None:
        return False
    return value_deviation(own, value.value, goal_value) != "off"


def _of_run(memory: Memory, run: str) -> str | None:
    """Return the weakest evidence of all times that a run was taken up, as its plan says where nothing else does."""
    found = weakest(memory.about(run)[0], json.loads(memory.document(run) or "{}"))
    return found if found in STRENGTH else None


def changed_by(documents: Iterable[bytes]) -> set[tuple[str, str]]:
    """Return the tunables that runs changed beyond tolerance, from the documents of these."""
    found: set[tuple[str, str]] = set()
    for data in documents:
        document = json.loads(data)
        changes = (c for one in (document, *document.get("folded", ())) for c in one.get("changes", ()))
        found |= {(c["component"], c["tunable"]) for c in changes if not c.get("tolerated")}
    return found
