"""What a twin injects from now on, of what runs of its bench showed: how parts scatter, how long operations take.

A number is taken where ENOUGH data stand behind it; else what was declared stays, and that is told.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field

from pico.diagnostics import Diagnostic, warning
from pico.geometry.seat import injected, scatter_of
from pico.model.record import record
from pico.model.setup import Setup
from pico.model.trace.learned import Estimate, Learned, Scatter
from pico.runs.lessons import Lessons, Off
from pico.runs.robust import Found, between, ratio, scatter

ENOUGH = 8
"""Data from which on a number is believed: one standard deviation is then known to a fifth, of yaw to a quarter."""
SURE = 4.0
"""So many standard errors from 0, a mean is no chance."""


@record
class Row:
    """A number of a twin: what it had `before`, what runs `measured` (None: too few data) with the standard error
    `sigma`, of `count` data, and what it has `after`. `because`: why that is not what was measured of just this."""

    what: str
    unit: str
    count: int
    before: float
    measured: float | None = None
    sigma: float = 0.0
    after: float
    outliers: int = 0
    because: str = ""


@record
class Lesson:
    """What a twin `learned`, number by number; how long operations took in all, measured, by the plan, and as the twin
    said before and says after [s]; what is odd."""

    learned: Learned
    rows: tuple[Row, ...] = ()
    seconds: Mapping[str, float] = field(default_factory=dict)
    diagnostics: tuple[Diagnostic, ...] = ()
    written: bool = False


def learn(setup: Setup, told: Lessons, had: Learned | None, usual: float) -> Lesson:
    """Return what a twin learns that `had` learned before, all that cameras need left out.

    `usual`: the multiple of what types repeat to that the twin injects where the lab names none: 0 in kinematic
    fidelity, 1 in physics.
    """
    looks = looks_of(told)
    by_type: dict[str, list[Off]] = defaultdict(list)
    by_seating: dict[str, list[Off]] = defaultdict(list)
    for off in told.placed:
        by_type[setup.lab.inventory[off.component].type].append(off)
        by_seating[setup.seating_of(off.component)].append(_relative(setup, off, looks))
    alike = {name: _scatter(offs, None, _usual(had, usual, name)) for name, offs in sorted(by_seating.items())}
    own = {name: _scatter(offs, looks, _declared(setup, had, usual, offs)) for name, offs in sorted(by_type.items())}
    taken = Learned(
        types={name: _believed(pair) for name, pair in own.items() if _believed(pair) != Scatter()},
        seatings={name: _believed(pair) for name, pair in alike.items() if _believed(pair) != Scatter()},
        times=_times(told, had),
    )
    rows = [row for name in own for row in _placed_rows(setup, name, own[name], by_type[name], had, taken, usual)]
    rows += _timed_rows(told, had, taken)
    return Lesson(
        learned=taken, rows=tuple(rows), seconds=_seconds(told, had, taken), diagnostics=tuple(_biased(told)),
    )  # fmt: skip


Pair = tuple[Estimate | None, Estimate | None]


def looks_of(told: Lessons) -> Scatter | None:
    """Return how what is seen of a part at rest scatters from look to look; None where it was seen too seldom. `before`
    is 0: what the twin's own looks scatter by only these tell."""
    steps = told.looked.values()
    place = between([[getattr(off, axis) for off in part] for part in steps for axis in ("x", "y")])
    turn = between([[off.yaw for off in part] for part in steps])
    if place is None or turn is None or turn.count < ENOUGH:
        return None
    return Scatter(position=_estimate(place, 0.0), yaw=_estimate(turn, 0.0))


def _scatter(offs: Sequence[Off], looks: Scatter | None, before: tuple[float, float]) -> Pair:
    """Return how placements scatter, what looking adds taken off: what looks showed, else what each says."""
    seen = [looks.position.value if looks and looks.position else off.position for off in offs]
    turned = [looks.yaw.value if looks and looks.yaw else off.turn for off in offs]
    position = scatter([[off.x for off in offs], [off.y for off in offs]], [seen, seen])
    yaw = scatter([[off.yaw for off in offs]], [turned])
    return (
        replace_count(_estimate(position, before[0]), len(offs)) if position else None,
        _estimate(yaw, before[1]) if yaw else None,
    )


def replace_count(found: Estimate, count: int) -> Estimate:
    """Return an estimate from `count` placements, each of which gave two numbers."""
    return Estimate(value=found.value, sigma=found.sigma, count=count, before=found.before)


