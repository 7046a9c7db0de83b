"""What a morning found: what drifted, the likely part, the shortest repair."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from . import suspects
from .style import columns, listed, paint, past, seconds, wrap

if TYPE_CHECKING:
    from pico.bench.mornings import Morning, Read
    from pico.diagnosis.grouping import Suspect
    from pico.model.trace.event import Event

TOLD = 3.0
"""Standard deviations of what is usual from which a change is shown."""
MUCH = 999.0
"""Standard deviations above which a change is only told to be more."""
MANY = 8
"""How many names are told in a row."""
SHOWN, SURE = 0.05, 0.5
"""Probabilities: of a cause that is told, and of nothing unusual where it is the likeliest."""
_POSSIBLE = "may have changed"
"""The kind of suspects of which one or several account for what is not explained (`pico.diagnosis.doubt`)."""
_INDENT = " " * 9
_SHARES = ("loss", "gain", "power", "focal")
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
    kept = ["This morning is the reference from now on."] if morning.accepted else []
    if not morning.reference:
        told = kept or [_first(morning)]
        return "\n".join([*told, "", *_table(morning.readings), *_lacks(morning)])
    since = f"since {morning.reference[:16].replace('T', ' ')} ({past(morning.age)})"
    changed = [r for r in morning.readings if _unusual(r, morning.unusual)]
    if not morning.unusual:
        quiet = next((s.probability for s in morning.suspects if not s.part), 1.0)
        took = f"{len(morning.readings)} quantities in {seconds(morning.seconds)}"
        title = paint("green", f"Nothing unusual {since}: {took}, {100 * quiet:.0f} % sure.")
        if all(one.change is None for one in morning.readings):
            title = paint("yellow", f"Nothing is known of what happened {since}: no reading could be compared.")
        return "\n".join([title, *_table(changed), *_moved(morning), *kept, *_lacks(morning)])
    title = paint("yellow", f"Something happened {since}:")
    rows = _table(changed)
    return "\n".join(
        [title, "", *rows, *([""] if rows else []), *_moved(morning), *_suspects(morning), *kept, *_lacks(morning)]
    )


def _first(morning: Morning) -> str:
    """Return what is said of a morning that was compared with nothing."""
    if any(lack.startswith("no light comes to a detector") for lack in morning.lacks):
        return "No reference yet, and this morning can be none: no light comes to a detector."
    return "No reference yet: `pico morning --accept` makes this bench, as its light is now, the one to compare with."


def _unusual(one: Read, happened: bool) -> bool:
    """Return whether a reading is shown: it changed by more than is usual; where something `happened` by more than its
    noise; it differs though moved parts are expected to make it differ; or it could not be read or compared."""
    if one.now is None or one.change is None:
        return one.then is not None
    wanted = one.then if one.expected is None else one.expected
    noise = math.hypot(one.sigma or 0.0, one.sigma or 0.0)
    if one.expected is not None and one.then is not None and abs(one.now - one.then) >= TOLD * noise:
        return True
    return abs(one.change) >= TOLD or (happened and abs(one.now - (wanted or 0.0)) >= TOLD * noise)


def _table(reads: tuple[Read, ...] | list[Read]) -> list[str]:
    """Return what was read, beside what it was where there is a reference; what was not read or not compared in rows of
    their own."""
    beside = any(r.then is not None for r in reads)
    follows = any(r.expected is not None for r in reads)
    told = [r for r in reads if r.now is not None and (r.change is not None or not beside)]
    heads = ["reading", *(["then"] if beside else []), *(["expected"] if follows else []), "now"]
    heads += ["change", "σ"] if beside else []
    rows = [_row(one, beside, follows) for one in told]
    shown = columns([[paint("dim", head) for head in heads], *rows]) if rows else []
    return [*(f"  {row}" for row in shown), *_unread(reads, beside)]


def _row(one: Read, beside: bool, follows: bool) -> list[str]:
    assert one.now is not None
    if not beside or one.then is None:
        return [one.name, *([""] * (beside + follows)), _value(one, one.now)]
    wanted = one.then if one.expected is None else one.expected
    expected = [_value(one, wanted)] if one.expected is not None else [""]
    change = f"{'> ' if abs(one.change or 0) > MUCH else ''}{min(MUCH, max(-MUCH, one.change or 0.0)):+.1f}"
    return [
        one.name, _value(one, one.then), *(expected if follows else []), _value(one, one.now),
        _difference(one, one.now - wanted), change,
    ]  # fmt: skip


def _difference(one: Read, by: float) -> str:
    if one.law in ("share", "depth"):
        return f"{100 * (math.exp(min(50.0, by)) - 1):+.3g} %"
    return f"{by:+.3g} {one.unit}".rstrip()


def _unread(reads: tuple[Read, ...] | list[Read], beside: bool) -> list[str]:
    """Return what was not read, and what was not compared, once for each reason."""
    rows = []
    for said, those in (
        ("Not read", [r for r in reads if r.now is None]),
        ("Not compared", [r for r in reads if beside and r.now is not None and r.change is None]),
    ):
        why: dict[str, list[str]] = {}
        for one in those:
            why.setdefault(one.unknown or _UNTOLD[said], []).append(one.name)
        rows += [
            row for reason, names in why.items() for row in wrap(f"{said}: {listed(names, MANY)}; {reason}.", "  ")
        ]
    return rows


_UNTOLD = {"Not read": "its readings do not tell", "Not compared": "the reference has no such reading"}


def _value(one: Read, value: float) -> str:
    if one.law == "null":
        return f"{value:.3f} {one.unit}"
    number = math.exp(min(700.0, value)) if one.law in ("share", "depth") else value
    for unit, scale in _PREFIXES.get(one.unit, ()):
        if abs(number) * scale >= 0.1:
            return f"{number * scale:.4g} {unit}"
    return f"{number:.4g} {one.unit}".rstrip()


_PREFIXES = {"mW": (("mW", 1.0), ("uW", 1e3), ("nW", 1e6), ("pW", 1e9)), "V": (("V", 1.0), ("mV", 1e3), ("uV", 1e6))}


def _moved(found: Morning) -> list[str]:
    """Return what stands or is set otherwise, and how it comes back."""
    rows = []
    for one in found.moved:
        who = "by hand or by itself" if one.by_hand else "by a run"
        rows += wrap(f"{one.change.component} {one.change.text} ({who}).", "  ")
    backs = {one.repair: None for one in found.moved if one.by_hand}
    return [*rows, *(row for back in backs for row in wrap(f"Repair: {back}.", "  "))]


def _suspects(found: Morning) -> list[str]:
    """Return what happened: of each cause who may be it, and its repair."""
    lines, whole = list[str](), len(found.causes) > 1
    for n, group in enumerate(found.causes):
        if group[0].kind == _POSSIBLE:
            parts = listed([s.part for s in group], len(group))
            lines += wrap(f"The readings are not explained; one or several of: {parts}.", "  ")
            lines += wrap(_unexplained(found), "  ")
        else:
            lines += suspects.lines(group, SHOWN)
        if whole:
            lines += wrap(f"Repair: {found.repairs[n]}.", _INDENT)
    unexplained = next((s.probability for s in found.suspects if s.kind == "something else"), 0.0)
    if found.unexplained and all(group[0].kind != _POSSIBLE for group in found.causes):
        lines += wrap(_unexplained(found), "  ")
    elif not found.unexplained and found.suspects and (unexplained > SURE or (not lines and not found.moved)):
        quiet = sum(s.probability for s in found.suspects if s.kind == "nothing unusual")
        calm, more = "All that was read is as usual.", "What is left, no change of known parts explains."
        lines.append(f"  {calm if quiet >= SURE else more}")
    if found.blind:
        lines += wrap(
            f"Not judged: {listed(found.blind, MANY)}; no reading that could be compared tells of them.", "  "
        )
    shortest = found.repair and not whole and not (found.moved and not found.causes)
    return [*lines, *([f"Shortest repair: {found.repair}."] if shortest else [])]


def _unexplained(found: Morning) -> str:
    """Return what the causes leave of which readings."""
    left = {r.name: abs(r.left or 0.0) for r in found.readings}
    names = sorted(found.unexplained, key=lambda name: -left[name])
    parts = [f"{min(MUCH, left[name]):.0f} σ of {name}" for name in names[:MANY]]
    more = len(names) - len(parts)
    whole = listed(parts) + (f" and of {more} more readings" if more > 0 else "")
    if not found.causes:
        return f"No change of known parts explains {whole}."
    if any(group[0].kind == _POSSIBLE for group in found.causes):
        return f"The likeliest combination of causes leaves {whole} unexplained."
    these = "These causes leave" if len(found.causes) > 1 else "This cause leaves"
    return f"{these} {whole} unexplained; something else changed as well."


def said(one: Suspect) -> str:
    """Return what probably happened, with its size: `zero of angle, by 0.50 ± 0.01 deg`."""
    sizes = []
    for what, size in one.size.items():
        sigma, unit = one.sigma[what], one.units[what]
        if what in _SHARES:
            change = math.exp(-size if what == "loss" else size) - 1
            of = "" if what == "focal" else " of its light"
            sizes.append(f"{_with(100 * change, 100 * sigma * (1 + change))} %{of}")
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
    """Return schema `pico.morning/v1`: `reference` (when, empty where none), `age` of it [s], `unusual`,
    `readings`, `moved`, `causes` (of each the suspects, the likeliest first) with their `repairs`, `suspects` by
    probability (of those in each other's `like` only the sum rests on readings, how it is shared is the prior),
    `blind`, `unexplained`, `repair`, `lacks`."""
    return {"schema": "pico.morning/v1", **as_json(found)}
