"""Random manifests and random edits of two sides, each with what must come out of their merge."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass, field

import yaml

from pico.history.merge.markers import view

VALUES = ("angle", "exposure", "tip", "tilt")
COMMENTS = ("# beam walks here", "# glued", "# 2 a.m.", "# x: 3, not a value", "# ± 0.1 mm")
Leaf = tuple[str, str]
"""A component, and one of its tunables: `angle`, `pose.x`."""


@dataclass
class Part:
    """A component as the case writes it: comments above it, values, comments behind values."""

    values: dict[str, float | str]
    above: list[str] = field(default_factory=list)
    behind: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Case:
    """Three versions; the values of the merged state, leaves that must conflict, comments that must survive."""

    base: str
    ours: str
    theirs: str
    expected: dict[Leaf, float | str]
    conflicting: frozenset[Leaf]
    comments: tuple[str, ...]


State = dict[str, Part]


def text(state: State, flow: bool) -> str:
    """Write a state as a person would; `flow`: each pose on one line."""
    lines = ["apiVersion: pico/v1", "kind: LabState", "metadata: {lab: bench}", "components:"]
    for name in sorted(state):
        part = state[name]
        lines += [*(f"  {c}" for c in part.above), f"  {name}:"]
        pose = {k.partition(".")[2]: v for k, v in part.values.items() if k.startswith("pose.")}
        if "slot" in part.values:
            lines.append(f"    slot: {part.values['slot']}")
        elif flow:
            lines.append("    pose: {" + ", ".join(f"{k}: {v}" for k, v in pose.items()) + "}")
        else:
            lines += ["    pose:", *(f"      {k}: {v}{part.behind.get('pose.' + k, '')}" for k, v in pose.items())]
        lines += [f"    {k}: {part.values[k]}{part.behind.get(k, '')}" for k in VALUES if k in part.values]
    return "\n".join(lines) + "\n"


def case(seed: int) -> Case:
    """Return the case of a seed: up to 12 components, up to 8 edits a side, some of the same tunable."""
    rng = random.Random(seed)
    base = {f"c{i:02d}": random_part(rng, i) for i in range(rng.randint(1, 12))}
    flow = rng.random() < 0.3
    ours, theirs = copied(base), copied(base)
    leaves = [(n, k) for n in sorted(base) for k in base[n].values]
    rng.shuffle(leaves)
    conflicting: set[Leaf] = set()
    expected = {(n, k): base[n].values[k] for n, k in leaves}
    for n, k in leaves[: rng.randint(0, min(16, len(leaves)))]:
        old = expected[n, k]
        kind = rng.random()
        if kind < 0.12:
            mine, other = other_value(rng, old, 1), other_value(rng, old, 2)
            ours[n].values[k], theirs[n].values[k] = mine, other
            conflicting.add((n, k))
        elif kind < 0.2:
            ours[n].values[k] = theirs[n].values[k] = expected[n, k] = other_value(rng, old, 1)
        else:
            side = ours if rng.random() < 0.5 else theirs
            side[n].values[k] = expected[n, k] = other_value(rng, old, 1)
    comments = _remark(rng, base, ours, theirs, flow)
    for side, word in ((ours, "new_a"), (theirs, "new_b")):
        if rng.random() < 0.3:
            name = f"{rng.choice(sorted(base))}_{word}"
            side[name] = random_part(rng, 40 + len(word))
            expected |= {(name, k): v for k, v in side[name].values.items()}
        _add_value(rng, base, side, (ours, theirs), expected)
    if rng.random() < 0.2:
        _remove(rng, base, ours, theirs, expected)
    comments = tuple(c for c in comments if c in text(ours, flow) or c in text(theirs, flow))
    return Case(text(base, flow), text(ours, flow), text(theirs, flow), expected, frozenset(conflicting), comments)


def state_of(manifest: str) -> dict[Leaf, float | str]:
    """Return the values of a manifest."""
    found: dict[Leaf, float | str] = {}
    for name, part in yaml.safe_load(manifest)["components"].items():
        for key, value in part.items():
            found |= {(name, f"{key}.{k}"): v for k, v in value.items()} if key == "pose" else {(name, key): value}
    return found


def faults(c: Case, merged: str) -> list[str]:
    """Return what is wrong with a merge of a case: a value lost or made up, a conflict too many or too few."""
    found = []
    for side, text_of_side in (("ours", c.ours), ("theirs", c.theirs)):
        theirs = state_of(text_of_side)
        if state_of(view(merged, side)) != c.expected | {leaf: theirs[leaf] for leaf in c.conflicting}:
            found.append(f"{side}: not the values expected")
    if ("<<<<<<<" in merged) != bool(c.conflicting):
        found.append("markers without a conflict, or none where there is one")
    return found + [f"lost: {comment}" for comment in c.comments if comment not in merged]


def losses(c: Case, merged: str) -> list[Leaf]:
    """Return the values that a side set and that a merge lost in silence: which are not in their place, or, where there
    are markers, nowhere.

    Git's own merge may leave a component twice, which every command refuses, and values between its markers beside
    another component, where a person finds them.
    """
    was, lost, loud = state_of(c.base), [], "<<<<<<<" in merged
    for side, text_of_side in (("ours", c.ours), ("theirs", c.theirs)):
        seen = set(_stated(view(merged, side)))
        edited = {(leaf, value) for leaf, value in state_of(text_of_side).items() if value != was.get(leaf)}
        lost += [(n, k) for (n, k), v in edited - seen if not (loud and f"{k.rpartition('.')[2]}: {v}" in merged)]
    return sorted(set(lost))


def _stated(manifest: str) -> Iterator[tuple[Leaf, float | str]]:
    """Yield the values of a manifest, of a component that it holds twice both."""
    top = yaml.compose(manifest)
    parts = next(node for key, node in top.value if key.value == "components")
    for name, part in parts.value:
        for key, node in part.value:
            inner = node.value if isinstance(node, yaml.MappingNode) else ()
            yield from (((name.value, f"{key.value}.{k.value}"), yaml.safe_load(v.value)) for k, v in inner)
            if not inner:
                yield (name.value, key.value), yaml.safe_load(node.value)


def random_part(rng: random.Random, i: int) -> Part:
    place: dict[str, float | str] = (
        {"slot": f"storage/a{i}"} if rng.random() < 0.3 else {"pose.x": 40 * i, "pose.y": 300, "pose.yaw": 0.0}
    )
    part = Part(place | {k: rng.randint(0, 900) / 10 for k in VALUES if rng.random() < 0.5})
    if rng.random() < 0.3:
        part.above.append(rng.choice(COMMENTS) + f" {i}")
    return part


def copied(state: State) -> State:
    return {n: Part(dict(p.values), list(p.above), dict(p.behind)) for n, p in state.items()}


def other_value(rng: random.Random, old: float | str, step: int) -> float | str:
    """Return another value; of another `step`, a different one."""
    if isinstance(old, str):
        return f"storage/{'xyz'[step]}{rng.randint(1, 99)}"
    return round(old + step / 10 + rng.randint(1, 400), 3)


def _remark(rng: random.Random, base: State, ours: State, theirs: State, flow: bool) -> tuple[str, ...]:
    """Add comments to either side, above components and behind values, even both at one place; return them."""
    made = []
    for side, word in ((ours, "ours"), (theirs, "theirs")):
        for number in range(rng.randint(0, 3)):
            name = rng.choice(sorted(base))
            comment = f"{rng.choice(COMMENTS)} by {word} {number}"
            keys = [k for k in side[name].values if k in VALUES or (k != "slot" and not flow)]
            if keys and rng.random() < 0.5:
                key = rng.choice(keys)
                if side[name].behind.get(key):
                    continue
                side[name].behind[key] = f"  {comment}"
            else:
                side[name].above.append(comment)
            made.append(comment)
    return tuple(made)


def _add_value(
    rng: random.Random, base: State, side: State, both: tuple[State, State], expected: dict[Leaf, float | str]
) -> None:
    """Let a side give a component a tunable that nobody has given it."""
    name = rng.choice(sorted(base))
    free = [k for k in VALUES if all(k not in state[name].values for state in both)]
    if free and rng.random() < 0.5:
        key = rng.choice(free)
        side[name].values[key] = expected[name, key] = rng.randint(0, 99)


def _remove(rng: random.Random, base: State, ours: State, theirs: State, expected: dict[Leaf, float | str]) -> None:
    """Let a side take out a component that nobody touched."""
    same = [n for n in sorted(base) if base[n] == ours[n] == theirs[n]]
    if same and len(base) > 1:
        name = rng.choice(same)
        del rng.choice((ours, theirs))[name]
        for key in base[name].values:
            del expected[name, key]
