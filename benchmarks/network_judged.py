"""What must hold of a lab on the network whose processes were killed and frozen, judged by the log of its controllers,
the journal of its edge and the leases in the coordinator's books. Pure but for reading."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

LATE = 1.5
"""By so much may the log of a busy machine be behind what was told [s]."""
SLACK = 0.05
"""So much may the clocks of journal and books differ, which count milliseconds [s]."""
ENDS = 20.0
"""Within which an arm is at rest after its lease is over, where its edge runs: it brings a part to where it is safe,
and parks [s]."""
SAFE = ("=closed", ".emission")
"""What may be set whenever: shutters close, and lasers go off."""
OWN = "the edge"
"""Whose run it is that an edge parks in by itself."""


@dataclass(frozen=True)
class Doing:
    """An operation that began: with which token, when, and until when at the longest by the journal [s]; `until` the
    edge's death where it was cut short."""

    key: str
    operation: Any
    token: int
    since: float
    until: float
    own: bool

    @property
    def moves(self) -> str:
        """The arm, or the part, that it moves."""
        return self.operation.robot or self.operation.component


@dataclass(frozen=True)
class Fault:
    """What befell whom, from when to when [s]."""

    victim: str
    deed: str
    since: float
    until: float


def doings(records: Iterable[Any], holders: Mapping[str, str], faults: Iterable[Fault]) -> list[Doing]:
    """Return what began, by the records of a journal and for whom each run was."""
    from datetime import datetime

    from pico.model.operation import operation_from_json

    deaths = sorted(f.since for f in faults if f.victim == "edge" and f.deed == "killed")
    meant: dict[str, Any] = {}
    found: dict[str, Doing] = {}
    for record in records:
        at = datetime.fromisoformat(record.at).timestamp()
        if record.kind == "intent":
            meant[record.key] = operation_from_json(record.data)
        elif record.kind == "started":
            killed = next((death for death in deaths if death >= at - SLACK), math.inf)
            own = holders.get(record.key.split("/")[0]) == OWN
            found[record.key] = Doing(record.key, meant[record.key], record.token, at, killed, own)
        elif record.kind in ("done", "failed", "unknown") and record.key in found:
            one = found[record.key]
            found[record.key] = Doing(one.key, one.operation, one.token, one.since, min(one.until, at), one.own)
    return list(found.values())


def controlled(path: Path) -> list[dict[str, Any]]:
    """Return the log of the controllers."""
    lines = path.read_text().splitlines() if path.exists() else []
    return [json.loads(line) for line in lines]


def unjournaled(log: list[dict[str, Any]], begun: list[Doing]) -> Iterator[str]:
    """Yield what moved though no operation on it was under way."""
    for motion in log:
        if "moves" not in motion or motion["moves"].endswith(SAFE):
            continue
        if not any(_covers(one, motion) for one in begun):
            near = min(begun, key=lambda one: abs(one.since - motion["since"]), default=None)
            yield f"{motion}, nearest {near and (near.key, near.moves, near.since, near.until)}"


def _covers(one: Doing, motion: Mapping[str, Any]) -> bool:
    device = motion["moves"].split(".")[0]
    if one.moves != device or motion["since"] < one.since - SLACK or motion["since"] > one.until + LATE:
        return False
    return one.operation.robot is None or bool(motion["until"] <= one.until + LATE)


def late(
    log: list[dict[str, Any]], begun: list[Doing], expiries: Mapping[int, float], faults: list[Fault]
) -> Iterator[str]:
    """Yield what began after the lease was over by the coordinator's books: operations by the journal; by the log of
    the controllers, axes that began to move, parts that a hand took, and arms that did not come to rest in time."""
    leased = [one for one in begun if not one.own]
    for one in leased:
        if one.since > expiries.get(one.token, -math.inf) + SLACK:
            yield f"{one.key} began at {one.since:.3f}, lease {one.token} until {expiries.get(one.token)}"
    for said in log:
        at = said.get("at", said.get("since", 0.0))
        device = said.get("fingers") or said["moves"].split(".")[0]
        doing = [one for one in begun if one.moves == device and one.since - SLACK <= at <= one.until + LATE]
        if any(one.own or at <= expiries.get(one.token, -math.inf) + SLACK for one in doing) or not doing:
            continue
        over = max(expiries.get(one.token, -math.inf) for one in doing)
        awake = max([over, *(f.until for f in faults if f.victim == "edge" and f.since <= at and f.until > over)])
        if said.get("takes"):
            yield f"{said['fingers']} took {said['takes']} {at - over:.3f} s after lease {doing[0].token} was over"
        elif "moves" in said and doing[0].operation.robot is None and not said["moves"].endswith(SAFE):
            yield f"{said['moves']} began to move {at - over:.3f} s after lease {doing[0].token} was over"
        elif "moves" in said and said["until"] > awake + ENDS:
            yield f"{said['moves']} moved until {said['until'] - awake:.1f} s after lease {doing[0].token} was over"


def overtaken(begun: list[Doing], expiries: Mapping[int, float]) -> int:
    """Return how many operations were under way when their lease was over: so often what follows then was tried."""
    return sum(not one.own and one.since < expiries.get(one.token, math.inf) < one.until for one in begun)


def repeated(setup: Any, log: list[dict[str, Any]], begun: list[Doing], corrections: int = 2) -> Iterator[str]:
    """Yield what was done again: a part that a hand took where it was to be brought, by an operation that had not
    brought it there itself, and one taken more often than it is corrected."""
    from pico.edge.recovery import arrived
    from pico.model.pose import Pose

    taken = Counter[str]()
    for said in log:
        if not said.get("takes"):
            continue
        at = said["at"]
        doing = [d for d in begun if d.operation.robot == said["fingers"] and d.since <= at <= d.until + LATE]
        one = max(doing, key=lambda d: d.since, default=None)
        if one is None:
            yield f"{said['fingers']} took {said['takes']} with no operation under way"
            continue
        taken[one.key] += 1
        if taken[one.key] > 1 + corrections:
            yield f"{one.key} took {said['takes']} {taken[one.key]} times"
        to = one.operation.arguments.get("to")
        if taken[one.key] == 1 and to and said["pose"] and arrived(setup, one.operation, Pose(**said["pose"])):
            yield f"{one.key} took {said['takes']} from where it was to be brought"


def dropped(log: list[dict[str, Any]]) -> Iterator[str]:
    """Yield what a hand let fall."""
    for said in log:
        if said.get("toppled"):
            yield f"{said['fingers']} let {said['drops']} fall at {said['at']:.3f}: {said}"
