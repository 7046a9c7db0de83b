"""Labs of about thirty parts with a random history, in which one commit broke something. mm and deg."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

from pico.history.repository.repository import Repository
from pico.manifest.load import load_folder
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.reach import check_reach

AUTHOR, BEGIN = ("A Physicist", "physicist@localhost"), datetime(2026, 1, 5, 9, 0, tzinfo=UTC)
TYPES = (
    "plano_convex_100", "plano_convex_150", "plano_convex_200", "linear_polarizer", "half_wave_plate",
    "quarter_wave_plate", "mirror_tip_tilt", "beam_splitter_50_50", "iris", "neutral_density_filter",
)  # fmt: skip
ROOM = 92.0
"""Parts stand at least so far apart, so that nothing ever blocks another or its fingers."""
GROUP, STAY = 6, 12
"""Parts of a sub-assembly, and for how many commits on average it is worked on."""
GOLDEN = 0.618034
"""Seeds in a row plant their commits evenly over the history."""
LIMIT = 960.0
PROBE, EXPECT = "probe", f"probe.pose.x < {LIMIT:g}"
"""What every commit before the planted one keeps to, and none from it on."""
FIXED = """laser: {type: hene_laser, pose: {x: 1110, y: 800, yaw: 180}}
  diode: {type: photodiode, pose: {x: 1130, y: 640, yaw: 0}}
  cam_1: {type: beam_camera, pose: {x: 1130, y: 540, yaw: 0}}
  cam_2: {type: beam_camera, pose: {x: 60, y: 820, yaw: 0}}
  cam_3: {type: beam_camera, pose: {x: 1130, y: 60, yaw: 0}}
  cam_4: {type: photodiode, pose: {x: 1130, y: 160, yaw: 0}}"""

Place = str | Pose


@dataclass(frozen=True)
class State:
    """Where every part stands, and the angle of each that turns its optic."""

    places: Mapping[str, Place]
    angles: Mapping[str, float]


@dataclass
class Written:
    """A history in `root`: `good` and `bad` are its ends, `first_bad` the planted commit."""

    root: Path
    good: str
    bad: str
    first_bad: str
    commits: list[str] = field(default_factory=list)


Tip = tuple[str, State, bool]
"""The last commit of a branch, its state, and whether it is broken already."""


class Parts:
    """A lab on disk, and what its parts may do."""

    def __init__(
        self, folder: Path, seed: int, parts: int = 26, *, standing: int = 11, scattered: bool = False
    ) -> None:
        """`standing`: so many parts of the storage are in use at most. `scattered`: every commit moves parts from
        anywhere; else a sub-assembly is worked on for some commits, then another."""
        self.rng, self.standing, self.scattered = random.Random(seed), standing, scattered
        self._focus: list[str] = []
        self.repository = Repository.init(folder)
        self.slots = {f"store/{c}{r}": (110 + 90 * c, 130 + 90 * r) for c in range(5) for r in range(6)}
        near = {k: at for k, at in self.slots.items() if 300 < math.dist(at, (480, 760)) < 668}
        homes = dict(zip((f"c{n:02}" for n in range(parts - 1)), sorted(near), strict=False))
        self.names = sorted(homes)
        kinds = {name: TYPES[n % len(TYPES)] for n, name in enumerate(self.names)}
        self.lab = _lab(near, homes, kinds)
        (folder / "lab.yaml").write_text(self.lab)
        setup = load_folder(folder).setup
        assert setup is not None
        self.setup: Setup = setup
        self.homes = homes
        self.start = State({**homes, PROBE: Pose(LIMIT - 30, 470, 0)}, dict.fromkeys(self.turning, 0.0))

    @property
    def turning(self) -> list[str]:
        """The parts with a motorized angle."""
        return [n for n in self.names if "angle" in self.setup.type_of(n).tunables]

    def edited(self, state: State, only: Callable[[str], bool] = lambda _: True) -> State:
        """Return a state in which one to five parts are elsewhere or turned, as a day in a lab brings it."""
        count = self.rng.choices((1, 2, 3, 4, 5), (40, 25, 15, 12, 8))[0]
        places, angles = dict(state.places), dict(state.angles)
        for name in self._worked_on([n for n in self.names if only(n)], count):
            here = places[name]
            if name in self.turning and self.rng.random() < 0.25:
                angles[name] = float(self.rng.randrange(0, 360, 15))
            elif isinstance(here, str):
                out = sum(isinstance(p, Pose) for p in places.values())
                if out < self.standing:
                    places[name] = self._free(places, name) or here
            elif self.rng.random() < 0.25:
                places[name] = self.homes[name]
            else:
                places[name] = self._free(places, name, near=here if self.rng.random() < 0.7 else None) or here
        return State(places, angles)

    def _worked_on(self, names: list[str], count: int) -> list[str]:
        if self.scattered:
            return self.rng.sample(names, count)
        if not self._focus or self.rng.random() < 1 / STAY:
            self._focus = self.rng.sample(self.names, GROUP)
        own = [n for n in names if n in self._focus]
        inside = min(len(own), sum(self.rng.random() < 0.8 for _ in range(count)))
        chosen = self.rng.sample(own, inside)
        return chosen + self.rng.sample([n for n in names if n not in chosen], count - inside)

    def trembling(self, state: State, broken: bool) -> State:
        """Return the state with the probe anywhere on its side of the limit."""
        low, high = (LIMIT + 5, LIMIT + 25) if broken else (LIMIT - 30, LIMIT - 5)
        pose = Pose(round(self.rng.uniform(low, high), 1), 470.0, 0.0)
        return State({**state.places, PROBE: pose}, state.angles)

    def fits(self, state: State) -> bool:
        """Whether no part is in another's room."""
        at = [p for p in state.places.values() if isinstance(p, Pose)]
        return all(a.distance(b) >= ROOM for n, a in enumerate(at) for b in at[:n])

    def _free(self, places: Mapping[str, Place], name: str, near: Pose | None = None) -> Pose | None:
        others = [p for n, p in places.items() if isinstance(p, Pose) and n != name]
        for _ in range(300):
            if near is not None:
                x, y = near.x + self.rng.uniform(-120, 120), near.y + self.rng.uniform(-120, 120)
            else:
                x, y = self.rng.uniform(600, 900), self.rng.uniform(130, 520)
            pose = Pose(round(x, 1), round(y, 1), round(self.rng.uniform(-45, 45), 1))
            if not (600 <= x <= 900 and 130 <= y <= 520) or any(pose.distance(o) < ROOM for o in others):
                continue
            arm, shape = self.setup.lab.robots["arm1"], self.setup.type_of(name).geometry
            if check_reach("arm1", arm, name, shape, pose) is None:
                return pose
        return None

    def commit(self, state: State, message: str, parents: list[str], number: int, expect: str = "") -> str:
        """Write a commit, as text."""
        files = {"lab.yaml": self.lab.encode(), "state/table.yaml": state_text(state, expect).encode()}
        time = BEGIN + timedelta(minutes=number)
        return self.repository.write_commit(files, message, parents, author=AUTHOR, time=time)


