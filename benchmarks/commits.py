"""Commits at once, commits killed, and what a capture costs:

    python benchmarks/commits.py --processes 4 --each 50 --kills 500 --capture 1000

`--processes`, `--each`: so many processes make so many commits each in one repository, half of them of an edit in a
file of their own, half of a part that somebody moved by hand and whose file all of them share. Each commit must hold
its own change and nothing else, and none may be missing. `--kills`: the whole process group of `pico commit` is killed,
half at random instants, half just before or after one of its steps (files, objects, index, hooks, refs). Afterwards
`git fsck --strict` must have nothing to say, HEAD must be the old commit or the new one, index and files not older than
HEAD; and the next `pico commit` must work, with nothing left lying about and every run in exactly one commit.
`--capture`: one part of so many is moved, once with 25 parts a file and once with all of them in one; prints the CPU
seconds of `pico capture` and of `pico commit`, with the git commands that they start, and checks the bytes.
Prints counts; the exit code is 1 where anything was wrong, 3 where only a capture took too long.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import resource
import signal
import subprocess
import sys
import sysconfig
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

from pico.places.bench import BenchPlace

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT)]

from pico_cli.main import main as command  # noqa: E402

from pico.backends.sim.store import load_world, save_world  # noqa: E402
from pico.bench import commits as committing  # noqa: E402
from pico.bench.bench import Bench  # noqa: E402
from pico.history.git import command as git  # noqa: E402
from pico.history.lab import files as write_files  # noqa: E402
from pico.history.writing import index_lock, locked_git  # noqa: E402
from pico.model.observation import ObservedValue  # noqa: E402
from pico.model.state import place_of  # noqa: E402

LOADED = committing  # before the fork, so that no child need import it
SECONDS = 1.0
"""What one capture may take at 1,000 components [CPU s]."""
PITCH, ROWS, FILE = 100.0, 40, 25
IDENTITY = {f"GIT_{who}_{what}": said for who in ("AUTHOR", "COMMITTER")
            for what, said in (("NAME", "A Physicist"), ("EMAIL", "physicist@localhost"))}  # fmt: skip
QUIET = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull}


def ask(folder: Path, *words: str) -> str:
    """Run git, which must succeed, and return what it says."""
    done = subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"git {' '.join(words)}: {done.stderr or done.stdout}")
    return done.stdout


# A lab of any size, with the simulated table as its manifests say.


def write_lab(folder: Path, parts: int, per_file: int) -> None:
    """Write a lab of polarizers in rows on a table, so many a file, and commit it; the simulated table stands so."""
    size = PITCH * ROWS
    lab = [
        "apiVersion: pico/v1\nkind: Lab\nmetadata: {name: large}",
        f"table: {{size: [{size}, {size}], beam_height: 70}}",
        "robots: {arm1: {model: gantry, mount: {x: 0, y: 0}}}\nslots:",
        *(f"  rack/s{i}: {{x: {size + PITCH * (1 + i // ROWS)}, y: {PITCH * (i % ROWS + 0.5)}}}" for i in range(parts)),
        "inventory:",
        *(f"  c{i:04}:\n    type: linear_polarizer\n    marker: {i}\n    home: rack/s{i}" for i in range(parts)),
    ]
    (folder / "state").mkdir(parents=True)
    (folder / "lab.yaml").write_text("\n".join(lab) + "\n")
    (folder / ".gitignore").write_text(".pico/\n")
    for first in range(0, parts, per_file):
        lines = ["# one sub-assembly\napiVersion: pico/v1\nkind: LabState\nmetadata: {lab: large}\ncomponents:"]
        for i in range(first, min(parts, first + per_file)):
            x, y = PITCH * (i % ROWS + 0.5), PITCH * (i // ROWS + 0.5)
            pose = f"    pose:\n      x: {x}\n      y: {y}\n      yaw: 0"
            lines.append(f"  c{i:04}:   # part {i}\n{pose}\n    angle: 0.0")
        (folder / "state" / f"group{first // per_file:03}.yaml").write_text("\n".join(lines) + "\n")
    for words in (["init", "-q", "-b", "main"], ["add", "."], ["commit", "-qm", "a large bench"]):
        ask(folder, *words)
    with Bench.open(folder) as bench:
        world, _ = load_world(bench.setup, BenchPlace(folder, "sim"))
        angle = {"angle": ObservedValue(value=0.0, status="known")}
        bodies = {
            name: replace(body, pose=place_of(bench.setup, bench.state, name)[1], values=angle)
            for name, body in world.components.items()
        }
        save_world(BenchPlace(folder, "sim"), replace(world, components=bodies))


def state_file(folder: Path, part: str, per_file: int) -> Path:
    """Return the manifest that holds a part."""
    return folder / "state" / f"group{int(part[1:]) // per_file:03}.yaml"


def value_of(text: str, part: str, key: str) -> float:
    """Return what a manifest's text says of a part: `x` or `angle`."""
    block = text.split(f"  {part}:", 1)[1].split("\n  c", 1)[0]
    return float(block.split(f"{key}: ", 1)[1].split("\n", 1)[0])


