"""The benches of `nights.py`, and what their detectors would read on a table that the simulator holds: the simulator's
own instruments on the true table, without PICO's diagnosis."""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pico.backends.sim.world import World
    from pico.model.setup import Setup
    from pico.places.bench import BenchPlace

ROOT = Path(__file__).resolve().parent.parent
LABS = ("fiber", "shel", "pickoff")
USUAL = 0.003
"""By which share light may differ from one reading to the next besides what an instrument states, one sigma."""
SPOT = {"x": 1.0, "y": 1.0}
"""The same of where a spot lies on a camera [um]; of its size a share of USUAL."""
SEEN = {"dx": 0.05, "dy": 0.05, "dyaw": 0.03}
"""How well a camera over the table sees where a bumped part stands, one sigma [mm, deg]."""
Reading = tuple[float, float]
"""A number with one standard deviation."""


def lab_files(lab: str, folder: Path, seed: int) -> str:
    """Write the files of a lab into a new folder; return the revision that its evening starts from, if any."""
    from pico.bench.bench import new_lab

    if lab == "pickoff":
        import morning_lab

        morning_lab.make(folder, seed)
        return ""
    if lab == "shel":
        new_lab(folder, "shel")
        text = (folder / "lab.yaml").read_text()
        (folder / "lab.yaml").write_text(text.replace("  seed: 1\n", f"  seed: {seed}\n", 1))
        return "e1"
    shutil.copytree(ROOT / "tests" / "labs" / lab, folder)
    path = folder / "lab.yaml"
    if not re.search(r"(?m)^sim:", text := path.read_text()):
        path.write_text(text.replace("\ninventory:\n", f"\nsim:\n  seed: {seed}\ninventory:\n", 1))
    return ""


@dataclass
class Ran:
    """What a command printed, how it ended, and the CPU seconds that it took."""

    code: int
    out: str
    err: str
    cpu: float


def run(folder: Path, *words: str, before: Callable[[], None] = lambda: None) -> Ran:
    """Run `pico WORDS` in a folder, in a process that begins with what `before` does to the program."""
    from pico_cli.main import main

    out, err = folder.parent / "out.txt", folder.parent / "err.txt"
    child = os.fork()
    if not child:
        code = 1
        try:
            for number, path in ((1, out), (2, err)):
                os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), number)
            os.chdir(folder)
            before()
            code = main(words)
            sys.stdout.flush()
            sys.stderr.flush()
        finally:
            os._exit(code)
    _, status, used = os.wait4(child, 0)
    return Ran(os.waitstatus_to_exitcode(status), out.read_text(), err.read_text(), used.ru_utime + used.ru_stime)


def preload() -> None:
    """Load what a morning needs, once, before processes are forked."""
    import mujoco  # noqa: F401

    import pico.bench.drifting.judging
    import pico.bench.mornings
    import pico.diagnosis.choosing
    import pico.diagnosis.suspects
    import pico.optics.light  # noqa: F401


@dataclass
class Evening:
    """A bench that was set up, aligned and accepted as the reference, in `folder`; `kept`: a copy to begin from."""

    lab: str
    folder: Path
    kept: Path
    cpu: float = 0.0
    _seen: dict[str, dict[str, Reading]] = field(default_factory=dict)

    @cached_property
    def setup(self) -> Setup:
        from pico.history.lab.folder import LabFolder

        return LabFolder(self.folder).setup

    @cached_property
    def place(self) -> BenchPlace:
        from pico.places.bench import BenchPlace

        return BenchPlace(self.folder, "sim")

    @cached_property
    def world(self) -> World:
        return self.load()

    def load(self) -> World:
        """Return the table as the simulator holds it now."""
        from pico.backends.sim.store import load_world

        return load_world(self.setup, self.place)[0]

    def restore(self) -> None:
        """Make the folder what it was in the evening."""
        shutil.rmtree(self.folder)
        shutil.copytree(self.kept, self.folder, symlinks=True)

    def references(self) -> dict[str, bytes]:
        """Return the files of references, by path."""
        found = sorted((self.folder / ".pico").rglob("mornings.json"))
        return {str(path.relative_to(self.folder)): path.read_bytes() for path in found}

    @cached_property
    def quantities(self) -> list[dict[str, Any]]:
        """The quantities of the reference, with `got` of each."""
        (text,) = self.references().values()
        last = json.loads(text)["references"][-1]
        return [{**q, "got": got} for q, got in zip(last["quantities"], last["got"], strict=True)]

    @cached_property
    def parts(self) -> list[str]:
        """The parts that light meets on its way to the detectors of the reference, with its sources and these."""
        from pico.backends.sim.lighted import light_on
        from pico.backends.sim.readings import Table

        light = light_on(Table(self.setup, self.place, self.world))
        read = {shot["address"].partition(".")[0] for q in self.quantities for shot in q["shots"]}
        found = set(read)
        for n, crossing in enumerate(light.crossings):
            if crossing.component in read and crossing.event == "detected":
                found |= {c.component for c in light.way(n)} | {crossing.beam.source}
        return sorted(found & self.setup.lab.inventory.keys())

    def readings(self, world: World) -> dict[str, Reading]:
        """Return what each shot of the reference would read on a table, with its sigma; noise is that of one instant,
        and so the same on every table. Logarithms of nothing: a detector that has no light reads its noise."""
        found: dict[str, Reading] = {}
        key = repr(world.components)
        if key not in self._seen:
            for quantity in (q for q in self.quantities if q["got"] is not None):
                for shot in quantity["shots"]:
                    found |= self._shot(world, shot["address"], shot["at"], quantity["number"])
            self._seen = {**(self._seen if len(self._seen) < 300 else {}), key: found}
        return self._seen[key]

    def _shot(self, world: World, address: str, at: Mapping[str, Any], number: str) -> dict[str, Reading]:
        from pico.backends.attempt import Failed
        from pico.backends.sim.readings import Table, measurer_of
        from pico.model.observation import ObservedValue

        component, _, measurable = address.partition(".")
        there = [component, *(a.partition(".")[0] for a in at)]
        key = name_of(address, at, number)
        if any(world.components[n].presence != "seen" for n in there):
            return {}
        for one, value in at.items():
            part, _, tunable = one.partition(".")
            world = world.with_value(part, tunable, ObservedValue(value=value))
        if measurable == "dark":  # a morning shuts every laser for that
            for name in (n for n in world.components if "shutter" in self.setup.type_of(n).tunables):
                world = world.with_value(name, "shutter", ObservedValue(value="closed"))
        table = Table(self.setup, self.place, world)
        if "pixel_size" in self.setup.type_of(component).parameters and measurable != "dark":
            spot = None if _too_bright(table, component) else _spot(table, component, number)
            return {key: spot} if spot else {}
        measurer = measurer_of(self.setup, component, measurable)
        assert measurer is not None
        try:
            reading = measurer.read(table, component, measurable)
        except Failed:
            return {}
        if measurable == "dark":
            value = reading.value
            return {key: (float(value["mean"]), 0.02)} if isinstance(value, Mapping) and number == "mean" else {}
        if not isinstance(reading.value, int | float):
            return {}
        value, sigma = float(reading.value), float(reading.sigma or 0.0)  # type: ignore[arg-type]
        return {key: (value, math.hypot(sigma, USUAL * value))}


