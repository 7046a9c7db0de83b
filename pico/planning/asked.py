"""What a ready-made goal is asked: the words of a user, and what stands on the way of the light to the parts that they
name. Whatever is missing is refused by name."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from pico.diagnostics import PicoError, did_you_mean, error
from pico.model.goal import Goal
from pico.model.observation import Observation
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.vocabulary import numbers_of
from pico.optics.axis import Axis, beams
from pico.planning.nominal_bench import STEERS, straight

Bounds = Mapping[str, tuple[float, float]]
LIGHT = ("power", "voltage")
"""Numbers that tell how much light there is."""


@dataclass(frozen=True)
class Ready:
    """A goal that was made, by the name it goes by, and goals that are sought `first` where it is dark. `aim`: where
    its tunables are likely to be right, by the nominal way of the light."""

    name: str
    goal: Goal
    first: tuple[tuple[str, Goal], ...] = ()
    aim: Mapping[str, float] | None = None

    def mapped(self, to: Callable[[Goal, Sequence[Goal]], Goal]) -> Ready:
        """Return it with each goal as `to` makes it of that and of those that come before it."""
        first = tuple((label, to(goal, ())) for label, goal in self.first)
        return replace(self, goal=to(self.goal, [goal for _, goal in first]), first=first)


@dataclass(frozen=True)
class Asked:
    """A ready-made goal as it is asked for: `what`, and the words behind it."""

    setup: Setup
    seen: Observation
    what: str
    words: tuple[str, ...]

    @property
    def name(self) -> str:
        """What the goal goes by: all that was said."""
        return " ".join((self.what, *self.words))

    @cached_property
    def poses(self) -> Mapping[str, Pose]:
        """Where parts of the inventory stand."""
        return {n: p.pose for n, p in self.seen.components.items()
                if p.presence == "seen" and p.pose is not None and n in self.setup.lab.inventory}  # fmt: skip

    @cached_property
    def values(self) -> Mapping[str, Mapping[str, Any]]:
        """The tunables as they are known, irises and shutters open."""
        kept = self.seen.known_values
        return {n: {k: v for k, v in own.items() if k not in ("opening", "shutter")} for n, own in kept.items()}

    @cached_property
    def axes(self) -> tuple[Axis, ...]:
        """The beams of all sources: as mirrors are turned, then as they would be if none were, where light is lost."""
        ways = (self.values, straight(self.values))
        return tuple(axis for values in ways for axis in beams(self.setup, self.poses, values))

    def look(self, name: str) -> str:
        """Return a name for a look that no component has."""
        while name in self.setup.lab.inventory or name in self.setup.lab.cameras:
            name = f"at_{name}"
        return name

    def refused(self, text: str, hint: str) -> PicoError:
        """Return the refusal of this goal."""
        return PicoError(error("goal", f"`{self.what}`: {text}", hint=hint))

    def part(self, word: str) -> str:
        """Return a component by name; raises PicoError where there is none."""
        if word not in self.setup.lab.inventory:
            hint = did_you_mean(word[:40], self.setup.lab.inventory) or "`pico catalog parts` lists them"
            raise PicoError(error("goal", f"there is no component `{word[:40]}`", hint=hint))
        return word

    def element(self, component: str) -> str:
        """Return what a component is to light."""
        return self.setup.type_of(component).optics.element

    def has(self, component: str, *tunables: str) -> bool:
        """Return whether a component has all of these tunables."""
        return set(tunables) <= self.setup.type_of(component).tunables.keys()

    def ways(self, component: str) -> list[list[str]]:
        """Return the ways of light from a source to a component, each once: what it meets, in order, it last."""
        found = [[m.component for m in way] for axis in self.axes for way in axis.ways(component)]
        return [way for n, way in enumerate(found) if way not in found[:n]]

    def way(self, component: str) -> list[str]:
        """Return the first way of light to a component; raises PicoError where none comes there."""
        found = self.ways(component)
        if not found:
            hint = "`pico beam` shows where it ends"
            raise self.refused(f"no beam comes to {component} as the bench stands", hint)
        return found[0]

    def behind(self, component: str) -> list[str]:
        """Return the detectors that light reaches through a component."""
        return [d for d in self.detectors if any(component in way[:-1] for way in self.ways(d))]

    @cached_property
    def detectors(self) -> list[str]:
        """What of the bench measures light, by name."""
        return [n for n in sorted(self.poses) if self.element(n) == "detector"]

    def light_of(self, detector: str) -> str:
        """Return the number by which a detector tells how much light there is; raises PicoError where it tells none."""
        numbers = numbers_of(self.setup, self.part(detector))
        if (found := next((n for n in LIGHT if n in numbers), None)) is None:
            raise self.refused(f"{detector} measures no power", "a power meter, a photodiode, a camera")
        return f"{detector}.{found}"

    def meter_behind(self, component: str) -> str:
        """Return the detector behind a component that tells best how much light comes through; raises PicoError where
        there is none."""
        found = [d for d in self.behind(component) if {*LIGHT} & numbers_of(self.setup, d).keys()]
        # a camera can't tell how much of a spot there is whose edge an aperture cut, where nobody knows its shape
        best = min(found, key=lambda d: ("image" in self.setup.measurables_of(d), self._takes_a_mode(d)), default=None)
        if best is None:
            text = f"nothing behind {component} measures light"
            raise self.refused(text, "a power meter or a photodiode there, or behind a splitter")
        return best

    def _takes_a_mode(self, detector: str) -> bool:
        return "mode_radius" in self.setup.type_of(detector).parameters

    def camera(self, word: str, number: str = "centroid.x") -> str:
        """Return a camera by name; raises PicoError for what does not measure a number of spots."""
        if number not in numbers_of(self.setup, self.part(word)):
            what = number.partition(".")[0]
            raise self.refused(f"{word} does not measure a {what}", "a camera does")
        return word

    def bounds(self, component: str, *tunables: str) -> Bounds:
        """Return tunables of a component with their whole ranges; raises PicoError for one that has none."""
        return dict(self._bounds(component, tunables))

    def _bounds(self, component: str, tunables: Sequence[str]) -> Iterator[tuple[str, tuple[float, float]]]:
        for name in tunables:
            kind = self.setup.type_of(component).tunables[name]
            if kind.range is None and kind.period is None:
                text = f"{component}.{name} has no range, within which it could be searched"
                raise PicoError(error("goal", text, hint="a goal in `lab.yaml` says its own bounds"))
            half = (kind.period or 0.0) / 2
            yield f"{component}.{name}", kind.range or (-half, half)

    def _steers(self, component: str) -> bool:
        """Return whether motors, and no person, tip and tilt a component."""
        kinds = self.setup.type_of(component).tunables
        return self.has(component, *STEERS) and all(kinds[one].mover != "person" for one in STEERS)

    def mirrors_before(self, component: str, many: int) -> list[str]:
        """Return the last mirrors before a component that motors tip and tilt; raises PicoError where there are
        fewer."""
        way = self.way(component)[:-1]
        found = list(dict.fromkeys(n for n in way if n and self._steers(n)))[-many:]
        if len(found) < many:
            only = f"only {found[0]} is" if found else "there is none"
            mirrors = "two mirrors" if many == 2 else "a mirror"
            text = f"it takes {mirrors} with motors for tip and tilt before {component}, and {only}"
            raise self.refused(text, "`pico catalog show mirror_tip_tilt`; or name what else is to be tuned")
        return found
