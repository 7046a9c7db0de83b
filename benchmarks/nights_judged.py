"""What is wrong of a morning of `nights.py`: its answer, as `pico morning --json` and `pico morning` print it, against
what truly happened."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from nights_alike import alike
from nights_causes import KINDS, Happening, Night, happen
from nights_table import Evening, name_of, off

if TYPE_CHECKING:
    from pico.backends.sim.world import World

SHOWN, SURE = 0.05, 0.9
"""Probabilities in its group: of a suspect that is listed, and of one that is named."""
DIFFERS = 6.0
"""By how many sigma a reading must have changed to have to be listed."""
FITS = 4.0
"""Sigma within which a set of causes explains a reading."""
_MOVES = ("moved", "turned", "zero of tip", "zero of tilt")


@dataclass(frozen=True)
class Group:
    """One cause as a morning tells it: the likeliest part and kind, its share, and all parts that it lists with it."""

    part: str
    kind: str
    share: float
    parts: tuple[str, ...]
    kinds: frozenset[tuple[str, str]]

    @property
    def sure(self) -> bool:
        """Whether it names one part."""
        return len(self.parts) == 1 or self.share >= SURE


@dataclass
class Judged:
    """A night with what its morning said. `wrong`: what breaks the promise, each as its sort and a text; `groups`: of
    causes, `of`: the group of each hidden cause that has one; `floor`: of how many of its parts the simulator finds
    that no reading can tell them apart."""

    night: Night
    groups: list[Group] = field(default_factory=list)
    moved: list[str] = field(default_factory=list)
    of: dict[str, Group] = field(default_factory=dict)
    floor: dict[str, int] = field(default_factory=dict)
    wrong: list[tuple[str, str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)

    def named(self, part: str) -> bool:
        """Return whether a morning names the part of a hidden cause, and not only lists it."""
        return part in self.of and self.of[part].sure and self.of[part].part == part

    def kind_right(self, one: Happening) -> bool:
        """Return whether the group of a cause also says what befell its part."""
        return any((one.part, name) in self.of[one.part].kinds for name in KINDS[one.kind].names)


def groups_of(data: Mapping[str, Any]) -> list[Group]:
    """Return the causes that a morning tells, from its JSON."""
    found = []
    for group in data["causes"]:
        shares: dict[str, float] = {}
        for s in group:
            shares[s["part"]] = shares.get(s["part"], 0.0) + s["probability"]
        top = max(group, key=lambda s: s["probability"])
        listed = [s for s in group if s["probability"] >= SHOWN or s is top]
        parts = dict.fromkeys([s["part"] for s in listed])
        parts |= dict.fromkeys(p for s in listed for p in s.get("like", ()))
        kinds = frozenset((s["part"], s["kind"]) for s in listed)
        found.append(Group(top["part"], top["kind"], shares[top["part"]], tuple(parts), kinds))
    return found


def judge(bench: Evening, night: Night, data: Mapping[str, Any], text: str) -> Judged:
    """Return a night judged by the JSON and the text of its morning."""
    found = Judged(night, groups_of(data), [m["change"]["component"] for m in data.get("moved", ())])
    _causes(bench, found, data)
    found.wrong += [("unlisted", w) for w in _unlisted(bench, night, data, text)]
    found.wrong += [("text", w) for w in _untold(found, text)]
    if found.wrong and (fit := _fit(bench, night, data)) is not None:
        fits = "explain" if fit < FITS else "do not explain"
        found.notes.append(
            f"the causes that it tells {fits} the readings in the simulator: off by {fit:.1f} sigma at most"
        )
    return found


def _causes(bench: Evening, found: Judged, data: Mapping[str, Any]) -> None:
    night, taken = found.night, list[Group]()
    for one in night.moved:
        if one.part not in found.moved:
            found.wrong.append(("missed", f"{one.kind} ({one.part}) is not among what moved"))
    for part in sorted(set(found.moved) - {c.part for c in night.moved}):
        found.wrong.append(("false", f"{part} did not move"))
    for one, group in _matched(night.hidden, found.groups):
        taken.append(group)
        found.of[one.part] = group
        listed = () if found.named(one.part) else group.parts
        found.floor[one.part] = 1 + len(alike(bench, night, one, listed))
    for one in night.hidden:
        if one.part not in found.of:
            shown = next(f"{c:.0f}" for c, o in zip(night.clear, night.causes, strict=True) if o is one)
            found.wrong.append(
                (
                    "missed",
                    f"{one.kind} ({' '.join(one.words[2:])}) is neither named nor listed; it shows by {shown} sigma",
                )
            )
    bumped = {c.part for c in night.moved}
    for group in (g for g in found.groups if g not in taken):
        if group.part in bumped and group.kind.startswith(_MOVES):
            found.notes.append(f"{group.part}: {group.kind} is told beside its bump")
        else:
            others = ", ".join(p for p in group.parts if p != group.part)
            found.wrong.append(
                ("false", f"{group.part}: {group.kind} did not happen{f', nor to {others}' if others else ''}")
            )
    if not night.causes and not found.wrong and data.get("unusual"):
        found.wrong.append(("false", "something is said to have happened"))


def _matched(hidden: Sequence[Happening], groups: Sequence[Group]) -> list[tuple[Happening, Group]]:
    """Return each hidden cause with a group of its own that has its part, as many as can be, the likeliest first."""
    best: list[tuple[Happening, Group]] = []

    def score(pairs: Sequence[tuple[Happening, Group]]) -> tuple[int, int, int]:
        kinds = sum(any((c.part, name) in g.kinds for name in KINDS[c.kind].names) for c, g in pairs)
        return len(pairs), sum(g.part == c.part for c, g in pairs), kinds

    def go(n: int, pairs: list[tuple[Happening, Group]]) -> None:
        nonlocal best
        if n == len(hidden):
            best = max(best, pairs, key=score)
            return
        go(n + 1, pairs)
        for group in groups:
            if hidden[n].part in group.parts and all(group is not g for _, g in pairs):
                go(n + 1, [*pairs, (hidden[n], group)])

    go(0, [])
    return best


def _unlisted(bench: Evening, night: Night, data: Mapping[str, Any], text: str) -> Iterator[str]:
    """Yield readings that truly changed by far, and are missing in the JSON or the text of a morning."""
    change = off(bench.readings(happen(bench, bench.world, night.causes)), bench.readings(bench.world))
    told = {r["name"]: r for r in data["readings"]}
    flat = " ".join(text.split())
    for quantity in bench.quantities:
        (shot, *more), name = quantity["shots"], quantity["name"]
        by = change.get(name_of(shot["address"], shot["at"], quantity["number"]), 0.0)
        if more or quantity["got"] is None or abs(by) < DIFFERS:
            continue
        row = told.get(name)
        compared = row is not None and None not in map(row.get, ("then", "now", "change"))
        if not compared and not (row or {}).get("unknown"):
            yield f"{name} changed by {by:+.1f} sigma, and the JSON does not compare it nor say why not"
        if not re.search(rf"(^|\W){re.escape(name)}\W", flat):
            yield f"{name} changed by {by:+.1f} sigma, and the text does not list it"


def _untold(found: Judged, text: str) -> Iterator[str]:
    """Yield parts that the JSON names and the text does not."""
    for part in dict.fromkeys([*found.moved, *(g.part for g in found.groups)]):
        if not re.search(rf"(^|\W){re.escape(part)}\W", text):
            yield f"the text does not name {part}"


def _fit(bench: Evening, night: Night, data: Mapping[str, Any]) -> float | None:
    """Return by how many sigma at most the readings differ from those of a table on which what the morning tells has
    happened, with the sizes that fit best; None where it tells of nothing hidden."""
    import numpy as np

    from pico.diagnostics import PicoError

    heads = [max(group, key=lambda s: s["probability"]) for group in data["causes"]]
    ways = [(s["part"], what, v) for s in heads for what, v in s["size"].items()]
    if not ways or len({s["part"] for s in heads}) < len(heads):
        return None
    start = happen(bench, bench.world, night.moved)
    true = bench.readings(happen(bench, bench.world, night.causes))
    units = np.array([max(0.03 * abs(v), 1e-4) for _, _, v in ways])

    def left(size: Any) -> Any:
        there = bench.readings(_supposed(start, [(p, w, v) for (p, w, _), v in zip(ways, size, strict=True)]))
        change = off(there, true)
        return np.array([change.get(key, 1e3) for key in true])

    try:
        size = np.array([v for *_, v in ways])
        now = left(size)
        for _ in range(4):
            slopes = np.array([(left(size + u * np.eye(len(size))[n]) - now) / u for n, u in enumerate(units)]).T
            step, *_ = np.linalg.lstsq(slopes * units, -now, rcond=1e-4)
            tries = [size + f * step * units for f in (1.0, 0.3)]
            ends = [left(s) for s in tries]
            best = min((0, 1), key=lambda n: float(ends[n] @ ends[n]))
            if ends[best] @ ends[best] >= now @ now:
                break
            size, now = tries[best], ends[best]
    except (PicoError, ValueError, np.linalg.LinAlgError):
        return None
    return float(np.abs(now).max())


def _supposed(world: World, ways: Sequence[tuple[str, str, float]]) -> World:
    """Return a table after changes by the ways and in the units in which a morning tells them."""
    from pico.optics.unseen import SEEN

    for part, what, size in ways:
        body = world.components[part]
        was = body.unseen or SEEN
        if what.startswith("zero:"):
            tunable = what.removeprefix("zero:")
            world = world.with_body(part, offsets={**body.offsets, tunable: body.offsets.get(tunable, 0.0) + size})
        else:
            world = world.with_body(part, unseen=replace(was, **{what: _field(was, what, size)}))
    return world


def _field(was: Any, what: str, size: float) -> Any:
    """Return what a field of `Unseen` becomes."""
    if what == "loss":
        return 1 - math.exp(-size)
    if what in ("gain", "power", "focal"):
        return math.exp(size)
    if what == "leak":
        return min(0.5, max(0.0, math.exp(size) - 1) / 1e5)
    return getattr(was, what) + size


def reference_changed(before: Mapping[str, bytes], after: Mapping[str, bytes]) -> Iterator[tuple[str, str]]:
    """Yield the files of references that are not as they were."""
    for path in sorted(before.keys() | after.keys()):
        if before.get(path) != after.get(path):
            yield "reference", f"{path} was rewritten without --accept"


MEDIAN, SHARE, FEW = 4, 0.3, 8
"""What is useful: the median of the parts in a group, and the share of causes that are in a group only, of at least
FEW."""


def useless(all_: Sequence[Judged]) -> Iterator[tuple[str, str]]:
    """Yield what of many nights makes the answers of little use, though each is true: groups that are too large, and
    too many causes that are in a group only. Parts that no reading can tell apart are not held against them."""
    import statistics

    told = [(j.floor[part], group, j.named(part)) for j in all_ for part, group in j.of.items()]
    groups = [(floor, len(g.parts)) for floor, g, named in told if not named]
    over = [size - max(0, floor - 1) for floor, size in groups]
    if over and statistics.median(over) > MEDIAN:
        yield "useless", f"half of the groups list more than {MEDIAN} parts beside those that look alike"
    alone = sum(floor == 1 for floor, _ in groups)
    if len(told) >= FEW and alone > SHARE * len(told):
        text = (
            f"{alone} of {len(told)} hidden causes are in a group only, though readings tell their part from the others"
        )
        yield "useless", f"{text}; at most {100 * SHARE:.0f} % are useful"
    for floor, group, _ in told:
        if len(group.parts) > floor + 2 * MEDIAN:
            yield "useless", f"the group of {group.part} lists {len(group.parts)} parts; {floor} of them look alike"
