"""Undoes real runs that were killed: `python benchmarks/undo.py --cycles 500 --held 100 --fidelity kinematic`.

Each cycle puts parts by hand anywhere: in slots at any yaw and off their centers, and on the table. A `pico apply` to a
goal that differs in one to three parts is killed at a random instant, in `--held` of the cycles with a part in the
hand; in some of them the bench is then tidied up by `pico recover`, or the run taken up again and killed once more.
Then `pico undo` must bring every part back to the pose that it had: within 0.1 mm and 0.1 deg in `kinematic`, within
its tolerance in `physics`; and it may say "equals" only where `pico plan --detailed-exitcode` to that state gives 0.
Prints the counts; the exit code is 1 where anything is elsewhere, untrue or refused.
"""

from __future__ import annotations

import argparse
import importlib
import random
import shutil
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from pico.places.bench import BenchPlace

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from kills import command, forked, preload  # noqa: E402

if TYPE_CHECKING:
    from pico.backends.sim.world import World
    from pico.model.pose import Pose
    from pico.model.setup import Setup

STATE = Path("state") / "table.yaml"
REVISIONS = ("E1-1", "E2-3", "E3-2")
LONGEST = {"kinematic": 0.6, "physics": 6.0}
"""Up to so long after its first record in the journal a run is killed [s]."""
PATIENCE = 120.0
"""So long a command may take to begin its run, or to take a part in the hand [s]."""
NEAR = {"position": 0.1, "yaw": 0.1}
"""So near to where it was a part must be after a kinematic undo [mm, deg]; in physics its tolerance counts."""


@dataclass
class Bench:
    """The lab that the cycles run in; `draw`: where all that is random comes from."""

    folder: Path
    fidelity: str
    draw: random.Random
    count: Counter[str] = field(default_factory=Counter)
    far: list[float] = field(default_factory=list)

    @cached_property
    def setup(self) -> Setup:
        from pico.history.lab.folder import LabFolder

        return LabFolder(self.folder).setup

    def world(self) -> World:
        """Return the simulated world as it is."""
        from pico.backends.sim.store import load_world

        return load_world(self.setup, BenchPlace(self.folder, "sim"))[0]

    def movable(self) -> list[str]:
        """Return the parts that an arm may move."""
        setup = self.setup
        return [name for name in sorted(setup.lab.inventory) if setup.movable(name)]

    def said(self) -> str:
        """Return what the last command printed."""
        return (self.folder / "out.txt").read_text()

    def run(self, *words: str) -> int | None:
        """Run a command to its end; return its exit code."""
        return command(self.folder, *words)

    def moves(self, *words: str) -> tuple[str, ...]:
        """Return a command that moves the bench, with what it needs to do so."""
        return (*words, "--auto-approve", "--fidelity", self.fidelity)

    def written(self) -> int:
        """Return when the journal was written last [ns]."""
        log = self.folder / ".pico/benches/sim/journal.sqlite-wal"
        try:
            return log.stat().st_mtime_ns
        except FileNotFoundError:  # the journal was closed just now
            return 0

    def began(self) -> str:
        """Return the last run that began to move anything."""
        from pico.runs.journal import Journal

        journal = Journal(self.folder / ".pico/benches/sim" / "journal.sqlite")
        moving = journal.moving()
        found = [run.run for run in journal.runs() if run.run in moving]
        journal.close()
        return found[-1] if found else ""


def spot(bench: Bench, name: str) -> Pose:
    """Return somewhere for a part: in a slot, off its center by less than its capture radius at any yaw, or not."""
    from pico.model.pose import Pose

    draw, slots = bench.draw, bench.setup.lab.slots
    if draw.random() < 0.3:
        return Pose(draw.uniform(300, 950), draw.uniform(380, 460), draw.choice([0.0, 30.0, 90.0, -45.0]))
    slot = slots[bench.setup.lab.inventory[name].home or ""] if draw.random() < 0.6 else slots[draw.choice([*slots])]
    way, off = draw.uniform(-180, 180), draw.uniform(0.0, slot.capture - 0.2)
    at = Pose(slot.x, slot.y, way).compose(Pose(off, 0.0, 0.0))
    return Pose(round(at.x, 2), round(at.y, 2), round(draw.choice([0.0, 45.0, 90.0, draw.uniform(-180, 180)]), 1))