def name_of(address: str, at: Mapping[str, Any], number: str) -> str:
    """Return what tells one number of a measurement from the others."""
    return " ".join([address, number, *(f"{k}={at[k]}" for k in sorted(at))])


def _too_bright(table: Any, component: str) -> bool:
    """Return whether a camera saturates at its shortest exposure, so that the position of its light is unreadable."""
    from pico.backends.sim.lighted import light_on
    from pico.optics.beam_table import exposed

    light = light_on(table)
    part = light.parts[component]
    least = (part.kind.tunables["exposure"].range or (0.0, 0.0))[0]
    if not light.at(component) or not (told := exposed(light, part)):
        return False
    return told.times * least / part.value("exposure", "ms", 1.0) > 1.0


def _spot(table: Any, component: str, number: str) -> Reading | None:
    """Return a number of the light on a camera, from the beams that truly come there."""
    from pico.backends.sim.lighted import light_on

    arrivals = light_on(table).at(component)
    total = sum(a.power for a in arrivals)
    if number == "power":
        kept = table.world.components[component].unseen
        gain = kept.gain if kept else 1.0
        return total * gain, math.hypot(USUAL * total, 1e-9)
    if total <= 1e-9:
        return None
    if number in SPOT:
        axis = {"x": 0, "y": 1}[number]
        return 1e3 * sum(a.power * a.center[axis] for a in arrivals) / total, SPOT[number]
    if number == "size":
        size = sum(a.power * 2e3 * math.sqrt(a.beam.widths[0] * a.beam.widths[1]) for a in arrivals) / total
        return size, USUAL * size
    return None


def off(
    one: Mapping[str, Reading], other: Mapping[str, Reading], more: Mapping[str, float] | None = None
) -> dict[str, float]:
    """Return by how many sigma each reading of two tables differs; `more`: what else its sigma is made of."""
    found = {}
    for key in one.keys() & other.keys():
        (a, sa), (b, sb) = one[key], other[key]
        found[key] = (a - b) / math.sqrt(sa**2 + sb**2 + (more or {}).get(key, 0.0) ** 2)
    return found


def most(found: Mapping[str, float]) -> float:
    """Return the greatest of some differences, without its sign."""
    return max((abs(v) for v in found.values()), default=0.0)


def make_evening(lab: str, place: Path, seed: int) -> Evening:
    """Set a bench up, align its light if it has a fiber to align it into, and accept it as the reference."""
    folder = place / lab / "bench"
    folder.parent.mkdir()
    revision = lab_files(lab, folder, seed)
    if not (folder / ".git").exists():
        _git(folder)
    words: list[Sequence[str]] = [("apply", *([revision] if revision else []), "--yes")]
    words += [("optimize", "coupling", "--yes")] if lab == "fiber" else []
    words += [("sim", "wait", "2 h"), ("morning", "--accept", "--yes")]
    made = Evening(lab, folder, folder.parent / "evening")
    for each in words:
        done = run(folder, *each)
        made.cpu += done.cpu
        if done.code:
            raise SystemExit(
                f"the evening of {lab}: `pico {' '.join(each)}` ended with {done.code}\n{done.out}{done.err}"
            )
    if not made.references():
        raise SystemExit(f"the evening of {lab}: no reference was written")
    shutil.copytree(folder, made.kept, symlinks=True)
    assert made.world.components and made.quantities  # read once, before nights change them
    return made


def _git(folder: Path) -> None:
    import subprocess

    for words in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "The bench"]):
        subprocess.run(["git", *words], cwd=folder, check=True, capture_output=True)
