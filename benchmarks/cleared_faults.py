"""Faults of an emulated arm and its gripper, each cleared by what PICO prints: `python benchmarks/cleared_faults.py`.

The example `shel` with an emulated arm, mounts, cameras and switches, at ten times real pace, is brought to and fro
between two of its states. On the way, with an empty hand or with a part in it, or at rest, the arm or its gripper comes
to a fault. Then a person follows PICO alone: the commands in its hints, and at each question what the text asks to do
at the table (release the emergency stop, switch the box off and on). `--yes` is tried first and must not clear what a
person must look at.

A case is right if at most six commands bring the bench to the state that was asked for, by the world behind the
emulators: the part stands there, the hand is empty, no fault is left. The exit code is 1 if any is wrong.
`--cases N` takes only the first N of the 20, `--only C31` those of one number.
"""

from __future__ import annotations

import argparse
import io
import os
import re
import shlex
import shutil
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT)]
os.environ.setdefault("PICO_EMULATED_PACE", "10")

from pico.backends.emulated.world import EmulatedWorld  # noqa: E402
from pico.backends.hardware import links  # noqa: E402
from pico.history.examples.example import make_example  # noqa: E402
from pico.manifest.load import load_folder  # noqa: E402
from pico.places.bench import BenchPlace  # noqa: E402

BENCH = "--bench emulated"
COMMANDS = 6
"""So many commands may be needed after the fault."""
PART, GOALS = "p1", ("C2", "C1")
"""What is moved to and fro."""


@dataclass(frozen=True)
class Case:
    """A fault (`C31` of the arm, `G11` of the gripper), and when it comes: with an `empty` hand on its way, while it
    `carries`, or at `rest`; `pressed`: an emergency stop stays pressed."""

    fault: str
    when: str
    pressed: bool = False

    def __str__(self) -> str:
        return f"{self.fault} {self.when}{', pressed' if self.pressed else ''}"


CASES = (
    Case("C31", "carries"), Case("G11", "rest"), Case("C1", "carries", pressed=True), Case("C31", "empty"),
    Case("C22", "carries"), Case("C23", "empty"), Case("C24", "carries"), Case("C35", "carries"),
    Case("C2", "rest", pressed=True), Case("C3", "empty", pressed=True), Case("C11", "carries"), Case("C17", "rest"),
    Case("C19", "carries"), Case("C21", "empty"), Case("C30", "carries"), Case("C38", "rest"), Case("C60", "empty"),
    Case("G23", "carries"), Case("G33", "empty"), Case("C31", "rest"),
)  # fmt: skip
"""The first three are of three kinds: a collision, the gripper, an emergency stop."""


def arm() -> Any:
    """Return the emulated arm of the bench that is open in this process; raises ValueError if there is none yet."""
    (found,) = links._open.values()
    if found.emulators is None:
        raise ValueError("the emulators are not up")
    return next(one for one in found.emulators._running if hasattr(one, "joints"))


def hurt(case: Case) -> None:
    """Let the arm or its gripper come to the fault of a case."""
    number = int(case.fault[1:])
    if case.fault[0] == "G":
        arm().gripper_fault(number)
    elif case.pressed:
        arm().press(number)
    else:
        arm().fault(number)


def due(case: Case) -> bool:
    """Return whether the fault of a case comes now."""
    (found,) = links._open.values()
    holding = found.world is not None and bool(found.world.world().robots["arm1"].holding)  # type: ignore[attr-defined]
    return bool(arm().box.state == 1 and holding == (case.when == "carries"))


@contextmanager
def coming(case: Case) -> Iterator[threading.Event]:
    """Let the fault of a case come while something goes on; give what says whether it did."""
    over, done = threading.Event(), threading.Event()

    def wait() -> None:
        while not over.is_set() and not done.is_set():
            try:
                if due(case):
                    hurt(case)
                    done.set()
            except (ValueError, StopIteration):  # no bench is open yet
                pass
            time.sleep(0.005)

    thread = threading.Thread(target=wait)
    thread.start()
    try:
        yield done
    finally:
        over.set()
        thread.join()


class Person(io.StringIO):
    """Who sits at the terminal: does what the text on the screen asks for, and answers yes."""

    def __init__(self, screen: io.StringIO) -> None:
        super().__init__()
        self.screen, self.read = screen, 0

    def isatty(self) -> bool:
        return True

    def readline(self, size: int = -1) -> str:  # type: ignore[override]
        text = " ".join(self.screen.getvalue()[self.read :].split())
        self.read = len(self.screen.getvalue())
        if "Check at the table" in text:
            if "release it" in text or "close the loop" in text:
                arm().release()
            if "off at its emergency stop and on again" in text:
                arm().restart()
            if "press the emergency stop" in text:
                arm().press(1)
                arm().release()
        return "y\n"


