"""Random labs of several files, edited on two branches: parts change files, files are split, renamed, taken away."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import yaml
from merging_cases import VALUES, Part, State, copied, other_value, random_part, text

TYPE = """---
apiVersion: pico/v1
kind: ComponentType
metadata: {name: thing, title: a thing}
pose: {tolerance: {position: 1, yaw: 1}}
tunables:
  angle: {unit: mm, range: [0, 2000], tolerance: 0.1, mover: motor, restore: {kind: setpoint}}
  exposure: {unit: mm, range: [0, 2000], tolerance: 0.1, mover: motor, restore: {kind: setpoint}}
  tip: {unit: mm, range: [0, 2000], tolerance: 0.1, mover: motor, restore: {kind: setpoint}}
  tilt: {unit: mm, range: [0, 2000], tolerance: 0.1, mover: motor, restore: {kind: setpoint}}
primitives: [move, stow, set]
geometry:
  footprint: {box: [10, 10]}
  height: 100
  mass: 0.1
  bodies: [{name: body, shape: box, size: [10, 10, 100], at: [0, 0, 50]}]
  grasp: {height: 50, width: 10, yaws: [0, 90]}
seating: free
repeatability: {position: 0.1, yaw: 0.05}
"""


def _lab() -> str:
    """Write a bench that has every part and every slot that a case may name."""
    names = [f"c{i:02d}{of}" for i in range(30) for of in ("", "_o", "_t")] + ["added"]
    slots = [f"a{i}" for i in range(70)] + [f"{x}{i}" for x in "xyz" for i in range(100)]
    slots += [f"{side}{i}" for side in ("ours", "theirs") for i in range(8)] + [f"home{i}" for i in range(len(names))]
    lines = ["apiVersion: pico/v1", "kind: Lab", "metadata: {name: bench, title: a bench}"]
    lines += ["table: {size: [3000, 3000], beam_height: 70}"]
    lines += ["robots: {arm1: {model: xarm7, mount: {x: 1500, y: 1500, yaw: 0}}}"]
    lines += [
        "slots:",
        *(f"  storage/{s}: {{x: {100 * (i % 29) + 50}, y: {100 * (i // 29) + 50}}}" for i, s in enumerate(slots)),
    ]
    lines += ["inventory:", *(f"  {n}: {{type: thing, home: storage/home{i}}}" for i, n in enumerate(names))]
    return "\n".join(lines) + "\n" + TYPE


LAB = _lab()
Files = dict[str, str]


@dataclass
class Side:
    """A lab as a branch has it: the components of each file, the comments above it, and what was written there."""

    files: dict[str, State]
    heads: dict[str, list[str]] = field(default_factory=dict)
    comments: list[str] = field(default_factory=list)
    remarked: set[str] = field(default_factory=set)

    def home(self, name: str) -> str | None:
        """Return the file that has a component."""
        return next((path for path, state in self.files.items() if name in state), None)

    def names(self) -> list[str]:
        return sorted(name for state in self.files.values() for name in state)

    def part(self, name: str) -> Part | None:
        return next((state[name] for state in self.files.values() if name in state), None)

    def written(self, flows: dict[str, bool]) -> Files:
        """Return the files as text; those without a component stay."""
        lines = {p: "".join(f"{line}\n" for line in self.heads.get(p, ())) for p in self.files}
        return {"lab.yaml": LAB} | {p: lines[p] + text(s, flows.get(p, False)) for p, s in self.files.items()}


@dataclass(frozen=True)
class Moved:
    """Three versions of a lab; the values that each component must have after a merge, None where it must be gone.

    `conflicting`: components that must conflict, `across` those of them that one side took out and the other moved;
    `open`: those that may (both sides moved it, each elsewhere), as may everything where `loose`: a comment was written
    where the other side took away what it stands at. `either`: those that may be gone instead of in conflict, for the
    file that they stood in was renamed. `comments` must survive.
    """

    base: Files
    ours: Files
    theirs: Files
    expected: dict[str, dict[str, Any]]
    conflicting: frozenset[str]
    across: frozenset[str]
    open: frozenset[str]
    either: frozenset[str]
    loose: bool
    comments: tuple[str, ...]

    @property
    def free(self) -> bool:
        """Whether nothing in it may conflict."""
        return not (self.conflicting or self.open or self.either or self.loose)


def moved_case(seed: int) -> Moved:
    """Return the case of a seed: two to four files, up to eight edits a side, mostly of different components."""
    rng = random.Random(seed)
    files: dict[str, State] = {}
    number = 0
    for i in range(rng.randint(2, 4)):
        state = files.setdefault(f"state/f{i}.yaml", {})
        for _ in range(rng.randint(1, 7)):
            state[f"c{number:02d}"] = random_part(rng, number)
            number += 1
    base = Side(files)
    ours, theirs = (Side({p: copied(s) for p, s in files.items()}) for _ in range(2))
    mine = {name for name in base.names() if rng.random() < 0.5}
    both = {name for name in base.names() if rng.random() < rng.choice((0.0, 0.0, 0.3))}
    for side, word, own in ((ours, "ours", mine | both), (theirs, "theirs", {*base.names()} - mine | both)):
        for step in range(rng.randint(1, 8)):
            names = sorted(own & {*side.names()})
            edit = rng.choices([e for e, _ in EDITS], [weight for _, weight in EDITS])[0]
            edit(rng, side, names, f"{word}{step}")
    flows = {p: rng.random() < 0.2 for side in (base, ours, theirs) for p in side.files}
    return _judged(base, ours, theirs, flows)


def _value(rng: random.Random, side: Side, names: list[str], word: str) -> None:
    part = side.part(rng.choice(names)) if names else None
    if part:
        key = rng.choice(sorted(part.values))
        part.values[key] = other_value(rng, part.values[key], 1 + (word[0] == "o"))


def _place(rng: random.Random, side: Side, names: list[str], word: str) -> None:
    part = side.part(rng.choice(names)) if names else None
    if part and "slot" not in part.values:
        part.values = {"slot": f"storage/{word}"} | {k: v for k, v in part.values.items() if k in VALUES}
        part.behind = {k: c for k, c in part.behind.items() if k in VALUES}


def _tunable(rng: random.Random, side: Side, names: list[str], word: str) -> None:
    part = side.part(rng.choice(names)) if names else None
    free = [k for k in VALUES if part and k not in part.values]
    if part and free:
        part.values[rng.choice(free)] = rng.randint(0, 99)


def _move(rng: random.Random, side: Side, names: list[str], word: str) -> None:
    for name in rng.sample(names, min(len(names), rng.randint(1, 3))):
        _to(side, name, rng.choice([*side.files, "state/new.yaml"]))


def _split(rng: random.Random, side: Side, names: list[str], word: str) -> None:
    """Move a stretch of a file, or all of it, into other files, and take it away where nothing is left in it."""
    old = rng.choice(sorted(side.files))
    there = sorted(side.files[old])
    at = rng.randint(0, len(there))
    for name in there[at:]:
        _to(side, name, f"{old.removesuffix('.yaml')}_{word[0]}.yaml")
    if rng.random() < 0.5 and len(side.files) > 1:
        for name in there[:at]:
            _to(side, name, rng.choice([p for p in side.files if p != old]))
    if not side.files[old] and rng.random() < 0.8 and len(side.files) > 1:
        del side.files[old]


def _rename(rng: random.Random, side: Side, names: list[str], word: str) -> None:
    old = rng.choice(sorted(side.files))
    new = f"state/{word}.yaml"
    side.files[new] = side.files.pop(old)
    if old in side.heads:
        side.heads[new] = side.heads.pop(old)


def _remove(rng: random.Random, side: Side, names: list[str], word: str) -> None:
    home = side.home(name := rng.choice(names)) if names else None
    if home and len(side.names()) > 1:
        del side.files[home][name]


def _add(rng: random.Random, side: Side, names: list[str], word: str) -> None:
    name = rng.choice(["added", f"c{rng.randint(0, 20):02d}_{word[0]}", f"c{rng.randint(0, 20):02d}_{word[0]}"])
    if side.home(name) is None:
        path = rng.choice([*side.files, "state/new.yaml"])
        side.files.setdefault(path, {})[name] = random_part(rng, rng.randint(20, 60))


def _comment(rng: random.Random, side: Side, names: list[str], word: str) -> None:
    name = rng.choice(names) if names else ""
    part = side.part(name)
    if part is None:
        return
    comment = f"# said by {word}"
    keys = [k for k in part.values if k in VALUES and k not in part.behind]
    if keys and rng.random() < 0.5:
        part.behind[rng.choice(keys)] = f"  {comment}"
    else:
        part.above.append(comment)
    side.comments.append(comment)
    side.remarked.add(name)


def _head(rng: random.Random, side: Side, names: list[str], word: str) -> None:
    path = rng.choice(sorted(side.files))
    side.heads.setdefault(path, []).append(f"# file of {word}")
    side.comments.append(f"# file of {word}")


Edit = Callable[[random.Random, Side, list[str], str], None]
EDITS: tuple[tuple[Edit, int], ...] = (
    (_value, 8), (_place, 1), (_tunable, 2), (_move, 4), (_split, 1), (_rename, 1), (_remove, 1), (_add, 2),
    (_comment, 3), (_head, 1),
)  # fmt: skip


def _to(side: Side, name: str, path: str) -> None:
    home = side.home(name)
    if home and home != path:
        side.files.setdefault(path, {})[name] = side.files[home].pop(name)


def _judged(base: Side, ours: Side, theirs: Side, flows: dict[str, bool]) -> Moved:
    expected: dict[str, dict[str, Any]] = {}
    conflicting, across, undecided, either = set(), set(), set(), set()
    loose = any(_taken_from(base, side, other) for side, other in ((ours, theirs), (theirs, ours)))
    for name in {*base.names(), *ours.names(), *theirs.names()}:
        was, mine, other = (_values(side, name) for side in (base, ours, theirs))
        homes = [side.home(name) for side in (base, ours, theirs)]
        values, wrong = _united(was, mine, other)
        if values is not None:
            expected[name] = values
        if None not in homes[1:] and len(set(homes)) == 3:
            (conflicting if wrong else undecided).add(name)
        elif homes[0] is not None and None in homes[1:] and len(set(homes)) == 3:
            moved = ours if homes[2] is None else theirs
            renamed = _renamed(base, moved).get(homes[0]) == moved.home(name)
            (conflicting if wrong else either if renamed else across).add(name)
        elif wrong:
            conflicting.add(name)
    comments = {c for side in (ours, theirs) for c in side.comments}
    written = [side.written(flows) for side in (base, ours, theirs)]
    there = {c for c in comments if any(c in text for files in written[1:] for text in files.values())}
    sets = (frozenset(s) for s in (conflicting | across, across, undecided, either))
    return Moved(written[0], written[1], written[2], expected, *sets, loose, tuple(sorted(there)))


def _values(side: Side, name: str) -> dict[str, Any] | None:
    part = side.part(name)
    return part.values if part else None


def _united(was: Any, mine: Any, other: Any) -> tuple[dict[str, Any] | None, bool]:
    """Return the values of a component after a merge, None where it is gone, and whether the sides disagree on it."""
    if other in (mine, was):
        return mine, False
    if mine == was:
        return other, False
    if mine is None or other is None:
        return mine or other, True
    if ("slot" in mine) == ("slot" in other):
        return _leafwise(was or {}, mine, other)
    places = [{k: v for k, v in (x or {}).items() if k not in VALUES} for x in (was, mine, other)]
    if places[0] not in places[1:]:
        return mine, True
    rest, wrong = _leafwise(*({k: v for k, v in (x or {}).items() if k in VALUES} for x in (was, mine, other)))
    return (places[2] if places[1] == places[0] else places[1]) | rest, wrong


def _leafwise(was: Any, mine: Any, other: Any) -> tuple[dict[str, Any], bool]:
    united = {}
    wrong = False
    for key in {*was, *mine, *other}:
        b, o, t = (values.get(key) for values in (was, mine, other))
        wrong |= len({b, o, t}) == 3
        united[key] = t if o == b else o
    return {k: v for k, v in united.items() if v is not None}, wrong


def _renamed(base: Side, side: Side) -> dict[str, str]:
    """Return the files that a side renamed: gone, and most of their components in one new file."""
    found = {}
    for old, state in base.files.items():
        if old not in side.files and state:
            home, times = Counter(side.home(name) for name in state).most_common(1)[0]
            if home and home not in base.files and 2 * times > len(state):
                found[old] = home
    return found


def _taken_from(base: Side, side: Side, other: Side) -> bool:
    """Whether one side wrote comments at what the other one took away."""
    renamed = _renamed(base, other)
    heads = {path for path in side.heads if path in base.files and path not in other.files and path not in renamed}
    return bool(heads) or any(other.part(name) is None for name in side.remarked)


def stated(files: Files) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield each component that files hold: its name, its file, its values."""
    for path, manifest in files.items():
        data = yaml.safe_load(manifest) if "kind: LabState" in manifest else {}
        for name, part in (data.get("components") or {}).items():
            values: dict[str, Any] = {}
            for key, value in part.items():
                values |= {f"{key}.{k}": v for k, v in value.items()} if key == "pose" else {key: value}
            yield name, path, values


def mistakes(c: Moved, merged: Files) -> list[str]:
    """Return what is wrong with files that came out of a merge without a conflict."""
    found = list(stated(merged))
    times = Counter(name for name, _, _ in found)
    wrong = [f"{name} is in {n} files" for name, n in times.items() if n > 1]
    wrong += [f"{name} is settled in silence" for name in sorted(c.conflicting)]
    values = {name: v for name, _, v in found}
    for name in sorted({*values, *c.expected} - c.conflicting - c.either):
        if values.get(name) != c.expected.get(name):
            wrong.append(f"{name} is {values.get(name)} instead of {c.expected.get(name)}")
    text = "".join(merged.values())
    return wrong + [f"lost: {comment}" for comment in c.comments if comment not in text]
