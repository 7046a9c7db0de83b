"""The labs that `damaged_state.py` damages, and the process of a command in one of them."""

from __future__ import annotations

import os
import re
import resource
import shlex
import shutil
import signal
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from pico.resources import labs_dir

TIMEOUT = 90.0
"""The longest time that a command may take [s of the wall's clock]; one that takes longer hangs."""
KILLED = -signal.SIGKILL
SIM = ".pico/benches/sim"
WAIVED = "  arming: {waived:"
ROLES = "  arming: {roles: {laser_user: {people: [Ada Lovelace], laser_class: 3R, hours: 8}}}\n"
RECIPE = "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: %s}\n%ssteps:\n  - set: {hwp.angle: 21}\n"
TERMS = "unattended: {laser_class: 3R, hours: {from: '0:00', to: '23:59'}, stop: [], every: 10 min, end: [shut]}\n"
PEOPLE = {f"GIT_{who}_{what}": said for who in ("AUTHOR", "COMMITTER") for what, said in
          (("NAME", "Ada Lovelace"), ("EMAIL", "ada@example.org"))}  # fmt: skip
EMULATED = "--backend hardware --emulate"

BEGINNING = ("apply e1 --yes", "laser arm laser --hours 8 -y", "apply --yes", "commit -m base")
LIGHT = (
    "optimize null p2 cam --yes", "morning --yes --accept", "look", "run short --yes",
    f"{EMULATED} set cam exposure=8 --yes", "laser disarm laser", "run night --yes --unattended",
    "laser arm laser --hours 8 -y",
)  # fmt: skip
END = ("sim faults drop=0.0", "set p1 angle=3 --yes", "plan e1", "bench use sim", "runs list", "stop")


@dataclass(frozen=True)
class Answer:
    """What a command answered; the exit code of one that was killed is negative."""

    code: int
    text: str
    """Standard output, then standard error."""
    seconds: float
    """Processor time [s]."""


class Commands:
    """Runs commands in a lab, each in a process that is forked from this one, which has imported what they need."""

    def __init__(self, lab: Path, plant: Callable[[], None] | None = None) -> None:
        self.lab, self._out, self._plant = lab, lab.parent / "said", plant

    def __call__(self, line: str, hook: Callable[[], None] | None = None) -> Answer:
        """Run a command line, of the shell unless it begins with `pico`; `hook` is called in its process first."""
        words = shlex.split(line)
        outs = [Path(f"{self._out}.{name}") for name in ("out", "err")]
        for path in outs:
            path.unlink(missing_ok=True)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        process = os.fork()
        if process == 0:
            self._become(words, outs, hook)
        code = self._ended(process)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        text = "\n".join(path.read_text(errors="replace") for path in outs if path.exists())
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return Answer(code, text, seconds)

    def _become(self, words: list[str], outs: list[Path], hook: Callable[[], None] | None) -> None:
        from cli.warm import _become

        try:
            environment = {k: v for k, v in os.environ.items() if not k.startswith(("PICO_", "GIT_"))}
            environment |= PEOPLE | {"COLUMNS": "400", "PICO_EMULATED_PACE": "60"}
            if words[0] != "pico":
                for path, stream in zip(outs, (1, 2), strict=True):
                    os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT, 0o600), stream)
                os.chdir(self.lab)
                os.execvpe(words[0], words, environment)
            for patch in (self._plant, hook):
                if patch:
                    patch()
            document = {"environment": environment, "folder": str(self.lab), "words": words[1:], "confined": None}
            _become({"out": str(outs[0]), "err": str(outs[1]), **document})
        finally:
            os._exit(127)

    def _ended(self, process: int) -> int:
        ends = time.monotonic() + TIMEOUT
        pause = 0.002
        while True:
            ended, status = os.waitpid(process, os.WNOHANG)
            if ended:
                return os.waitstatus_to_exitcode(status)
            if time.monotonic() > ends:
                os.kill(process, signal.SIGKILL)
            time.sleep(pause)
            pause = min(0.02, 1.5 * pause)


def copy_lab(source: Path, to: Path) -> None:
    """Copy a lab; large files that are never changed are linked."""

    def copied(a: str, b: str) -> None:
        if "/.git/objects/" in a or "/cas/" in a:
            os.link(a, b)
        else:
            shutil.copy2(a, b)

    shutil.rmtree(to, ignore_errors=True)
    shutil.copytree(source, to, copy_function=copied, symlinks=True)


def build_labs(scratch: Path, *, light: bool) -> dict[str, Path]:
    """Make the labs in a folder: `idle`, after a day at the bench; `held`, whose last run was killed while the arm held
    a part; `night`, whose run without people was killed while the laser was open. `light`: the day has searches, a
    morning, recipes and emulated devices. All have lived in `scratch/lab`."""
    from pico.history.examples.example import make_example
    from pico.history.git.attributes import install

    lab = scratch / "lab"
    run = Commands(lab)
    make_example("shel", lab)
    install(lab)
    text = (lab / "lab.yaml").read_text()
    text = re.sub(rf"(?m)^{re.escape(WAIVED)}.*\n", ROLES, text)
    part = "    type: half_wave_plate\n"
    (lab / "lab.yaml").write_text(text.replace(part, f"{part}    sample: WSe2-041\n    dose_budget: 100000\n"))
    shutil.copy(labs_dir().parent / "examples" / "devices.yaml", lab)
    for name, terms in (("short", ""), ("night", TERMS)):
        (lab / "recipes" / f"{name}.yaml").write_text(RECIPE % (name, terms))
    for words in ("config user.name 'Ada Lovelace'", "config user.email ada@example.org", "add -A", "commit -qm lab"):
        subprocess.run(["git", *shlex.split(words)], cwd=lab, check=True, env=os.environ | PEOPLE)
    for line in (*BEGINNING, *(LIGHT if light else ()), *END):
        _succeed(run, line)
    labs = {"idle": scratch / "idle"}
    subprocess.run(["git", "gc", "-q"], cwd=lab, check=True)
    copy_lab(lab, labs["idle"])
    for name, line, when in (("held", "apply e1 --yes", '"held"'), ("night", "run night --yes --unattended", "")):
        copy_lab(labs["idle"], lab)
        if name == "night":
            _succeed(run, "laser arm laser --unattended --hours 8 -y")
        if (killed := run(f"pico {line}", hook=partial(die_when, when))).code != KILLED:
            raise RuntimeError(f"`pico {line}` was not killed: {killed}")
        labs[name] = scratch / name
        copy_lab(lab, labs[name])
    return labs


def _succeed(run: Commands, line: str) -> None:
    answer = run(f"pico {line}")
    if answer.code not in (0, 2):
        raise RuntimeError(f"`pico {line}` failed: {answer.text}")


def die_when(words: str) -> None:
    """Have this process kill itself once the simulated table is stored with `words` in it; without words after the
    first operation."""
    from pico.backends.sim import session

    def die(_: Path) -> None:
        os.kill(os.getpid(), signal.SIGKILL)

    if not words:
        after_operations(die)
        return
    save = session.save_world

    def saving(*given: Any, **more: Any) -> None:
        save(*given, **more)
        if words in (Path.cwd() / SIM / "world.json").read_text():
            die(Path())

    session.save_world = saving


def after_operations(work: Callable[[Path], None]) -> None:
    """Have this process call `work` with the folder of the lab after each operation that the journal has as ended."""
    from pico.runs.journal import Journal

    add = Journal.ended

    def ended(self: Journal, result: object, token: int) -> None:
        add(self, result, token)  # type: ignore[arg-type]
        work(Path.cwd())

    Journal.ended = ended  # type: ignore[method-assign]
