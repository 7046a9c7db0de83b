"""What a morning found: what drifted, the likely part, the shortest repair."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .style import ago, columns, listed, paint, seconds, wrap

if TYPE_CHECKING:
    from pico.bench.mornings import Morning, Read
    from pico.diagnosis.suspects import Suspect
    from pico.model.event import Event

TOLD = 3.0
"""Standard deviations of what is usual from which a change is shown."""
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
    took = f"{len(morning.readings)} quantities in {seconds(morning.seconds)}"
    if morning.cut_short:
        return f"Cut short: what was read is not judged, and all is set back. {took}."
    if not morning.reference:
        why = f"Nothing to compare with: {morning.why}. " if morning.why else ""
        told = "This morning is the reference from now on." if morning.accepted else "It is no reference."
        return "\n".join([f"{why}{told}".strip(), "", *_table(morning.readings), *_lacks(morning)])
    since = f"since {morning.reference[:16].replace('T', ' ')} ({ago(morning.reference)})"
    kept = ["This morning is the reference from now on."] if morning.accepted else []
    changed = [r for r in morning.readings if _unusual(r)]
    if not morning.unusual:
        quiet = next((s.probability for s in morning.suspects if not s.part), 1.0)
        title = f"Nothing unusual {since}: {took}, {100 * quiet:.0f} % sure."
        return "\n".join([paint("green", title), *_table(changed), *kept, *_lacks(morning)])
    title = paint("yellow", f"Something happened {since}:")
    return "\n".join([title, "", *_table(changed), "", *_suspects(morning), *kept, *_lacks(morning)])


def _unusual(one: Read) -> bool:
    return (one.change is not None and abs(one.change) >= TOLD) or (one.then is not None and one.now is None)


def _table(reads: tuple[Read, ...] | list[Read]) -> list[str]:
    if not reads:
        return []
    heads = (
        ("reading", "then", "now", "usual changes") if any(r.then is not None for r in reads) else ("reading", "now")
    )
    rows = [[paint("dim", head) for head in heads]]
    for one in reads:
        now = _value(one, one.now) if one.now is not None else f"not read: {one.unknown or 'it does not tell'}"
        many = "" if one.change is None else f"{one.change:+.1f}"
        if len(heads) == 2:
            rows.append([one.name, now])
        elif one.law in ("share", "depth") and one.then is not None and one.now is not None:
            rows.append([one.name, "", f"{100 * (math.exp(min(50.0, one.now - one.then)) - 1):+.3g} %", many])
        else:
            rows.append([one.name, "" if one.then is None else _value(one, one.then), now, many])
    return [f"  {row}" for row in columns(rows)]


def _value(one: Read, value: float) -> str:
    if one.law in ("share", "depth"):
        return f"{math.exp(min(700.0, value)):.4g}"
    return f"{value:.4g} {one.unit}".rstrip() if one.law != "null" else f"{value:.3f} {one.unit}"


def _suspects(found: Morning) -> list[str]:
    lines = []
    known = [s for s in found.suspects if s.part and s.probability >= 0.05][:4]
    for one in known:
        lines.append(f"  {100 * one.probability:3.0f} %  {one.part}: {said(one)}")
    if known and known[0].like:
        rest = f"No reading tells {known[0].part} from {listed(known[0].like)}, where the same would show the same."
        lines += [paint("dim", row) for row in wrap(rest, "         ")]
    if not known:
        lines.append("  No single change of a known part explains it.")
    return [*lines, *([f"Shortest repair: {found.repair}."] if found.repair else [])]


def said(one: Suspect) -> str:
    """Return what probably happened, with its size: `zero of angle, by 0.50 ± 0.01 deg`."""
    sizes = []
    for what, size in one.size.items():
        sigma, unit = one.sigma[what], one.units[what]
        if what in _SHARES:
            change = math.exp(size if what == "gain" else -size) - 1
            sizes.append(f"{100 * change:+.2g} ± {100 * sigma:.1g} % of its light")
        elif what == "leak":
            sizes.append(f"{math.exp(min(50.0, size)):.2g} times as much leaks")
        else:
            sizes.append(f"{size:+.2g} ± {sigma:.1g} {unit} {_WAYS.get(what, '')}".strip())
    return f"{one.kind}, {' and '.join(sizes)}" if sizes else one.kind


def _lacks(found: Morning) -> list[str]:
    rows = [row for lack in found.lacks for row in wrap(f"To tell more: {lack}.", "  ")]
    return ["", *(paint("dim", row) for row in rows)] if rows else []


def data(found: Morning) -> dict[str, Any]:
    """Return schema `pico.morning/v1`: `reference` (when, empty where none), `age` of it [s], `unusual`, `readings`,
    `suspects` by probability, `repair`, `lacks`."""
    return {"schema": "pico.morning/v1", **as_json(found)}
