"""Random histories of a small lab, and who changed each leaf by a reference: from whole states, one leaf at a time.

The reference knows the values, never the text. The text says them in one of many ways: units, layouts, files, comments.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from hypothesis import strategies as st

PARTS = ("a", "b", "c")
POSES = ((10.0, 20.0, 0.0), (12.5, 20.0, 30.0))
Place = tuple[float, float, float] | str | None


@dataclass(frozen=True)
class Component:
    """What a state says of a component, and how it is written: in which file, in which style, with which comment."""

    place: Place  # None: the state does not name it
    angle: float | None
    file: int
    style: int
    comment: int


@dataclass(frozen=True)
class Version:
    parents: tuple[int, ...]
    components: dict[str, Component]
    homes: dict[str, str]

    def value(self, at: tuple[str, str]) -> Any:
        """Return the value of a leaf, None where there is none."""
        component = self.components[at[0]]
        if at[1] == "pose":
            return component.place or self.homes.get(at[0])
        return component.angle if component.place else None

    def files(self) -> dict[str, bytes]:
        texts: dict[str, str] = {}
        for name, component in sorted(self.components.items()):
            if component.place:
                path = f"state/f{component.file}.yaml"
                text = texts.get(path, "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: t}\ncomponents:\n")
                texts[path] = text + written(name, component)
        at = {name: f", home: {self.homes[name]}" if name in self.homes else "" for name in PARTS}
        parts = "".join(f"  {name}: {{type: linear_polarizer{home}}}\n" for name, home in at.items())
        lab = f"apiVersion: pico/v1\nkind: Lab\nmetadata: {{name: t}}\ninventory:\n{parts}"
        return {path: text.encode() for path, text in texts.items()} | {"lab.yaml": lab.encode()}


def written(name: str, component: Component) -> str:
    """Return a component as YAML."""
    place, angle, style = component.place, component.angle, component.style
    comment = ("", "  # moved by hand", "\n    # a line of its own")[component.comment]
    if isinstance(place, str):
        where = f"slot: {place}" if style < 2 else f'slot: "{place}"'
    elif style == 0:
        where = f"pose:\n      x: {place[0]}{comment}\n      y: {place[1]:g}\n      yaw: {place[2]:g}"
    elif style == 1:
        where = f"pose: {{yaw: {place[2]:g} deg, x: {place[0] / 10:g} cm, y: {place[1]:g} mm}}{comment}"
    else:
        where = f"pose: {{x: {place[0]:g}, y: {place[1]:g}{f', yaw: {place[2]:g}' if place[2] else ''}}}"
    if style == 3 and "\n" not in where:
        turned = "" if angle is None else f", angle: {angle:g}"
        return f"  {name}: {{{where.removesuffix(comment)}{turned}}}\n"
    turned = "" if angle is None else f"    angle: {(f'{angle:g}', f'{angle:.2f}', f'{angle:g} deg', angle)[style]}\n"
    return f"  {name}:\n    {where}\n{turned}"


components = st.builds(
    Component,
    place=st.sampled_from([*POSES, "s1", "s2", None]),
    angle=st.sampled_from([None, 1.0, 90.0]),
    file=st.integers(0, 2),
    style=st.integers(0, 3),
    comment=st.integers(0, 2),
)
homes = st.dictionaries(st.sampled_from(PARTS[:2]), st.sampled_from(["s1", "h1"]), max_size=2)


@st.composite
def histories(draw: st.DrawFn, most: int = 14) -> list[Version]:
    """A history with branches and merges, criss-cross ones and several roots included; parents come first."""
    versions = [Version((), {name: draw(components) for name in PARTS}, draw(homes))]
    for number in range(1, draw(st.integers(1, most))):
        recent = st.integers(max(0, number - 4), number - 1)
        parents = tuple(draw(st.lists(recent, min_size=1, max_size=3, unique=True)))
        if draw(st.integers(0, 15)) == 0:
            parents = ()
        versions.append(draw(_following(parents, versions)))
    return versions


@st.composite
def _following(draw: st.DrawFn, parents: tuple[int, ...], versions: Sequence[Version]) -> Version:
    sides = [versions[p] for p in parents] or [versions[0]]
    chosen = {name: draw(st.sampled_from(sides)).components[name] for name in PARTS}
    for name in draw(st.lists(st.sampled_from(PARTS), max_size=2)):
        chosen[name] = draw(components)
    lab = draw(homes) if draw(st.integers(0, 9)) == 0 else draw(st.sampled_from(sides)).homes
    return Version(parents, chosen, lab)


def truth(versions: Sequence[Version], last: int) -> dict[tuple[str, str], tuple[Any, int]]:
    """Return value and commit of every leaf of a version: the obvious way, from whole states, back one by one."""
    found = {}
    for at in ((name, tunable) for name in PARTS for tunable in ("pose", "angle")):
        value = versions[last].value(at)
        if value is not None:
            found[at] = (value, _origin(versions, last, at))
    return found


def _origin(versions: Sequence[Version], number: int, at: tuple[str, str]) -> int:
    value = versions[number].value(at)
    for parent in versions[number].parents:
        if versions[parent].value(at) == value:
            return _origin(versions, parent, at)
    return number