# Many at once.


def forked(work: Callable[[], int], out: Path) -> int:
    """Do something in a process, and process group, of its own, and return its number."""
    child = os.fork()
    if child:
        return child
    code = 1
    try:
        os.setsid()
        to = os.open(out, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        os.dup2(to, 1)
        os.dup2(to, 2)
        code = work()
        sys.stdout.flush()
    except BaseException as exc:  # the child must end here, whatever happens
        os.write(2, f"{type(exc).__name__}: {exc}\n".encode())
    finally:
        os._exit(code)


def ended(child: int) -> int | None:
    """Wait for a process; return its exit code, None where it was killed."""
    _, status = os.waitpid(child, 0)
    return None if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)


def worker(folder: Path, number: int, each: int, shared: int) -> int:
    """Commit so often; return how many commits failed."""
    os.chdir(folder)
    failed = 0
    for turn in range(each):
        message = f"worker {number}, turn {turn}"
        if turn % 2:
            part = f"c{FILE * (number + 1):04}"  # the first of a file of its own
            path = state_file(folder, part, FILE)
            text = path.read_text()
            before, now = (f"angle: {angle}" for angle in (value_of(text, part, "angle"), float(turn)))
            fresh = path.with_suffix(".new")
            fresh.write_text(text.replace(before, now, 1))
            fresh.replace(path)
            words = ["commit", "-m", message, "--planned", part]
        else:
            part = f"c{number:04}"  # in a file that all of them share
            while command(["sim", "nudge", part, "--dx", "1"]) == 5:
                time.sleep(0.01)
            words = ["commit", "-m", message, "--capture", part]
        failed += command(words) != 0
    return min(failed, 100)


