"""The step in which a part of each type is picked and placed again and again."""

from __future__ import annotations

import signal
from collections.abc import Iterator, Mapping
from typing import Any

from pico.bench.commissioning.standing import NO_ARM, REPEATS, AtBench, Found, shortened
from pico.bench.running.attending import attend
from pico.diagnostics import PicoError, error
from pico.model.commissioning import CODE
from pico.model.observation import Observation, slot_at
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.model.trace.event import Event
from pico.motion.deferred import DeferredMotion

PLACES = 4
"""So many free slots a part is taken to, one after the other."""


def pick_and_place(at: AtBench) -> Found:
    """A part of each type that arms move is taken from slot to slot, `repeats` times, and back; each time cameras say
    how far from its goal it stands. Raises PicoError for the first that fails."""
    if not at.edge.setup.lab.robots:
        return NO_ARM
    found: dict[str, Any] = dict(at.before.get("types", {}))
    for kind, name in one_of_each(at.edge.setup, at.bench.observe()).items():
        if found.get(kind, {}).get("times", 0) >= at.repeats:
            continue
        found[kind] = {"part": name, **_repeated(at, kind, name)}
        at.keep(Found(told=f"{len(found)} types so far", data={"types": found, "repeats": at.repeats}, begun=True))
    if not found:
        raise PicoError(error(CODE, "no part that an arm moves is on the table"))
    worst = max(found, key=lambda kind: float(found[kind]["most_mm"]))
    times = sum(int(one["times"]) for one in found.values())
    told = f"{times} times, {len(found)} types, at most {found[worst]['most_mm']:.3f} mm off ({found[worst]['part']})"
    return Found(
        told=told + shortened(at.repeats, REPEATS, "times a type"), data={"types": found, "repeats": at.repeats}
    )


def one_of_each(setup: Setup, seen: Observation) -> dict[str, str]:
    """Return for each type that arms move the first part of it that stands on the table, by name."""
    found: dict[str, str] = {}
    for name in sorted(setup.lab.inventory):
        part = seen.components.get(name)
        stands = part is not None and part.presence == "seen" and part.pose is not None
        if stands and setup.movable(name) and not setup.lab.inventory[name].sample:
            found.setdefault(setup.type_of(name).name, name)
    return found


def free_slots(setup: Setup, seen: Observation, name: str) -> Iterator[str]:
    """Yield the slots in which nothing stands and to which an arm can bring a part."""
    taken = {slot_at(setup, p.pose) for n, p in seen.components.items() if p.pose is not None and n != name}
    here = seen.components[name].pose
    motion = DeferredMotion(setup)
    for slot, place in sorted(setup.lab.slots.items()):
        if slot in taken or (here is not None and slot_at(setup, here) == slot):
            continue
        if any(motion.reach(robot, name, place.pose, 0.0) is None for robot in setup.lab.robots):
            yield slot


def _repeated(at: AtBench, kind: str, name: str) -> dict[str, Any]:
    """Return how often a part was picked and placed, and how far off it stood [mm, deg]."""
    seen = at.bench.observe()
    home, start = seen.components[name].pose, slot_at(at.edge.setup, seen.components[name].pose)  # type: ignore[arg-type]
    assert home is not None  # it stands there
    places = [slot for slot, _ in zip(free_slots(at.edge.setup, seen, name), range(PLACES), strict=False)]
    if not places:
        raise PicoError(error(CODE, f"there is no free slot to which {name} could be taken", address=name))
    if len(places) == 1:
        places = [*places, start] if start else [*places, ""]
    untried = bool(at.bench.wait(at.device.untried()))
    if not untried:
        at.require(f"Take {name} ({kind}) {at.repeats} times from slot to slot?")
    off: list[tuple[float, float]] = []
    for turn in range(at.repeats):
        off.append(_taken(at, name, places[turn % len(places)] or _pose(home), untried))
    _taken(at, name, start or _pose(home), untried)
    return {
        "times": at.repeats, "most_mm": round(max(mm for mm, _ in off), 4),
        "mean_mm": round(sum(mm for mm, _ in off) / len(off), 4), "most_deg": round(max(deg for _, deg in off), 4),
    }  # fmt: skip


def _pose(pose: Any) -> dict[str, float]:
    return {"x": pose.x, "y": pose.y, "yaw": pose.yaw}


def _taken(at: AtBench, name: str, where: str | Mapping[str, float], untried: bool) -> tuple[float, float]:
    """Have a part taken somewhere, and return how far from there it then stands [mm, deg]; raises PicoError."""
    plan = at.bench.plans.moving({name: where})
    if plan.exit_code:
        raise PicoError([d for d in plan.diagnostics if d.severity == "error"], plan.exit_code)
    if not plan.operations:
        return 0.0, 0.0
    if untried:
        at.require_hand_on_stop(f"{name} is taken to {where}")
    return _off(at, name, plan)


def _off(at: AtBench, name: str, plan: Plan) -> tuple[float, float]:
    run, off = at.bench.run(plan, holder="pico commission"), [(0.0, 0.0)]

    def heard(event: Event) -> None:
        if event.kind == "operation_done" and event.component == name and "error_mm" in event.data:
            off.append((float(event.data["error_mm"]), float(event.data["error_deg"])))

    if came := attend(run, heard):
        signal.raise_signal(came[0])
    if run.report.outcome != "done" or not run.report.reached:
        told = [d for d in run.report.diagnostics if d.severity == "error"]
        raise PicoError(told or [error(CODE, f"{name} was not brought where it was to stand", address=name)])
    return off[-1]