def _relative(setup: Setup, off: Off, looks: Scatter | None) -> Off:
    """Return a placement in multiples of what its type repeats to; of a type that repeats exactly, as it is."""
    one = scatter_of(setup, off.component)
    place, turn = one.x or math.inf, one.yaw or math.inf
    seen = looks.position.value if looks and looks.position else off.position
    turned = looks.yaw.value if looks and looks.yaw else off.turn
    return Off(off.component, off.x / place, off.y / place, off.yaw / turn, seen / place, turned / turn)


def _declared(setup: Setup, had: Learned | None, usual: float, offs: Sequence[Off]) -> tuple[float, float]:
    one = injected(setup, offs[0].component, had, usual)
    return one.x, one.yaw


def _usual(had: Learned | None, usual: float, seating: str) -> tuple[float, float]:
    own = had.seatings.get(seating) if had else None
    position, yaw = (own.position, own.yaw) if own else (None, None)
    return position.value if position else usual, yaw.value if yaw else usual


def _believed(pair: Pair) -> Scatter:
    position, yaw = (one if one is not None and one.count >= ENOUGH else None for one in pair)
    return Scatter(position=position, yaw=yaw)


def _estimate(found: Found, before: float) -> Estimate:
    return Estimate(value=found.value, sigma=found.sigma, count=found.count, before=before)


def _times(told: Lessons, had: Learned | None) -> dict[str, Estimate]:
    found = {}
    for kind, pairs in sorted(told.times.items()):
        one = _ratio(pairs)
        if one is not None and one.count >= ENOUGH:
            found[kind] = _estimate(one, had.time(kind) if had else 1.0)
    return found


def _ratio(pairs: Sequence[tuple[float, float]]) -> Found | None:
    return ratio([m for m, _ in pairs], [p for _, p in pairs])


def _placed_rows(
    setup: Setup, name: str, pair: Pair, offs: Sequence[Off], had: Learned | None, taken: Learned, usual: float
) -> Iterable[Row]:
    before, after = (injected(setup, offs[0].component, one, usual) for one in (had, taken))
    seating = setup.seating_of(offs[0].component)
    axes: tuple[tuple[Estimate | None, str, float, float, str], ...] = (
        (pair[0], "mm", before.x, after.x, "position"), (pair[1], "deg", before.yaw, after.yaw, "yaw"),
    )  # fmt: skip
    for one, unit, was, now, axis in axes:
        enough = one is not None and one.count >= ENOUGH
        alike = seating in taken.seatings and getattr(taken.seatings[seating], axis) is not None
        why = "" if enough else f"as all that is {seating}" if alike else "too few, as declared"
        yield Row(
            what=f"{name}, {axis}", unit=unit, count=len(offs), before=was, after=now, because=why,
            measured=one.value if one and enough else None, sigma=one.sigma if one and enough else 0.0,
        )  # fmt: skip


def _timed_rows(told: Lessons, had: Learned | None, taken: Learned) -> Iterable[Row]:
    for kind, pairs in sorted(told.times.items()):
        one = taken.times.get(kind)
        yield Row(
            what=kind, unit="x", count=len(pairs), before=had.time(kind) if had else 1.0, after=taken.time(kind),
            measured=one.value if one else None, sigma=one.sigma if one else 0.0,
            outliers=len(pairs) - one.count if one else 0, because="" if one else "too few, as planned",
        )  # fmt: skip


def _seconds(told: Lessons, had: Learned | None, taken: Learned) -> dict[str, float]:
    def all_of(each: Callable[[str, float, float], float]) -> float:
        return sum(each(kind, m, p) for kind, pairs in told.times.items() for m, p in pairs)

    return {
        "measured": all_of(lambda kind, m, p: m),
        "planned": all_of(lambda kind, m, p: p),
        "before": all_of(lambda kind, m, p: p * (had.time(kind) if had else 1.0)),
        "after": all_of(lambda kind, m, p: p * taken.time(kind)),
    }


def _biased(told: Lessons) -> Iterable[Diagnostic]:
    """Yield what is no scatter: where all that is put down stands off the same way."""
    for axis, unit in (("x", "mm"), ("y", "mm"), ("yaw", "deg")):
        values = [getattr(off, axis) for off in told.placed]
        found = scatter([values], [[0.0] * len(values)]) if len(values) >= ENOUGH else None
        if found is None or not found.count:
            continue
        mean = sorted(values)[len(values) // 2]
        sigma = found.value * math.sqrt(math.pi / 2 / found.count)  # of a median
        if abs(mean) > SURE * max(sigma, 1e-6):
            text = f"what is put down stands {mean:+.3f} ± {sigma:.3f} {unit} off in {axis}: that is no scatter"
            hint = "`pico calibrate` finds how cameras and arms are off; the twin learns the scatter about it alone"
            yield warning("placed-aside", text, hint=hint)