def at_once(processes: int, each: int) -> int:
    """Let processes commit at once; return how much was wrong."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "lab"
        write_lab(folder, FILE * (processes + 1), FILE)
        began = time.monotonic()
        out = Path(name) / "out.txt"
        children = [forked(lambda n=n: worker(folder, n, each, FILE), out) for n in range(processes)]
        refused = sum(ended(child) or 0 for child in children)
        took = time.monotonic() - began
        wrong = refused + len(list(faults_of_history(folder, processes, each)))
        for fault in faults_of_history(folder, processes, each):
            print(f"  wrong: {fault}")
        if refused:
            print(out.read_text()[-2000:])
    print(f"{processes} processes, {each} commits each at once, {took:.0f} s: {refused} refused, {wrong} wrong")
    return wrong


def faults_of_history(folder: Path, processes: int, each: int) -> Iterator[str]:
    """Yield what is wrong with a repository in which workers committed."""
    subjects = ask(folder, "log", "--format=%s").splitlines()
    wanted = [f"worker {n}, turn {t}" for n in range(processes) for t in range(each)]
    for message in wanted:
        if subjects.count(message) != 1:
            yield f"{subjects.count(message)} commits of {message}"
    if len(subjects) != len(wanted) + 1:
        yield f"{len(subjects)} commits, not {len(wanted) + 1}"
    for line in ask(folder, "log", "--format=%x00%s", "--numstat").split("\0")[1:]:
        subject, *files = [part for part in line.splitlines() if part]
        counted = [f.split("\t")[:2] for f in files]
        if subject.startswith("worker") and counted != [["1", "1"]]:
            yield f"{subject} changed {files}"
    yield from unclean(folder)


def unclean(folder: Path) -> Iterator[str]:
    """Yield what lies about that should not."""
    if said := ask(folder, "status", "--porcelain").strip():
        yield f"git status says {said}"
    # the kernel's locks: files that stay; and that of git's own housekeeping, which git then leaves out
    known = ("write.lock", "bench.lock", "maintenance.lock")
    dirty = [p for p in (folder / ".git").rglob("*.lock") if p.name not in known]
    dirty += [p for p in folder.rglob("*.tmp") if ".git" not in p.parts]
    yield from (f"{p.relative_to(folder)} is left" for p in dirty)
    checked = subprocess.run(["git", "fsck", "--strict", "--no-dangling"], cwd=folder, capture_output=True, check=False)
    if checked.returncode or b"error" in checked.stderr:
        yield f"git fsck: {checked.stdout.decode()} {checked.stderr.decode()}"


# Kills.


@dataclass
class Steps:
    """Kills its own process group at the `at`-th step, before or after it."""

    at: int
    after: bool
    done: int = 0
    patched: list[tuple[object, str]] = field(default_factory=list)

    def watch(self, owner: object, name: str) -> None:
        """Count calls of a function as steps."""
        real = getattr(owner, name)

        def counted(*arguments: object, **options: object) -> object:
            self.done += 1
            if self.done == self.at and not self.after:
                os.killpg(0, signal.SIGKILL)
            try:
                return real(*arguments, **options)
            finally:
                if self.done >= self.at and self.after:
                    os.killpg(0, signal.SIGKILL)

        setattr(owner, name, counted)


HOOKS = ("pre-commit", "prepare-commit-msg", "commit-msg", "post-commit", "reference-transaction")


def commit_killed(folder: Path, words: list[str], rng: random.Random, span: float, out: Path) -> str:
    """Start `pico commit` and kill its process group; return how it was to be killed."""
    way = rng.choice(("instant", "instant", "step", "hook"))
    hook, at = rng.choice(HOOKS), rng.randint(1, 3)
    for name in HOOKS:
        (folder / ".git" / "hooks" / name).unlink(missing_ok=True)
    if way == "hook":
        path = folder / ".git" / "hooks" / hook
        count = folder / ".git" / "count"
        count.write_text("0")
        path.write_text(
            f'#!/bin/sh\nn=$(($(cat "{count}") + 1)); echo $n > "{count}"\n'
            f"[ $n -ge {at if hook == 'reference-transaction' else 1} ] && kill -9 0\nexit 0\n"
        )
        path.chmod(0o755)

    def work() -> int:
        os.chdir(folder)
        if way == "step":
            steps = Steps(rng.randint(1, 34), rng.random() < 0.5)
            for owner, name in ((git, "run"), (os, "link"), (Path, "replace"), (Path, "unlink"),
                                (locked_git, "copy_index"), (write_files, "write_file"),
                                (index_lock, "_claimed")):  # fmt: skip
                steps.watch(owner, name)
        return command(words)

    child = forked(work, out)
    if way == "instant":
        time.sleep(rng.uniform(0, span))
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)
    said = f"{way} {hook if way == 'hook' else ''}"
    ended(child)
    for name in HOOKS:
        (folder / ".git" / "hooks" / name).unlink(missing_ok=True)
    (folder / ".git" / "count").unlink(missing_ok=True)
    return said


def after_kill(folder: Path, part: str, old: float, new: float, before: str) -> Iterator[str]:
    """Yield what is wrong right after a kill: git's own reading of HEAD, index and files."""
    checked = subprocess.run(["git", "fsck", "--strict", "--no-dangling"], cwd=folder, capture_output=True, check=False)
    if checked.returncode or b"error" in checked.stderr:
        yield f"git fsck: {checked.stdout.decode()} {checked.stderr.decode()}"
    path = "state/group000.yaml"
    texts = (ask(folder, "show", f"HEAD:{path}"), ask(folder, "show", f":{path}"), (folder / path).read_text())
    known = {old: 0, new: 1}
    ages = [known.get(value_of(text, part, "angle"), -1) for text in texts]
    if -1 in ages or ages != sorted(ages):
        yield f"HEAD, index and files hold {ages} (0 old, 1 new): a staged reversal, or a value of nobody's"
    head = ask(folder, "rev-parse", "HEAD").strip()
    if head != before and ask(folder, "rev-parse", "HEAD^").strip() != before:
        yield "HEAD is neither the old commit nor one on it"
    for line in ask(folder, "status", "--porcelain", "--untracked-files=all").splitlines():
        if line[3:] != path and not line[3:].startswith("runs/"):
            yield f"git status says {line}"


def killed(kills: int, seed: int) -> int:
    """Kill commits; return how much was wrong."""
    rng, wrong, ways, whole = random.Random(seed), 0, dict[str, int](), 0
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as name:
        folder, out = Path(name) / "lab", Path(name) / "out.txt"
        write_lab(folder, 4, 4)
        span = 0.0
        runs = list[str]()
        for number in range(kills + 3):
            part, value = f"c{number % 4:04}", float(number % 170 + 1)
            before = ask(folder, "rev-parse", "HEAD").strip()
            old = value_of((folder / "state" / "group000.yaml").read_text(), part, "angle")
            with Bench.open(folder) as bench:
                run = bench.run(bench.plans.single(part, "set", {"angle": str(value)}))
                runs.append(next(e.run for e in run))
                for _ in run:
                    pass
            words = ["commit", "-m", f"kill {number}"]
            if number < 3:  # how long one takes
                start = time.monotonic()
                ended(forked(lambda w=words: os.chdir(folder) or command(w), out))
                span = max(span, time.monotonic() - start)
                continue
            way = commit_killed(folder, words, rng, span * 1.1, out)
            ways[way] = ways.get(way, 0) + 1
            faults = list(after_kill(folder, part, old, value, before))
            whole += ask(folder, "rev-parse", "HEAD").strip() != before
            (out).write_text("")
            code = ended(forked(lambda: os.chdir(folder) or command(["commit", "-m", "again"]), out))
            if code != 0 and "nothing to commit" not in out.read_text():
                faults.append(f"the next commit ended with {code}: {out.read_text()}")
            faults += unclean(folder)
            if value_of(ask(folder, "show", "HEAD:state/group000.yaml"), part, "angle") != value:
                faults.append("the next commit does not hold the value")
            wrong += bool(faults)
            for fault in faults:
                print(f"  wrong, kill {number} ({way}): {fault}", flush=True)
        wrong += sum(1 for fault in faults_of_runs(folder, runs) if not print(f"  wrong: {fault}"))
    told = ", ".join(f"{count} {way.strip()}" for way, count in sorted(ways.items()))
    took = time.monotonic() - began
    print(f"{kills} kills of `pico commit` ({told}), {took:.0f} s: {whole} had committed, {wrong} wrong")
    return wrong


