"""What a morning found: what drifted, the likely part, the shortest repair."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .style import ago, columns, listed, paint, seconds, wrap

if TYPE_CHECKING:
    from pico.bench.mornings import Morning, Read
    from pico.diagnosis.suspects import Suspect
    from pico.model.trace.event import Event

TOLD = 3.0
"""Standard deviations of what is usual from which a change is shown."""
MOST, MANY = 4, 8
"""How many causes are told, and how many names in a row."""
SHOWN, SURE = 0.05, 0.5
"""Probabilities: of a cause that is told, and of nothing unusual where it is the likeliest."""
_INDENT = " " * 9
_SHARES = ("loss", "gain")
_WAYS = {"left": "to its left", "up": "up", "ahead": "ahead", "yaw": "about the vertical", "pitch": "up or down"}


def line(event: Event) -> str:
    """Return what is being read, in one line; empty for what does not matter."""
    if event.kind != "operation_progress" or "phase" not in event.data:
        return ""
    at = ", ".join(f"{k} {v:g}" for k, v in event.data["point"].items() if not k.endswith(".exposure"))
    return f"{100 * event.data['fraction']:3.0f} %  {event.data['phase']}" + (f" at {at}" if at else "")


def text(morning: Morning) -> str:
    """Return what is worth knowing of a morning."""
    if morning.cut_short:
        back = "all is set back" if morning.set_back else "not all is set back: `pico status` shows it"
        return f"Cut short: what was read is not judged, and {back}."
    if not morning.reference:
        why = f"Nothing to compare with: {morning.why}. " if morning.why else ""
        told = "This morning is the reference from now on." if morning.accepted else "It is no reference."
        return "\n".join([f"{why}{told}".strip(), "", *_table(morning.readings), *_lacks(morning)])
    since = f"since {morning.reference[:16].replace('T', ' ')} ({ago(morning.reference)})"
    kept = ["This morning is the reference from now on."] if morning.accepted else []
    changed = [r for r in morning.readings if _unusual(r)]
    if not morning.unusual:
        quiet = next((s.probability for s in morning.suspects if not s.part), 1.0)
        took = f"{len(morning.readings)} quantities in {seconds(morning.seconds)}"
        title = f"Nothing unusual {since}: {took}, {100 * quiet:.0f} % sure."
        return "\n".join([paint("green", title), *_table(changed), *kept, *_lacks(morning)])
    title = paint("yellow", f"Something happened {since}:")
    return "\n".join([title, "", *_table(changed), "", *_suspects(morning), *kept, *_lacks(morning)])


def _unusual(one: Read) -> bool:
    return (one.change is not None and abs(one.change) >= TOLD) or (one.then is not None and one.now is None)


def _table(reads: tuple[Read, ...] | list[Read]) -> list[str]:
    """Return what was read, beside what it was where there is a reference; what was not read then in rows of their
    own."""
    beside = any(r.then is not None for r in reads)
    heads = ("reading", "then", "now", "times its usual change") if beside else ("reading", "now")
    rows = [_row(one, beside) for one in reads if one.now is not None or not beside]
    told = columns([[paint("dim", head) for head in heads], *rows]) if rows else []
    return [*(f"  {row}" for row in told), *(_unread(reads) if beside else [])]


def _row(one: Read, beside: bool) -> list[str]:
    now = _value(one, one.now) if one.now is not None else f"not read: {one.unknown or 'it does not tell'}"
    if not beside:
        return [one.name, now]
    many = "" if one.change is None else f"{one.change:+.1f}"
    if one.law in ("share", "depth") and one.then is not None and one.now is not None:
        return [one.name, "", f"{100 * (math.exp(min(50.0, one.now - one.then)) - 1):+.3g} %", many]
    return [one.name, "" if one.then is None else _value(one, one.then), now, many]


def _unread(reads: tuple[Read, ...] | list[Read]) -> list[str]:
    """Return what was not read, once for each reason."""
    why: dict[str, list[str]] = {}
    for one in reads:
        if one.now is None:
            why.setdefault(one.unknown or "it does not tell", []).append(one.name)
    return [row for reason, names in why.items() for row in wrap(f"Not read: {listed(names, MANY)}; {reason}.", "  ")]


def _value(one: Read, value: float) -> str:
    if one.law in ("share", "depth"):
        return f"{math.exp(min(700.0, value)):.4g}"
    return f"{value:.4g} {one.unit}".rstrip() if one.law != "null" else f"{value:.3f} {one.unit}"


def _suspects(found: Morning) -> list[str]:
    told = list(_alike([s for s in found.suspects if s.part]))[:MOST]
    lines = [
        row for same in told if (share := sum(s.probability for s in same)) >= SHOWN for row in _cause(share, same)
    ]
    if not lines:
        quiet = sum(s.probability for s in found.suspects if s.kind == "nothing unusual")
        calm, else_ = "All that was read is as usual.", "No single change of a known part explains it."
        lines.append(f"  {calm if quiet >= SURE else else_}")
    return [*lines, *([f"Shortest repair: {found.repair}."] if found.repair else [])]


def _alike(suspects: list[Suspect]) -> Iterator[list[Suspect]]:
    """Yield suspects, each with those that the same befell and that nothing tells from it."""
    while suspects:
        first = suspects[0]
        same = [s for s in suspects if s is first or (s.part in first.like and s.kind == first.kind)]
        yield same
        suspects = [s for s in suspects if s not in same]


def _cause(share: float, same: list[Suspect]) -> list[str]:
    first, parts = same[0], [s.part for s in same]
    who = first.part if len(same) == 1 else f"one of {listed(parts, MANY)}, which nothing tells apart"
    rows = wrap(f"{who}: {said(first)}", _INDENT)
    lines = [f"  {100 * share:3.0f} %  {rows[0].strip()}", *rows[1:]]
    if like := [part for part in first.like if part not in parts]:
        rest = f"No reading tells {first.part} from {listed(like)}, where another change would show the same."
        lines += [paint("dim", row) for row in wrap(rest, _INDENT)]
    return lines


def said(one: Suspect) -> str:
    """Return what probably happened, with its size: `zero of angle, by 0.50 ± 0.01 deg`."""
    sizes = []
    for what, size in one.size.items():
        sigma, unit = one.sigma[what], one.units[what]
        if what in _SHARES:
            change = math.exp(size if what == "gain" else -size) - 1
            sizes.append(f"{_with(100 * change, 100 * sigma * (1 + change))} % of its light")
        elif what == "leak":
            sizes.append(f"{math.exp(min(50.0, size)):.2g} times as much leaks")
        else:
            sizes.append(f"{_with(size, sigma)} {unit} {_WAYS.get(what, '')}".strip())
    return f"{one.kind}, {' and '.join(sizes)}" if sizes else one.kind


def _with(size: float, sigma: float) -> str:
    """Return a size with its standard deviation, of which it shows one digit: `-1.50 ± 0.01`."""
    digits = min(6, max(0, -math.floor(math.log10(sigma)))) if sigma > 0 else 2
    return f"{size:+.{digits}f} ± {sigma:.{digits}f}"


def _lacks(found: Morning) -> list[str]:
    rows = [row for lack in found.lacks for row in wrap(f"To tell more: {lack}.", "  ")]
    return ["", *(paint("dim", row) for row in rows)] if rows else []


def data(found: Morning) -> dict[str, Any]:
    """Return schema `pico.morning/v1`: `reference` (when, empty where none), `age` of it [s], `unusual`, `readings`,
    `suspects` by probability, `repair`, `lacks`."""
    return {"schema": "pico.morning/v1", **as_json(found)}