def scatter(bench: Bench) -> None:
    """Put every part somewhere by hand, and draw the values of its tunables; what has no room there stays."""
    from pico.backends.sim.hand import nudge
    from pico.backends.sim.store import save_world
    from pico.backends.sim.world import new_world
    from pico.diagnostics import PicoError
    from pico.model.observation import ObservedValue

    setup = bench.setup
    save_world(BenchPlace(bench.folder, "sim"), new_world(setup))
    world = bench.world()
    for name in bench.movable():
        start, goal = world.components[name].pose, spot(bench, name)
        assert start is not None
        by = {"dx": goal.x - start.x, "dy": goal.y - start.y, "dyaw": goal.yaw - start.yaw}
        try:
            there = nudge(setup, world, name, **by)
        except PicoError:
            continue
        if near(setup, there, name) < setup.lab.margins.body:
            continue  # a hand may put it there, an arm may not
        world = there
        for tunable, kind in setup.type_of(name).tunables.items():
            if tunable in world.components[name].values and kind.range:
                value = ObservedValue(value=round(bench.draw.uniform(*kind.range), 1))
                world = world.with_value(name, tunable, value)
    save_world(BenchPlace(bench.folder, "sim"), world, durable=False)


def near(setup: Setup, world: World, name: str) -> float:
    """Return how far a part stands from the nearest other one [mm]."""
    from pico.backends.sim.world import footprints
    from pico.geometry import placed, separation

    shapes = {other: placed(footprint, pose) for other, footprint, pose in footprints(world)}
    return min(separation(shapes[name], shape) for other, shape in shapes.items() if other != name)


def manifest(bench: Bench, places: Mapping[str, Pose], world: World) -> str:
    """Return a LabState with parts at exactly these poses, and with the values that they have."""
    lines = ["apiVersion: pico/v1", "kind: LabState", f"metadata: {{lab: {bench.setup.lab.name}}}", "components:"]
    for name, pose in sorted(places.items()):
        lines += [f"  {name}:", f"    pose: {{x: {pose.x!r}, y: {pose.y!r}, yaw: {pose.yaw!r}}}"]
        known = world.components[name].values
        lines += [f"    {k}: {_written(v.value)}" for k, v in sorted(known.items()) if v.value is not None]
    return "\n".join([*lines, ""])