def faults_of_runs(folder: Path, runs: list[str]) -> Iterator[str]:
    """Yield the runs that are not in exactly one commit."""
    added = ask(folder, "log", "--format=", "--name-only", "--diff-filter=A", "--", "runs").split()
    carried = [Path(path).parent.name for path in added if path.endswith("run.json")]
    for run in runs:
        if carried.count(run) != 1:
            yield f"run {run} is in {carried.count(run)} commits"


# What a capture costs.


def cost(folder: Path, *words: str) -> float:
    """Run a command of PICO as a user does; return its CPU seconds, with those of what it starts."""
    script = str(Path(sysconfig.get_path("scripts")) / "pico")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([script, *words], cwd=folder, capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        raise RuntimeError(f"pico {' '.join(words)}: {done.stderr}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def captured(parts: int) -> tuple[int, int]:
    """Capture and commit one moved part of so many; return how much was wrong, and how often it took too long."""
    wrong = late = 0
    for per_file in (FILE, parts):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name) / "lab"
            write_lab(folder, parts, per_file)
            cost(folder, "status")  # compiles, and lets git know of the merge driver
            took = {"capture": 9.9, "commit": 9.9}
            for turn in range(5):
                part = f"c{(parts // 2 + turn) % parts:04}"
                before = {p: p.read_bytes() for p in (folder / "state").iterdir()}
                cost(folder, "sim", "nudge", part, "--dx", "3")
                took["capture"] = min(took["capture"], cost(folder, "capture"))
                after = {p: p.read_bytes() for p in (folder / "state").iterdir()}
                wrong += not one_line(before, after, state_file(folder, part, per_file), part)
                took["commit"] = min(took["commit"], cost(folder, "commit", "-m", "moved"))
                cost(folder, "sim", "nudge", part, "--dx", "3")
                took["both at once"] = min(took.get("both at once", 9.9), cost(folder, "commit", "-m", "moved"))
            late += sum(1 for seconds in took.values() if seconds > SECONDS)
            told = ", ".join(f"{what} {seconds:.2f} CPU s" for what, seconds in took.items())
            print(f"{parts} parts, {min(per_file, parts)} a file: {told} (least of 5)", flush=True)
    return wrong, late


def one_line(before: dict[Path, bytes], after: dict[Path, bytes], file: Path, part: str) -> bool:
    """Whether one line of one file changed, the x of a part by 3 mm, and no other byte."""
    if {p for p in before if before[p] != after[p]} != {file}:
        return False
    was, now = value_of(before[file].decode(), part, "x"), value_of(after[file].decode(), part, "x")
    old, new = before[file].splitlines(keepends=True), after[file].splitlines(keepends=True)
    differing = [i for i, (a, b) in enumerate(zip(old, new, strict=True)) if a != b]
    return len(differing) == 1 and now == was + 3 and new[differing[0]] == b"      x: %s\n" % write(now)


def write(number: float) -> bytes:
    """Return a coordinate as the manifests of this lab have it: with its decimal point."""
    return str(number).encode()


def main() -> int:
    """Print the counts; the exit code is 1 where anything was wrong, 3 where only a capture took too long."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--processes", type=int, default=4)
    parser.add_argument("--each", type=int, default=0, help="commits of each process")
    parser.add_argument("--kills", type=int, default=0)
    parser.add_argument("--capture", type=int, default=0, metavar="PARTS")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    os.environ.update(IDENTITY | QUIET)
    wrong = at_once(given.processes, given.each) if given.each else 0
    wrong += killed(given.kills, given.seed) if given.kills else 0
    off, late = captured(given.capture) if given.capture else (0, 0)
    return 1 if wrong + off else 3 if late else 0


if __name__ == "__main__":
    sys.exit(main())
