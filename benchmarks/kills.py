"""Kills real processes: `python benchmarks/kills.py --kills 10000 --applies 300 --git 1000`.

`--kills`: of a process that runs executor and journal on an instant bench, half at random instants, half just before or
after a record of the journal; after every eight one is left alone, and must reach its goal. `--applies`: of whole
`pico apply` commands on the simulated bench of the case study, at random instants; after each, the same command is
run to its end. `--git`: of commands that write files, index and branches (`git_kills.py`). Prints the counts; the exit
code is 1 where anything was lost, repeated, or not reached.
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from pico.places.bench import BenchPlace

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "execution")]
REVISIONS = ("C1", "C3", "E1-1", "E1-3", "E2-3", "E3-2")


def instant(kills: int, first: int) -> int:
    """Kill processes on the instant bench; return how many were wrong."""
    from killing import kill_many

    done = wrong = checked = ended = 0
    began, batch = time.monotonic(), first
    while done < kills:
        batch += 1
        with tempfile.TemporaryDirectory() as folder:
            score = kill_many(Path(folder), batch * 10_000, min(200, kills - done))
            done, wrong = done + score.kills, wrong + score.wrong
            checked, ended = checked + score.checked, ended + score.ended
            told = Path(folder) / "wrong.txt"
            if told.exists():
                print(told.read_text(), end="", flush=True)
    print(
        f"{done} kills of executor and journal ({ended} more ended first), {checked} runs left alone after them, "
        f"{time.monotonic() - began:.0f} s: {wrong} lost, repeated or not reached",
        flush=True,
    )
    return wrong


def forked(folder: Path, *words: str, out: str = "out.txt") -> int:
    """Start a command of PICO in a process of its own, and return its number."""
    from pico_cli.main import main

    (folder / out).write_text("")
    child = os.fork()
    if child:
        return child
    code = 1
    try:
        to = os.open(folder / out, os.O_WRONLY)
        os.dup2(to, 1)
        os.dup2(to, 2)
        os.chdir(folder)
        code = main(words)
        sys.stdout.flush()
    except KeyboardInterrupt:
        code = 130  # before the command itself had begun
    finally:
        os._exit(code)


def command(folder: Path, *words: str, kill_after: float = 0.0) -> int | None:
    """Run a command of PICO in a process of its own; return its exit code, None where it was killed."""
    child = forked(folder, *words)
    if kill_after:
        time.sleep(kill_after)
        os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    return None if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)


def repeated(folder: Path) -> list[str]:
    """Return the operations that began though what they were to bring about was so, by the journal."""
    from pico.edge.recovery import arrived
    from pico.history.lab.folder import LabFolder
    from pico.model.operation import operation_from_json
    from pico.model.pose import Pose
    from pico.runs.journal import Journal

    setup = LabFolder(folder).setup
    journal, found = Journal(folder / ".pico/benches/sim" / "journal.sqlite"), []
    for record in journal.records():
        if record.kind != "started" or "pose" not in record.data or record.data["presence"] != "seen":
            continue
        op = operation_from_json(journal.records(key=record.key)[0].data)
        if op.primitive in ("move", "stow") and arrived(setup, op, Pose(**record.data["pose"])):
            found.append(record.key)
    journal.close()
    return found


def moved(folder: Path, before: dict[str, object]) -> list[str]:
    """Return the parts that are elsewhere than `before` though the journal holds no start of an operation on them."""
    from pico.runs.journal import Journal

    journal = Journal(folder / ".pico/benches/sim" / "journal.sqlite")
    begun = {r.component for r in journal.records() if r.kind == "started"}
    journal.close()
    return [n for n, pose in places(folder).items() if pose != before[n] and n not in begun]


def places(folder: Path) -> dict[str, object]:
    """Return where the parts of the simulated bench are."""
    from pico.backends.sim.store import load_world
    from pico.history.lab.folder import LabFolder

    world, _ = load_world(LabFolder(folder).setup, BenchPlace(folder, "sim"))
    return {n: (body.presence, body.pose) for n, body in world.components.items()}


def preload() -> None:
    """Load what a run needs, once, before processes are forked."""
    import mujoco  # noqa: F401


def applies(kills: int, fidelity: str) -> int:
    """Kill whole commands; return how many were wrong."""
    from pico.history.examples.example import make_example

    preload()
    draw, count = random.Random(1), Counter[str]()
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "shel"
        make_example("shel", folder)
        before = places(folder)
        while count["killed"] < kills:
            goal = draw.choice(REVISIONS)
            words = ("apply", goal, "--auto-approve", "--fidelity", fidelity)
            longest = 0.9 if fidelity == "kinematic" else 8.0
            code = command(folder, *words, kill_after=draw.uniform(0.1, longest))
            count["killed" if code is None else "ended first"] += 1
            count["lost"] += len(moved(folder, before))
            count["held"] += "held" in {p[0] for p in places(folder).values()}  # type: ignore[index]
            again = command(folder, *words)
            reached = command(folder, "plan", goal, "--detailed-exitcode") == 0
            if again != 0 or not reached:
                count["not reached"] += 1
                print(f"{goal}: {(folder / 'out.txt').read_text()[-600:]}", flush=True)
                command(folder, "sim", "reset")
        count["repeated"] = len(repeated(folder))
    said = ", ".join(f"{n} {count[n]}" for n in ("killed", "ended first", "held", "lost", "repeated", "not reached"))
    print(f"pico apply ({fidelity}): {said}; {time.monotonic() - began:.0f} s", flush=True)
    return count["lost"] + count["repeated"] + count["not reached"]


def main() -> int:
    """Kill."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="first batch of seeds, so that several can run at once")
    parser.add_argument("--applies", type=int, default=300)
    parser.add_argument("--git", type=int, default=0, help="kills of Git commands: see benchmarks/git_kills.py")
    parser.add_argument("--fidelity", default="kinematic")
    given = parser.parse_args()
    wrong = instant(given.kills, given.first) if given.kills else 0
    wrong += applies(given.applies, given.fidelity) if given.applies else 0
    if given.git:
        from git_kills import git_kills

        wrong += git_kills(given.git, given.first)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