def called(words: str, *, attended: bool = True) -> tuple[int, str]:
    """Call `pico`, with a person at the terminal; return its exit code and all that it printed."""
    from pico_cli.main import main

    screen, stdin = io.StringIO(), sys.stdin
    sys.stdin = Person(screen) if attended else io.StringIO()
    try:
        with redirect_stdout(screen), redirect_stderr(screen):
            code = int(main(shlex.split(words)))
    finally:
        sys.stdin = stdin
    return code, re.sub(r"\x1b\[[0-9;]*m", "", screen.getvalue())


def next_command(text: str, otherwise: str) -> str:
    """Return the first command that a text names to go on with, else what was to be done."""
    named = re.findall(r"`pico ([^`]*)`", " ".join(text.split()))
    on = [words for words in named if re.search(r"\b(recover|resume|apply)\b", words)]
    return next((words for words in on if "recover" in words), on[0] if on else otherwise)


class Bench:
    """The example with emulated devices, in `folder`."""

    def __init__(self, folder: Path) -> None:
        make_example("shel", folder)
        lab = folder / "lab.yaml"
        lab.write_text(lab.read_text().replace("pixels: [2448, 2048]", "pixels: [1224, 1024]"))
        shutil.copy(ROOT / "examples" / "devices.yaml", folder)
        os.chdir(folder)
        self.setup, _ = load_folder(folder).require()
        self.place = BenchPlace(folder, "emulated")
        code, text = called(f"{BENCH} apply C1 --yes", attended=False)
        assert code == 0, text

    def wrong(self, case: Case, goal: str) -> Iterator[str]:
        """Bring the part to a goal with a fault on the way; yield what is wrong with how that is mended."""
        want = f"{BENCH} apply {goal}"
        if case.when == "rest":
            self.at_rest(case)
        with coming(case) if case.when != "rest" else _already() as came:
            code, text = called(want)
        if not came.is_set():
            yield f"the fault never came: {text}"
            return
        by_person = case.fault not in ("C21", "C24", "C60")
        if by_person and (code == 0 or case.fault not in text or " recover`" not in text):
            yield f"exit code {code}, and {case.fault} with `pico recover` is not named: {text}"
        if by_person:
            refused, said = called(f"{BENCH} recover --yes", attended=False)
            if refused == 0 or not self.faulty():
                yield f"--yes cleared {case.fault}: {said}"
        for _ in range(COMMANDS):
            words = next_command(text, want)
            words = words if "--bench" in words or "--backend" in words or "--emulate" in words else f"{BENCH} {words}"
            code, text = called(words)
            if code == 0 and self.reached(goal):
                break
            if code == 0:
                text = ""
        else:
            yield f"{goal} was not reached by {COMMANDS} commands; the last was `pico {words}` ({code}): {text}"
        if self.faulty():
            yield f"a fault is left: {self.faulty()}"

    def at_rest(self, case: Case) -> None:
        """Let the fault come while nothing moves: between two commands."""
        from pico.bench.bench import Bench as Opened

        with Opened.open(Path.cwd(), bench=self.place) as bench:
            bench.observe()
            hurt(case)

    def faulty(self) -> str:
        """Return the faults that the emulated arm keeps; '' for none."""
        kept = str(EmulatedWorld(self.setup, self.place).recalled("arm1", "faults") or "")
        return "" if kept in ("", "0 0 0") else kept

    def reached(self, goal: str) -> bool:
        """Return whether the part stands where the goal has it, by the world, with an empty hand."""
        now = EmulatedWorld(self.setup, self.place).world()
        body, target = now.components[PART], {"C1": self.setup.lab.slots["storage/b1"].pose}.get(goal)
        if target is None:
            from pico.model.pose import Pose

            target = Pose(290, 420, 0)
        stands = body.presence == "seen" and body.pose is not None and body.pose.distance(target) < 1.0
        return stands and now.robots["arm1"].holding is None


@contextmanager
def _already() -> Iterator[threading.Event]:
    done = threading.Event()
    done.set()
    yield done


def tried(folder: Path, cases: tuple[Case, ...], told: Callable[[str], None]) -> int:
    """Try some cases on one bench, and return how many are wrong; `told`: hears of each."""
    bench, count = Bench(folder), 0
    for number, case in enumerate(cases):
        began = time.process_time()
        found = list(bench.wrong(case, GOALS[number % 2]))
        count += bool(found)
        told(f"{case}: {'; '.join(found) or 'cleared'} ({time.process_time() - began:.1f} s of CPU)")
    return count


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--cases", type=int, default=len(CASES))
    parser.add_argument("--only")
    given = parser.parse_args()
    cases = tuple(case for case in CASES if given.only in (None, case.fault))[: given.cases]
    with tempfile.TemporaryDirectory() as folder:
        wrong = tried(Path(folder) / "shel", cases, print)
        os.chdir(ROOT)
    print(f"{len(cases)} faults: {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