def history(
    folder: Path, seed: int, commits: int = 128, *, merges: bool = False, expect: str = EXPECT, **lab: Any
) -> Written:
    """Write a lab with `commits` after a good one, of which one breaks the expectation; with `merges`, branches that
    were worked on at the same time. `main` is checked out at the last."""
    parts = Parts(folder, seed, **lab)
    rng = random.Random(seed + 1000)
    planted = 1 + int(commits * ((0.5 + seed * GOLDEN) % 1))
    good = parts.commit(parts.start, "everything in storage", [], 0)
    found = Written(folder, good, good, "")
    tip: Tip = (good, parts.start, False)
    number = 0

    def add(tip: Tip, only: Callable[[str], bool] = lambda _: True) -> Tip:
        nonlocal number
        number += 1
        breaks = number == planted
        broken = tip[2] or breaks
        state = parts.edited(tip[1], only)
        if breaks or (rng.random() < 0.15 and only(PROBE)):
            state = parts.trembling(state, broken)
        name = parts.commit(state, f"change {number}", [tip[0]], number, expect)
        found.commits.append(name)
        found.first_bad = name if breaks else found.first_bad
        return name, state, broken

    while number < commits:
        if merges and number + 8 <= commits and rng.random() < 0.2:
            tip = _branched(parts, tip, add, rng, found, expect)
        else:
            tip = add(tip)
    found.bad = tip[0]
    parts.repository.write_refs({"refs/heads/main": tip[0], "refs/tags/good": good}, head="main")
    return found


