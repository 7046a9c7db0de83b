"""What moves on a bench in a run, or would move in a plan, for who draws it: `pico.frames/v1`.

It begins with the scene, and goes on with what the live socket tells, each with its time [s]: between two that are
`moved` of the same arm or body these go straight.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pico.bench.picturing.deeds import Deed, before, deeds_of_plan, deeds_of_run
from pico.bench.picturing.walking import Key, Walk
from pico.diagnostics import Diagnostic, warning
from pico.edge.live import telling
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.motion.deferred import DeferredMotion
from pico.runs.document import RecordedRun
from pico.twin.moment import moment_of

if TYPE_CHECKING:
    from pico.motion.types import Motion

SCHEMA = "pico.frames/v1"
Document = dict[str, Any]
Framed = tuple[Document, tuple[Diagnostic, ...]]
"""The document, and what of it is in doubt."""


def frames_of_plan(setup: Setup, plan: Plan, seen: Observation, motion: Motion | None = None) -> Framed:
    """Return what would move in a plan on a bench that is `seen` now, when the plan reckons with it."""
    about = {"plan": plan.digest, "goal": plan.target.name, "origin": "planned", "evidence": "planned"}
    return _document(setup, about, seen, deeds_of_plan(plan), motion)


def frames_of_run(setup: Setup, run: RecordedRun, motion: Motion | None = None) -> Framed:
    """Return what moved in a run, when it did. Runs keep no joints: the ways of the arms are those that the kinematic
    model finds between the places that were recorded, as the bench is now."""
    deeds, d = deeds_of_run(run), run.document
    about = {"run": d.id, "number": d.number, "goal": d.goal, "origin": "reconstructed", "evidence": d.evidence}
    return _document(setup, about, before(setup, run, deeds), deeds, motion, _doubts(setup, run))


def _doubts(setup: Setup, run: RecordedRun) -> tuple[Diagnostic, ...]:
    now = setup.digest()
    if run.document.lab.digest == now:
        return ()
    text = "the bench was described differently then: it is drawn as it is now"
    return (warning("another-lab", text, hint="`pico log` shows what changed since"),)


def _document(
    setup: Setup, about: Document, seen: Observation, deeds: Sequence[Deed], motion: Motion | None,
    doubts: tuple[Diagnostic, ...] = (),
) -> Framed:  # fmt: skip
    walk = Walk(setup, motion or DeferredMotion(setup), seen)
    told, first = telling.begun(setup, moment_of(seen), 0)
    moved, changes, phases = list[Document](), list[Document](), list[tuple[float, str, str]]()
    for key in walk.keys(deeds):
        told, said = _told(told, key)
        changes += said
        moved += _moved(told, key)
        phases += [(round(key.time, 4), robot, phase) for robot, phase in key.phases]
    wrong = (*doubts, *walk.told)
    found: Document = {
        "schema": SCHEMA, **about, "seconds": max((deed.end for deed in deeds), default=0.0), "scene": first["scene"],
        "steps": [_step(deed) for deed in deeds], "moved": moved, "told": changes, "phases": phases,
        "diagnostics": as_json(wrong),
    }  # fmt: skip
    return found, wrong


def _moved(told: telling.Told, key: Key) -> list[Document]:
    if not (key.robots or key.parts):
        return []
    robots = [sorted(told.setup.lab.robots).index(name) for name in key.robots]
    arms, places = telling.arms_of(told.setup, key.moment), telling.places_of(told.names, key.moment)
    parts = [told.names.index(name) for name in key.parts if name in told.names]
    return [
        telling.posed(
            round(key.time, 4), {n: arms[n] for n in robots if n in arms}, {n: places[n] for n in parts if n in places}
        )
    ]


def _told(told: telling.Told, key: Key) -> tuple[telling.Told, list[Document]]:
    told, changes = telling.stood(told, key.moment)
    if changes:
        told, light = telling.relit(told, key.moment)
        changes += light
    return told, [
        {"time": round(key.time, 4), "kind": one["told"], "rev": one["rev"], "data": one["data"]} for one in changes
    ]


def _step(deed: Deed) -> Document:
    op = deed.operation
    found: Document = {
        "operation": op.id, "attempt": deed.attempt, "primitive": op.primitive, "component": op.component,
        "address": op.address, "start": round(deed.start, 4), "seconds": round(deed.seconds, 4),
        "outcome": deed.outcome,
    }  # fmt: skip
    found |= {"robot": op.robot} if op.robot else {}
    found |= {"planned": round(deed.planned, 4)} if deed.planned is not None else {}
    return found | ({"run": deed.run} if deed.run else {})
