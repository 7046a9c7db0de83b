"""Whether goals are still met, as the journal knows: aligned, stale, lost, or never measured. Nothing is measured."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol

from pico.base import clock
from pico.model.diff import value_distance
from pico.model.goal import Goal
from pico.model.observation import Observation
from pico.model.operation import Operation, Reason
from pico.model.pose import Pose
from pico.model.primitive import primitive
from pico.model.quantities import convert
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.state import LabState
from pico.planning.alignment import ALONG, PUT_BACK, Alignment, Status, left_changed, spoiled_goals, upset_in
from pico.planning.asked import Ready
from pico.planning.by_light import told_of, with_goals
from pico.planning.foreseen import foreseen
from pico.planning.goal_light import goal_light
from pico.planning.optimizing import Turn, seconds
from pico.planning.sought import algorithm_for, stages

if TYPE_CHECKING:
    from pico.edge.contract import Edge
    from pico.runs.journal import JournalRecord
    from pico.runs.memory import Memory


class Remembering(Protocol):
    """A bench whose edge has a memory; `pico.bench.opened` is one, and asks here itself."""

    @property
    def setup(self) -> Setup: ...

    @property
    def edge(self) -> Edge: ...


MOST = 1000
"""Runs that are looked back for the last time that a goal was sought."""


def since_last_sought(memory: Memory, goals: Collection[str]) -> list[JournalRecord]:
    """Return the records of the last runs, oldest first, back to where each goal was sought last, `MOST` runs at
    most."""
    left = set(goals)
    found: list[list[JournalRecord]] = []
    for run in reversed(memory.runs()[-MOST:]):
        own = memory.records(run=run.run)
        found.append([*own])
        left -= {str(r.data.get("arguments", {}).get("goal")) for r in own if r.data.get("primitive") == "optimize"}
        if not left:
            break
    return [record for own in reversed(found) for record in own]


def standing(
    opened: Remembering,
    seen: Observation,
    state: LabState | None = None,
    *,
    wanted: bool = False,
    timed: bool = True,
) -> tuple[Alignment, ...]:
    """Return how the goals of a bench stand; see `stands`."""
    return stands(opened.setup, opened.edge.memory, seen, state, wanted=wanted, timed=timed)


def stands(
    bench: Setup,
    memory: Memory | None,
    seen: Observation,
    state: LabState | None = None,
    *,
    wanted: bool = False,
    timed: bool = True,
) -> tuple[Alignment, ...]:
    """Return how the goals of a Lab stand, and those that set-points of a `state` are which light finds; `wanted`: as
    the light goes once its parts stand where that wants them. One that no light comes to is
    lost. `timed`: with what each takes."""
    by_light = told_of(bench, seen, state, wanted=wanted)
    setup = with_goals(bench, by_light)
    goals, dark = setup.lab.goals or {}, [Alignment(name, "lost", d.summary) for name, d in by_light.wrong.items()]
    if not goals:
        return tuple(dark)
    records = since_last_sought(memory, goals) if memory else ()
    took = {name: _takes(setup, name, goal, records) for name, goal in goals.items()} if timed else {}
    return (*alignments(setup, seen, records, clock.now(), took), *dark)


def experience(opened: Remembering, name: str, goal: Goal, algorithm: str) -> float | None:
    """Return what seeking a goal took last on this bench [s]; None where nobody knows yet."""
    memory = opened.edge.memory
    return _took(name, goal, algorithm, since_last_sought(memory, [name])) if memory else None


def _takes(setup: Setup, name: str, goal: Goal, records: Sequence[JournalRecord]) -> tuple[float, bool]:
    """Return what a goal takes [s], by experience, else what its algorithm usually needs; and whether by the former."""
    algorithm = goal.algorithm or algorithm_for(setup, goal)[0]
    known = _took(name, goal, algorithm, records)
    return (seconds(setup, goal, algorithm), False) if known is None else (known, True)


def _took(name: str, goal: Goal, algorithm: str, records: Sequence[JournalRecord]) -> float | None:
    """Return what a goal took by an algorithm the last time that it was met, and not found met already [s]."""
    sought = {r.key: r.data["arguments"] for r in records if r.kind == "intent" and _seeks(r, name)}
    for r in reversed(records):
        data = (r.data.get("data") or {}) if r.kind == "done" and r.key in sought else {}
        same = data.get("met") and data.get("algorithm") == algorithm and data.get("measurements", 0) > 1
        if same and _wanted(sought[r.key].get("what", {})) == _wanted(as_json(goal)):
            return float(r.data.get("seconds") or 0.0) or None
    return None


def alignments(
    setup: Setup, seen: Observation, records: Sequence[JournalRecord], now: str,
    took: Mapping[str, tuple[float, bool]],
) -> tuple[Alignment, ...]:  # fmt: skip
    """Return how each goal of a Lab stands, in the order along the beam in which they are to be redone. `records`: of
    the journal; `now` by the wall, ISO 8601; `took`: seconds that each is reckoned with, and
    whether by experience."""
    found = [
        _alignment(setup, seen, name, goal, records, now, took.get(name, (0.0, False)))
        for name, goal in (setup.lab.goals or {}).items()
    ]
    return tuple(sorted(found, key=lambda a: (a.order is None, a.order or 0.0, a.goal)))


def redone(
    setup: Setup, seen: Observation, standing: Sequence[Alignment], operations: Sequence[Operation],
    ready: Mapping[str, Ready] = MappingProxyType({}),
) -> tuple[Turn, ...]:  # fmt: skip
    """Return which goals are to be sought when operations are done, in the order along the beam as it then runs: those
    with light that are not aligned, that the operations spoil, or whose light comes through what another one tunes.

    `standing`: as the bench is `seen` now. `ready`: goals that were made ready, by name."""
    then = foreseen(setup, seen, operations)
    wrong = {one.goal: f"{what} changes" for one, what in spoiled_goals(setup, seen, standing, operations)}
    wrong |= {one.goal: one.why or one.status for one in standing if one.status != "aligned"}
    found: list[tuple[float, Alignment, frozenset[str]]] = []
    for one in (one for one in standing if one.goal in (setup.lab.goals or {})):
        light = goal_light(setup, then, (setup.lab.goals or {})[one.goal])
        if light.order is not None:
            found.append((light.order, one, light.parts - light.beyond))
    chosen: list[Turn] = []
    for _, one, parts in sorted(found, key=lambda f: (f[0], f[1].goal)):
        tuned = {a.partition(".")[0]: turn.one.name for turn in chosen for a in turn.one.goal.tunables}
        above = next((name for part, name in sorted(tuned.items()) if part in parts), "")
        why = wrong.get(one.goal) or (f"{above} is sought before it" if above else "")
        if why:
            goal = (setup.lab.goals or {})[one.goal]
            asked, first = stages(setup, then, ready.get(one.goal) or Ready(one.goal, goal))
            took = one.seconds if one.experience else None
            chosen.append(Turn(asked, first, took, Reason(kind="align", text=why)))
    return tuple(chosen)


def _alignment(
    setup: Setup, seen: Observation, name: str, goal: Goal, records: Sequence[JournalRecord], now: str,
    took: tuple[float, bool],
) -> Alignment:  # fmt: skip
    order = goal_light(setup, seen, goal).order

    def standing(status: Status, why: str = "", at: str = "", last: Mapping[str, float] | None = None) -> Alignment:
        return Alignment(name, status, why, at, last, order, *took)

    sought = {r.key: r for r in records if r.kind == "intent" and (_seeks(r, name) or _verifies(r, name))}
    ends = [r for r in records if r.key in sought and _tells(sought[r.key], r)]
    if not ends:
        return standing("never measured")
    end, begun = ends[-1], sought[ends[-1].key]
    data: Mapping[str, Any] = end.data.get("data") or {}
    if not data.get("met"):
        return standing("lost", str(data.get("why") or "it did not come to its end"), end.at, data.get("last"))
    last = data.get("last")
    upset = _upset_since(setup, seen, goal, _begun_since(records, end))
    old = bool(goal.valid_for) and clock.seconds_on_bench(end.at, now, seen.waits) > convert(
        goal.valid_for or "0 s", "s"
    )
    reasons = {
        "it was another goal then": _wanted(begun.data["arguments"].get("what", {})) != _wanted(as_json(goal)),
        (other := _swapped(setup, seen, goal, begun.data["arguments"])): bool(other),
        f"older than {goal.valid_for}": old,
        f"{upset} was changed since": bool(upset),
        (elsewhere := _elsewhere(setup, seen, goal, last or {})): bool(elsewhere),
    }
    why = next((reason for reason, so in reasons.items() if so), "")
    return standing("stale" if why else "aligned", why, end.at, last)


def _swapped(setup: Setup, seen: Observation, goal: Goal, arguments: Mapping[str, Any]) -> str:
    """Return which part in its light has another specimen now, in words; empty for none, and where nobody knows."""
    known = arguments.get("specimens")
    if known is None:
        return ""
    for name in sorted(goal_light(setup, seen, goal).parts):
        was, now = str(known.get(name, "")), setup.lab.inventory[name].serial
        if was != now:
            return f"{name} was swapped (serial {was or 'none'} → {now or 'none'})"
    return ""


def _wanted(goal: Mapping[str, Any]) -> dict[str, Any]:
    """Return what of a goal says when it is met; not how it is sought."""
    same = ("reach", "minimize", "maximize", "tolerance", "during", "offset")
    return {"tunables": sorted(goal.get("tunables") or ()), **{key: goal.get(key) for key in same}}


def _seeks(record: JournalRecord, name: str) -> bool:
    return record.data.get("primitive") == "optimize" and record.data.get("arguments", {}).get("goal") == name


def _verifies(record: JournalRecord, name: str) -> bool:
    return record.data.get("primitive") == "verify" and record.data.get("arguments", {}).get("goal") == name


def _tells(begun: JournalRecord, end: JournalRecord) -> bool:
    """Whether the end of what sought or measured a goal tells how it stands; a measurement only if it was assured."""
    if _verifies(begun, str(begun.data["arguments"]["goal"])):
        return end.kind == "done" and "met" in (end.data.get("data") or {})
    return end.kind in ("done", "failed", "unknown", "resolved")


def _begun_since(records: Sequence[JournalRecord], end: JournalRecord) -> list[JournalRecord]:
    """Return the operations that began after a record and may have left light otherwise, in their order."""
    begun = {r.key for r in records if r.kind == "started" and r.seq > end.seq}
    return [
        r
        for r in records
        if r.kind == "intent" and r.key in begun and primitive(str(r.data.get("primitive"))).mutating
        if r.data.get("primitive") not in PUT_BACK
        if (r.data.get("reason") or {}).get("kind") not in ALONG
    ]


def _upset_since(setup: Setup, seen: Observation, goal: Goal, begun: Sequence[JournalRecord]) -> str:
    """Return which of what operations changed the light of a goal depends on: as it runs now, or as it ran before."""
    touched = {one for r in begun for one in left_changed(r.component, r.data.get("arguments", {}))}
    if not touched:
        return ""
    before = dict(seen.components)
    for r in reversed(begun):
        start = (r.data.get("arguments") or {}).get("from")
        if isinstance(start, Mapping) and "pose" in start and r.component in before:
            before[r.component] = replace(before[r.component], presence="seen", pose=Pose(**start["pose"]))
    return upset_in(setup, seen, goal, touched) or upset_in(setup, replace(seen, components=before), goal, touched)


def _elsewhere(setup: Setup, seen: Observation, goal: Goal, last: Mapping[str, float]) -> str:
    """Return which tunable does not stand where the goal was met, in words; empty for none."""
    for address in goal.tunables:
        component, _, tunable = address.partition(".")
        kind = setup.type_of(component).tunables[tunable]
        live = seen.known_values.get(component, {}).get(tunable)
        if address in last and (live is None or value_distance(kind, live, last[address]) > max(kind.tolerance, 1e-9)):
            return f"{address} stands at {live}" if live is not None else f"nobody knows {address}"
    return ""