def _branched(
    parts: Parts, base: Tip, add: Callable[..., Tip], rng: random.Random, found: Written, expect: str
) -> Tip:  # fmt: skip
    """Return the merge of two branches of two to four commits, each with parts of its own."""
    ours, theirs = base, base
    for _ in range(rng.randint(2, 4)):
        ours = add(ours, lambda n: n == PROBE or int(n[-1]) % 2 == 0)
    for _ in range(rng.randint(2, 4)):
        before, theirs = theirs, add(theirs, lambda n: n != PROBE and int(n[-1]) % 2 == 1)
        if not parts.fits(_merged(base[1], ours[1], theirs[1])):  # the next commit takes it back
            places = {**before[1].places, PROBE: theirs[1].places[PROBE]}
            theirs = (theirs[0], State(places, before[1].angles), theirs[2])
    state = _merged(base[1], ours[1], theirs[1])
    name = parts.commit(state, "merge", [ours[0], theirs[0]], 100_000 + len(found.commits), expect)
    found.commits.append(name)
    return name, state, ours[2] or theirs[2]


def _merged(base: State, ours: State, theirs: State) -> State:
    """Return what a merge by values gives."""
    places = {n: theirs.places[n] if theirs.places[n] != p else ours.places[n] for n, p in base.places.items()}
    angles = {n: theirs.angles[n] if theirs.angles[n] != a else ours.angles[n] for n, a in base.angles.items()}
    return State(places, angles)


def state_text(state: State, expect: str = "") -> str:
    """Return a state as capture would write it."""
    return "\n".join(_lines(state, expect)) + "\n"


def _lines(state: State, expect: str) -> Iterator[str]:
    yield from ("apiVersion: pico/v1", "kind: LabState", "metadata: {lab: random}", "components:")
    for name, place in sorted(state.places.items()):
        yield f"  {name}:"
        if isinstance(place, str):
            yield f"    slot: {place}"
        else:
            yield from ("    pose:", f"      x: {place.x:g}", f"      y: {place.y:g}", f"      yaw: {place.yaw:g}")
        if name in state.angles:
            yield f"    angle: {state.angles[name]:g}"
    if expect:
        yield from ("expect:", f'  - {{that: "{expect}", message: the probe stands beyond its limit}}')


def _lab(slots: Mapping[str, tuple[float, float]], homes: Mapping[str, str], kinds: Mapping[str, str]) -> str:
    lines = [
        "apiVersion: pico/v1", "kind: Lab", "metadata: {name: random}", "table: {size: [1200, 900], beam_height: 70}",
        "robots: {arm1: {model: xarm7, mount: {x: 480, y: 760, yaw: -90}, transit_height: 250}}", "slots:",
        *(f"  {name}: {{x: {x}, y: {y}}}" for name, (x, y) in sorted(slots.items())),
        f"  store/probe: {{x: {LIMIT + 40:g}, y: 370}}", "inventory:", f"  {FIXED}",
        f"  {PROBE}: {{type: plano_convex_100, marker: 1, home: store/probe}}",
        *(f"  {n}: {{type: {kinds[n]}, marker: {k}, home: {homes[n]}}}" for k, n in enumerate(sorted(homes), 2)),
    ]  # fmt: skip
    return "\n".join(lines) + "\n"
