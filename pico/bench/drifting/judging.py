"""What the readings of a morning tell beside those of its reference: what changed, and what may have happened."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.base import clock
from pico.bench.drifting.drift import by_hand, who
from pico.bench.drifting.expected import Expected, expected, unsure
from pico.bench.drifting.morning import Morning, Moved, Read, Survey
from pico.bench.drifting.readings import NOT_ASKED, Readings
from pico.diagnosis.quantities import Got, Quantity
from pico.model.observation import ObservedComponent

if TYPE_CHECKING:
    from pico.diagnosis.suspects import Verdict
    from pico.runs.journal import JournalRecord

UNUSUAL = 0.5
"""The probability that something happened from which a morning says so."""
GONE = -9.0
"""The logarithm of the share of a reading that a camera which sees no light at all is taken to read."""
Readable = tuple[Got | None, ...]
AS_IT_WAS = Expected()


def compared(
    survey: Survey, found: Morning, read: Readings, got: Readable, records: Sequence[JournalRecord]
) -> Morning:  # fmt: skip
    """Return a morning with its readings beside those of the reference, what has moved, and who is suspected; of one
    that was cut short nothing is judged. `records`: what the journal has of what has moved."""
    from pico.diagnosis.doubt import UNEXPLAINED
    from pico.diagnosis.repairs import repair, unread
    from pico.diagnosis.suspects import NOTHING

    reference = survey.reference
    kept = dict(zip(map(_key, reference.quantities), reference.got, strict=True)) if reference else {}
    then = tuple(kept.get(_key(q)) for q in survey.quantities)
    if reference is None or read.cut_short:
        none = tuple(
            _read(survey, q, a, b, why=read.why(q)) for q, a, b in zip(survey.quantities, then, got, strict=True)
        )
        return replace(found, readings=none)
    ways = unsure(survey.seen, survey.nominal, survey.moved)
    shifts = expected(survey.then, survey.nominal, survey.quantities, survey.moved, ways)
    now = tuple(_dark(read, q, a, b) for q, a, b in zip(survey.quantities, then, got, strict=True))
    verdict, changes, left = _verdict(survey, then, now, shifts)
    reads = tuple(
        replace(_read(survey, q, a, b, change, s, read.why(q)), left=rest)
        for q, a, b, change, s, rest in zip(survey.quantities, then, got, changes, shifts, left, strict=True)
    )
    missed = tuple(one.name for one in reads if abs(one.left or 0.0) > UNEXPLAINED)
    moved = tuple(_moved(survey, n, records) for n in range(len(survey.moved)))
    lost = [q for q, a, b, s in zip(survey.quantities, then, now, shifts, strict=True)
            if a and not b and not s.why and read.why(q) != NOT_ASKED]  # fmt: skip
    causes = verdict.causes if verdict else ()
    suspects = verdict.suspects if verdict else ()
    changed = bool(causes) or sum(s.probability for s in suspects if s.kind != NOTHING) > UNUSUAL
    values = survey.nominal.values
    repairs = tuple(repair(survey.nominal.setup, group[0], values) for group in causes)
    first = repairs or tuple(m.repair for m in moved if m.by_hand)
    if changed and not first:
        first = (repair(survey.nominal.setup, None, values),)
    return replace(
        found, reference=reference.at, age=clock.seconds_on_bench(reference.at, found.at, survey.seen.waits),
        readings=reads, moved=moved, causes=causes, repairs=repairs, suspects=suspects,
        blind=verdict.blind if verdict else (),
        unexplained=missed, unusual=changed or bool(missed) or bool(lost) or any(m.by_hand for m in moved),
        repair=first[0] if first else unread(lost[0].shots[0].address) if lost else "",
    )  # fmt: skip


def _key(one: Quantity) -> tuple[object, ...]:
    return one.name, one.law, *(shot.key for shot in one.shots)


def _dark(read: Readings, wanted: Quantity, then: Got | None, now: Got | None) -> Got | None:
    """Return what a quantity is, of a share that was not read for want of light next to nothing."""
    if now or then is None or wanted.law != "share" or not read.dark(wanted):
        return now
    return Got(then.value + GONE, 1.0)


def _verdict(
    survey: Survey, then: Readable, now: Readable, shifts: Sequence[Expected]
) -> tuple[Verdict | None, list[float], list[float | None]]:  # fmt: skip
    """Return what is suspected; the change of each quantity in standard deviations of what is usual, nan of those that
    are not compared; and what the causes leave of it, None of those that are not weighed."""
    from pico.diagnosis.causes import causes
    from pico.diagnosis.choosing import chosen
    from pico.diagnosis.suspects import Compared, suspects

    both = enumerate(zip(survey.quantities, then, now, shifts, strict=True))
    told = {n: Compared(q, a, b, s.shift) for n, (q, a, b, s) in both if a and b and not s.why}
    changes, left = [math.nan] * len(then), list[float | None]([None] * len(then))
    if not told:
        return None, changes, left
    read = sorted({s.address.partition(".")[0] for q in survey.quantities for s in q.shots})
    before = chosen(survey.then, survey.quantities).parts if survey.moved else ()
    parts = tuple(n for n in dict.fromkeys((*before, *survey.chosen.parts, *read)) if n in survey.nominal.poses)
    ways = unsure(survey.seen, survey.nominal, survey.moved)
    verdict = suspects(survey.nominal, [*told.values()], causes(survey.nominal.setup, parts), ways)
    for n, change, rest in zip(told, verdict.changes, verdict.left, strict=True):
        changes[n], left[n] = change, rest if math.isfinite(rest) else None
    return verdict, changes, left


def _moved(survey: Survey, number: int, records: Sequence[JournalRecord]) -> Moved:
    """Return what stands or is set otherwise, with who did it as far as the journal knows."""
    change, setup = survey.moved[number], survey.nominal.setup
    part = survey.seen.components.get(change.component) or ObservedComponent(presence="missing")
    by = who(setup, part, change, records)[0] if records else "unknown"
    if change.after is None and change.tunable == "pose":
        back = f"put {change.component} back on the table by hand"
    else:
        back = f"{why}, so put {change.component} back by hand" if (why := by_hand(setup, part, change)) else ""
    return Moved(
        change,
        by != "operation",
        back or "`pico plan` shows how it comes back to what the manifest says, `pico apply` does it",
    )


def _read(
    survey: Survey, wanted: Quantity, then: Got | None, now: Got | None, change: float = math.nan,
    shift: Expected = AS_IT_WAS, why: str = "",
) -> Read:  # fmt: skip
    component, _, measurable = wanted.shots[0].address.partition(".")
    unit = wanted.unit
    if wanted.law == "share" and wanted.number != "spread":
        units = survey.nominal.setup.measurables_of(component)[measurable].unit.split(",")
        unit = units[0].strip() if wanted.number in (measurable, "size") else ""
    return Read(
        wanted.name, wanted.law, unit, then.value if then else None, now.value if now else None,
        now.sigma if now else None, None if math.isnan(change) else change, shift.why if now else shift.why or why,
        then.value + shift.shift if then and shift.shift else None,
    )  # fmt: skip
