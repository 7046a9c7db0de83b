"""How fast light ends for each fault in each state of a bench.

    python benchmarks/safety_chain.py [--faults ...] [--states ...] [--benches ...]

Each fault meets each state of a bench, with a laser that has a shutter and one that has none, both with and without a
dead-man. The bench is taken for a real one (`--backend hardware`): its emulators, and the simulated world behind them,
are a process of their own (`benchmarks/safety_world.py`), and emission is measured at the emulated lasers. `--benches`
also tries one with two arms, one without any, and one with three lasers. Printed is the worst time of each fault, and
in which cells light stayed on. The exit code is 3 where a bar is missed: 0.5 s, 1 s for links that are lost and for a
guard or a host that is gone (the dead-man of 1 s, and 0.5 s).

`--table` prints the table of docs/how-to/laser-safety.md instead, by the rule that the cells are judged by.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from safety_acts import refuses_teleoperation  # noqa: E402
from safety_world import BENCHES  # noqa: E402

from pico.backends.hardware.guard.note import notices, read  # noqa: E402
from pico.base.state_files import EDGE  # noqa: E402
from pico.bench.bench import Bench  # noqa: E402
from pico.diagnostics import PicoError  # noqa: E402
from pico.drivers.registry import driver, known  # noqa: E402
from pico.places.bench import BenchPlace  # noqa: E402

FAULTS = {
    "door": "door_box", "interlock": "lock", "emergency stop": "estop", "presence": "veil", "lost link": "",
    "killed PICO": "door_box", "frozen host": "", "killed guard": "",
}  # fmt: skip
"""Each fault with the safety input that is pulled in it. Once PICO is killed, the client that is, a door opens."""
STATES = ("idle", "measuring", "moving", "optimizing", "unattended")
"""What the bench does."""
REFUSED = ("teleoperating",)
"""What no bench with devices does: its plan is refused before anything begins."""
LASERS = {"laser": "with shutter", "bare": "without shutter"}
WATCHDOG = 1.0
"""The dead-man of shutters and lasers [s]."""
GUARDLESS = ("frozen host", "killed guard")
"""Faults after which PICO can close nothing."""
TOLD = 2.0
"""The time in which PICO has to report what it could not close [s]."""
FROZEN = 2.0
"""For how long a host stands still at least [s]."""
WAIT = 4.0
"""How long is waited for light to end [s]."""


def bar(fault: str, *, dead_man: bool) -> float | None:
    """Return within which light must end [s], None where it can stay on."""
    if fault in GUARDLESS:
        return WATCHDOG + 0.5 if dead_man else None
    return 1.0 if fault == "lost link" else 0.5


def beside(module: str, *words: str) -> list[str]:
    """Return the command that runs a module beside this one in a process of its own."""
    return [sys.executable, "-c", f"import sys, {module}; {module}.main(*sys.argv[1:])", *words]


@dataclass(frozen=True)
class Cell:
    """One fault in one state, with or without dead-man: after how long the light of each laser ended [s], None where it
    did not, and whether that was told."""

    bench: str
    fault: str
    state: str
    dead_man: bool
    ended: dict[str, float | None]
    told: bool

    @property
    def wrong(self) -> list[str]:
        """What is not as it must be."""
        limit, found = bar(self.fault, dead_man=self.dead_man), []
        for name, after in self.ended.items():
            if limit is not None and (after is None or after > limit):
                found.append(f"light of {name} {'stayed on' if after is None else f'ended after {after:.2f} s'}")
        if None in self.ended.values() and not self.told:
            found.append("light stayed on, and nothing tells of it")
        how = f"{self.bench}, {self.fault}, {self.state}, {'with' if self.dead_man else 'without'} dead-man"
        return [f"{how}: {one}" for one in found]


AGAIN = 4
"""How often a state is sought."""


class NotThere(Exception):
    """The bench did not come into the state that was wanted."""


class Chain:
    """One bench at the wire, of a `kind` of `safety_world.BENCHES`, and what fails on it."""

    def __init__(self, folder: Path, *, dead_man: bool, kind: str = "one arm") -> None:
        self.lab, self.dead_man, self.place = folder, dead_man, BenchPlace(folder, "hardware")
        words = beside("safety_world", str(folder), str(WATCHDOG) if dead_man else "", kind)
        self.kind = kind
        self.world = subprocess.Popen(
            words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1, cwd=ROOT / "benchmarks"
        )
        assert self.world.stdout is not None and self.world.stdout.readline().strip() == '"ready"'

    def ask(self, *words: Any) -> Any:
        """Have the world do something, and return its answer."""
        assert self.world.stdin is not None and self.world.stdout is not None
        self.world.stdin.write(json.dumps(words) + "\n")
        return json.loads(self.world.stdout.readline())

    def guard(self) -> int:
        """Return the process that guards the bench; 0 for none."""
        found = EDGE.read(EDGE.path(self.place.folder), lambda note: int(note["pid"]))
        return found if found and Path(f"/proc/{found}").exists() else 0

    def light(self) -> None:
        """Let all lasers emit, as a person does."""
        with Bench.open(self.lab, backend="hardware") as bench:
            bench.wait_until_free(60)  # the edge may tidy up what an unattended run left
            for name in self.ask("lit"):
                for tunable, value in (("emission", "true"), ("shutter", "open")):
                    if tunable in bench.setup.type_of(name).tunables:
                        report = bench.apply(bench.single(name, "set", **{tunable: value}))
                        if report.outcome != "done":
                            raise NotThere(f"{name} does not emit: {report}")
        if not all(self.ask("lit").values()):
            raise NotThere(f"light ended before the fault: {self.ask('lit')}")

    @contextmanager
    def acting(self, state: str) -> Iterator[subprocess.Popen[str] | None]:
        """Have a client that keeps the bench in a state."""
        if state == "idle":
            yield None
            return
        words, pipe = beside("safety_acts", str(self.lab), state), subprocess.PIPE
        client = subprocess.Popen(words, stdout=pipe, stderr=pipe, text=True, cwd=ROOT / "benchmarks")
        try:
            assert client.stdout is not None
            if client.stdout.readline().strip() != "there":
                raise NotThere(f"the bench is not {state}: {client.communicate()[1][-2000:]}")
            yield client
        finally:
            client.send_signal(signal.SIGCONT)
            client.kill()
            client.communicate()

    def cell(self, fault: str, state: str) -> Cell:
        """Return what becomes of light when a fault meets a state. On a busy machine an emulator may be silent for so
        long that the guard ends light before the fault: the state is then sought again, which is printed."""
        for left in reversed(range(AGAIN)):
            try:
                return self._cell(fault, state)
            except NotThere as exc:
                if not left:
                    raise SystemExit(str(exc)) from exc
                print(f"{fault} x {state}: again, for {exc}"[:300], flush=True)
                self._mend(fault)
        raise AssertionError

    def _cell(self, fault: str, state: str) -> Cell:
        self.light()
        with self.acting(state) as client:
            lit = self.ask("lit")
            began = self.ask("watch")
            guard = self.guard()
            self._fail(fault, client, guard)
            until = time.time() + WAIT
            while time.time() < until and any(self.ask("lit").values()):
                time.sleep(0.02)
            time.sleep(0.1)  # the world notes when light ended a moment later
            ended = {name: self.ask("ended").get(name) for name in lit}
            if fault == "frozen host":
                time.sleep(max(0.0, began + FROZEN - time.time()))
                os.kill(guard, signal.SIGCONT)
            told = self._told()
        self._mend(fault)
        after = {name: None if at is None else max(0.0, at - began) for name, at in ended.items() if lit[name]}
        return Cell(self.kind, fault, state, self.dead_man, after, told)

    def _fail(self, fault: str, client: subprocess.Popen[str] | None, guard: int) -> None:
        if fault == "lost link":
            self.ask("freeze", "inputs", True)
        elif fault == "killed guard":
            os.kill(guard, signal.SIGKILL)
        elif fault == "frozen host":
            for process in (guard, *([client.pid] if client else ())):
                os.kill(process, signal.SIGSTOP)
        else:
            if fault == "killed PICO" and client is not None:
                client.kill()
            self.ask("pull", FAULTS[fault], True)

    def _told(self) -> bool:
        """Return whether something tells of it in time."""
        until = time.time() + TOLD
        while not (said := bool(notices(read(self.place)))) and time.time() < until:
            time.sleep(0.02)
        return said

    def _mend(self, fault: str) -> None:
        self.ask("freeze", "inputs", False)
        for name in set(FAULTS.values()) - {""}:
            self.ask("pull", name, False)
        until = time.time() + 60
        with Bench.open(self.lab, backend="hardware") as bench:  # what was under way comes to its end
            with suppress(PicoError):
                bench.wait_until_free(until - time.time())
            bench.wait(bench.edge.end_light())
            with suppress(PicoError):
                bench.recovery.settle()

    def close(self) -> None:
        """End every process of it."""
        if guard := self.guard():
            os.kill(guard, signal.SIGTERM)
        assert self.world.stdin is not None
        self.world.stdin.close()
        try:
            self.world.wait(20)
        except subprocess.TimeoutExpired:
            self.world.kill()


def table() -> str:
    """Return what docs/how-to/laser-safety.md says of each cell, as Markdown."""
    states = (*STATES, *REFUSED)
    lines = [f"| fault | laser | {' | '.join(states)} |", f"|---|---|{'---|' * len(states)}"]
    for fault, laser in product(FAULTS, LASERS.values()):
        sure, bare = bar(fault, dead_man=True), bar(fault, dead_man=False)
        said = f"{sure:g} s" if bare is not None else f"{sure:g} s; **stays on**"
        cells = [*[said] * len(STATES), *["refused"] * len(REFUSED)]
        lines.append(f"| {fault} | {laser} | {' | '.join(cells)} |")
    can, cannot = list[str](), list[str]()
    for name in sorted(known()):
        if driver(name).kind in ("laser", "shutter"):
            (can if "watchdog" in (driver(name).settings or {}) else cannot).append(f"`{name}`")
    lines += ["", f"Drivers with a dead-man: {', '.join(can)}. Without: {', '.join(cannot)}."]
    return "\n".join(lines)


def main() -> int:
    """Try every combination, and print what became of it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faults", nargs="*", default=list(FAULTS), choices=list(FAULTS))
    parser.add_argument("--states", nargs="*", default=list(STATES), choices=STATES)
    parser.add_argument("--benches", nargs="*", default=["one arm"], choices=list(BENCHES))
    parser.add_argument("--table", action="store_true", help="only print the table of the docs")
    parser.add_argument("--only-dead-man", action="store_true", help="no bench without dead-men")
    asked = parser.parse_args()
    if asked.table:
        print(table())
        return 0
    os.environ["PICO_EMULATED_PACE"] = "10"
    cells, wrong = list[Cell](), list[str]()
    with tempfile.TemporaryDirectory() as folder:
        for number, (kind, dead_man) in enumerate(product(asked.benches, (True, False)[: 2 - asked.only_dead_man])):
            faults = asked.faults if dead_man else [fault for fault in asked.faults if fault in GUARDLESS]
            if not faults:
                continue
            chain = Chain(Path(folder) / f"lab{number}", dead_man=dead_man, kind=kind)
            try:
                if BENCHES[kind] and not refuses_teleoperation(chain.lab, "hardware"):
                    wrong.append("a teleoperation was not refused")
                for fault, state in product(faults, [s for s in asked.states if s != "moving" or BENCHES[kind]]):
                    cells.append(chain.cell(fault, state))
                    _show(cells[-1])
            finally:
                chain.close()
    return _judged(cells, wrong)


def _show(cell: Cell) -> None:
    said = ", ".join(f"{n} {'stays on' if t is None else f'{t:.2f} s'}" for n, t in cell.ended.items())
    how = "" if cell.dead_man else ", no dead-man"
    print(f"{cell.bench}: {cell.fault} x {cell.state}{how}: {said}{'' if cell.told else '; nothing told'}", flush=True)


def _judged(cells: list[Cell], wrong: list[str]) -> int:
    print()
    for fault in FAULTS:
        times = [t for c in cells if c.fault == fault and c.dead_man for t in c.ended.values() if t is not None]
        if times:
            print(f"{fault}: {len(times)} lasers went dark, the last one after {max(times):.2f} s")
    on = [c for c in cells if None in c.ended.values()]
    print(f"light stayed on in {len(on)} of {len(cells)} cells: " + ", ".join(f"{c.fault} x {c.state}" for c in on))
    wrong += [one for cell in cells for one in cell.wrong]
    print("\n".join(["", *wrong]) if wrong else "every bar was met")
    return 3 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
