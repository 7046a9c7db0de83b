"""What goes wrong on the simulated bench, by seed and rate: so that recovery is tested, and a recipe before it is run.

`drop`: the part falls out of the hand on the way. `slip`: it turns in the fingers and is put down beside its goal.
`jam`: an axis, or the arm with the part in its hand, stops on the way. `camera`: nobody sees the part that was put
down, for some looks or for good. `timeout`: an axis does not answer; it did what it should, or not. `reading`: the
first reading is wrong. `slow`: an axis takes several times as long. `stick`: an axis stops on the way for good, until
faults are switched off. `frame`: what is measured gets lost. `beam`: no laser's light comes for a while. `flood`: for a
while far too much does.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pico.base.state_files import FAULTS
from pico.diagnostics import PicoError, did_you_mean, error
from pico.geometry.shape import placed, separation
from pico.geometry.table import overhang
from pico.model.pose import Pose
from pico.model.primitive import OWN
from pico.model.record import as_json, record
from pico.model.setup import Setup
from pico.places.attachment import require_attached
from pico.places.bench import BenchPlace

_MOVES = tuple(p.name for p in OWN.values() if p.carries)
_SETS = ("set", "home")
_LOOKS = ("measure", "auto_range")
KINDS: Mapping[str, tuple[str, ...]] = {
    "drop": _MOVES, "slip": _MOVES, "jam": (*_MOVES, *_SETS), "camera": _MOVES, "timeout": _SETS,
    "reading": (*_MOVES, *_SETS), "slow": _SETS, "frame": ("measure",), "beam": _LOOKS, "flood": _LOOKS, "stick": _SETS,
}  # fmt: skip
LASTING = ("stick",)
"""Faults that the bench itself cannot get over: they are none of `all`."""
LOOKS = 3
"""How often a bench looks at most before it gives up: two looks that agree are believed."""
LOOK = 0.5
"""What one more look takes [s]."""


@dataclass(frozen=True)
class Fault:
    """What goes wrong with one operation, and the chance that decides how."""

    kind: str
    draw: random.Random
    at: float = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "at", self.draw.uniform(0.1, 0.9))


@record
class Faults:
    """How often each kind of fault comes: its share of the operations that it can befall. `all`: any but LASTING."""

    rates: Mapping[str, float] = field(default_factory=dict)
    seed: int = 1

    def of(self, primitive: str, key: str) -> Fault | None:
        """Return what goes wrong with the operation under `key`, the same each time; mostly nothing."""
        draw = random.Random(f"{self.seed}/{key}")
        able = [kind for kind, primitives in KINDS.items() if primitive in primitives and kind not in LASTING]
        for kind in able:
            if draw.random() < self.rates.get(kind, 0.0):
                return Fault(kind, draw)
        if able and draw.random() < self.rates.get("all", 0.0):
            return Fault(draw.choice(able), draw)
        lasting = (kind for kind in LASTING if primitive in KINDS[kind] and draw.random() < self.rates.get(kind, 0.0))
        return next((Fault(kind, draw) for kind in lasting), None)


def parse(words: Sequence[str], seed: int) -> Faults:
    """Return the faults that `drop=0.05 all=0.01 seed=3` asks for, none for `off`; raises PicoError for nonsense."""
    rates: dict[str, float] = {}
    for word in words:
        name, _, value = word.partition("=")
        if name == "off" and not value:
            rates = {}
        elif name == "seed" and value.isdigit():
            seed = int(value)
        else:
            rates[name] = _rate(name, value)
    return Faults(rates=rates, seed=seed)


def _rate(name: str, value: str) -> float:
    known = (*KINDS, "all", "seed", "off")
    if name not in known:
        raise PicoError(error("unknown-fault", f"there is no fault `{name[:40]}`", hint=did_you_mean(name[:40], known)))
    try:
        rate = float(value)
    except ValueError:
        rate = -1.0
    if not 0 <= rate <= 1:
        text = f"`{name}={value[:20]}` is no rate"
        raise PicoError(error("rate", text, hint=f"a share of the operations, from 0 to 1: `{name}=0.05`"))
    return rate


def faults_of(setup: Setup, place: BenchPlace) -> Faults:
    """Return the faults of a simulated bench: those that `pico sim faults` asked for, else the lab's."""
    asked = FAULTS.read(FAULTS.path(place.folder), _faults)
    return asked or Faults(rates={str(k): v for k, v in setup.lab.sim.faults.items()}, seed=setup.lab.sim.seed)


def _faults(data: Mapping[str, Any]) -> Faults:
    return Faults(rates={str(k): float(v) for k, v in data["rates"].items()}, seed=int(data["seed"]))


def save_faults(place: BenchPlace, faults: Faults) -> None:
    """Let these faults happen on a simulated bench from now on; raises PicoError."""
    require_attached(place)
    path = FAULTS.path(place.folder)
    FAULTS.write(path, as_json(faults), what=f"the faults cannot be stored in {path}")


def beside(pose: Pose, draw: random.Random) -> Pose:
    """Return where a part that slipped in the hand comes to stand instead of at `pose`: up to 4 mm and 5 deg away."""
    return Pose(pose.x + draw.uniform(-4, 4), pose.y + draw.uniform(-4, 4), pose.yaw + draw.uniform(-5, 5))


def room_at(setup: Setup, name: str, pose: Pose, others: Mapping[str, Pose]) -> bool | None:
    """Return whether a part touches no other one at `pose`; None where it would not be on the table."""
    shape = placed(setup.type_of(name).geometry.footprint, pose)
    if overhang(setup.lab.table, shape) > 0:
        return None
    return all(
        separation(shape, placed(setup.type_of(other).geometry.footprint, at)) > 0
        for other, at in others.items() if other != name
    )  # fmt: skip