def _written(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else f"{value}"


def goal(bench: Bench, places: Mapping[str, Pose], world: World) -> tuple[str, ...]:
    """Write a goal into the manifest in which one to three parts stand elsewhere, and return what to apply: it, or (one
    in eight) a commit."""
    if bench.fidelity == "kinematic" and bench.draw.random() < 0.125:
        return (bench.draw.choice(REVISIONS),)
    most = 3 if bench.fidelity == "kinematic" else 1
    names = bench.draw.sample(bench.movable(), bench.draw.randint(1, most))
    (bench.folder / STATE).write_text(manifest(bench, {**places, **{n: spot(bench, n) for n in names}}, world))
    return ()


def killed(bench: Bench, held: bool, *words: str) -> None:
    """Start a command and kill it: at any time of its run, or as soon as a hand holds something, and then some."""
    import os
    import signal

    stored, late = bench.folder / ".pico/benches/sim" / "world.json", bench.draw.uniform(0.0, LONGEST[bench.fidelity])
    written = bench.written()
    child, until, ended, armed = forked(bench.folder, *words), time.monotonic() + PATIENCE, False, False
    while time.monotonic() < until and not ended:
        if not armed and held and stored.exists() and '"presence":"held"' in stored.read_text():
            armed, until = True, time.monotonic() + late / 10
        elif not armed and not held and bench.written() != written:
            armed, until = True, time.monotonic() + late
        time.sleep(0.002)
        ended = os.waitpid(child, os.WNOHANG)[0] == child
    if ended:
        bench.count["ended first"] += 1
        return
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    bench.count["killed"] += 1
    bench.count["held"] += "held" in {body.presence for body in bench.world().components.values()}


def between(bench: Bench) -> None:
    """Do what a person may do before undoing: nothing, only clear the hand, or take the run up again, killed too."""
    what = bench.draw.random()
    if what < 0.2:
        bench.count["recovered"] += bench.run(*bench.moves("recover")) == 0
    elif what < 0.35:
        killed(bench, bench.draw.random() < 0.3, *bench.moves("resume"))


def cycle(bench: Bench, held: bool) -> list[str]:
    """Run one cycle; return what is wrong after it."""
    scatter(bench)
    before = bench.world()
    places = {n: body.pose for n, body in before.components.items() if body.pose is not None}
    exact = manifest(bench, places, before)
    what, last = goal(bench, places, before), bench.began()
    killed(bench, held, *bench.moves("apply", *what))
    if bench.began() == last:
        bench.count["nothing began"] += 1
        return []
    between(bench)
    bench.count["undone"] += 1
    code, said = bench.run(*bench.moves("undo")), bench.said()
    if (
        code and "was killed before it moved anything" in said
    ):  # of a `resume` that began nothing: undo then wants its run named
        code, said = bench.run(*bench.moves("undo", bench.began())), bench.said()
    (bench.folder / STATE).write_text(exact)
    found = elsewhere(bench, before)
    planned = bench.run("plan", "--detailed-exitcode", "--fidelity", bench.fidelity)
    if "The bench equals" in said or "the bench equals" in said:
        bench.count["equals"] += 1
        found += [f"untrue: {said[-400:]}"] if planned != 0 or found else []
    if code != 0:
        found.append(f"undo: exit code {code}: {said[-800:]}")
    return found + ([f"plan to it: exit code {planned}: {bench.said()[-600:]}"] if planned else [])


def elsewhere(bench: Bench, before: World) -> list[str]:
    """Return what is not as it was: poses beyond what is allowed, and values."""
    from pico.model.pose import angle_between

    found, setup = [], bench.setup
    for name, body in bench.world().components.items():
        was, kind = before.components[name], setup.type_of(name).pose
        if body.pose is None or was.pose is None or body.presence != "seen":
            found.append(f"{name} is {body.presence}")
            continue
        away, turned = body.pose.distance(was.pose), abs(angle_between(was.pose.yaw, body.pose.yaw))
        most = NEAR if bench.fidelity == "kinematic" else {
            "position": kind.tolerance.position, "yaw": kind.tolerance.yaw}  # fmt: skip
        bench.far.append(max(away / most["position"], turned / most["yaw"]))
        if away > most["position"] or turned > most["yaw"]:
            found.append(f"{name} is {away:.3f} mm and {turned:.3f} deg from where it was")
        if {k: v.value for k, v in body.values.items()} != {k: v.value for k, v in was.values.items()}:
            found.append(f"{name} has other values than it had")
    return found


def cycles(bench: Bench, wanted: int, held: int, keep: Path | None = None) -> int:
    """Run cycles until so many were undone, and so many of these kills came with a part in the hand; return how many
    were wrong. `keep`: where the benches of these go."""
    wrong = number = 0
    began = time.monotonic()
    while bench.count["undone"] < wanted or bench.count["held"] < held:
        number += 1
        rest, missing = wanted - bench.count["undone"], held - bench.count["held"]
        found = cycle(bench, missing > 0 and bench.draw.random() < max(0.3, missing / max(rest, 1)))
        wrong += bool(found)
        if found:
            print(f"cycle {number}: {'; '.join(found)}", flush=True)
            if keep is not None:
                shutil.copytree(bench.folder, keep / f"{bench.fidelity}-{number}")
    names = ("undone", "killed", "held", "ended first", "nothing began", "recovered", "equals")
    print(
        f"pico undo ({bench.fidelity}): {', '.join(f'{n} {bench.count[n]}' for n in names)}; the farthest part at "
        f"{max(bench.far):.0%} of what is allowed; {wrong} wrong; {time.monotonic() - began:.0f} s",
        flush=True,
    )
    return wrong


def main() -> int:
    """Undo."""
    from pico.history.examples.example import make_example

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cycles", type=int, default=500)
    parser.add_argument("--held", type=int, default=100, help="so many of the kills with a part in the hand")
    parser.add_argument("--fidelity", choices=sorted(LONGEST), default="kinematic")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="copy the benches of wrong cycles into it")
    given = parser.parse_args()
    preload()
    for name in ("apply", "undo", "resume", "recover", "plan"):
        importlib.import_module(f"pico_cli.commands.{name}")
    with tempfile.TemporaryDirectory() as temporary:
        bench = Bench(Path(temporary) / "shel", given.fidelity, random.Random(given.seed))
        make_example("shel", bench.folder)
        return 1 if cycles(bench, given.cycles, given.held, given.keep) else 0


if __name__ == "__main__":
    sys.exit(main())
