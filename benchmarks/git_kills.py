"""Kills Git commands: `python benchmarks/kills.py --kills 0 --applies 0 --git 1000`.

Each trial does one command in a copy of the case study that holds somebody's work (an untracked file, a staged one, an
edit), and sends a signal (KILL, INT, TERM, HUP) to the process, or to all that it started, before or after one of its
calls of git or of its writes, each in its turn, or at a random instant. Then plain git concludes, in one of several
ways, and the same command is called again. Counts half merges (a commit that has the other side as a parent and not its
changes, a table neither as before nor as after), what is blocked (a lock in git's way, a command that can't be called
again), and work that is lost.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "history")]

TABLE = "state/table.yaml"
COMMANDS: dict[str, tuple[str, ...]] = {
    "merge": ("merge", "theirs"), "fast-forward": ("merge", "ahead"), "revert": ("revert", "HEAD"),
    "cherry-pick": ("cherry-pick", "theirs", "ahead"), "checkout": ("checkout", "theirs", "--files-only"),
    "stash": ("stash",), "stash pop": ("stash", "pop"), "commit": ("commit", "-m", "mine", "--planned"),
    "capture": ("capture",),
}  # fmt: skip
EDITING = ("stash", "stash pop", "commit")
"""Commands about an edit of the manifest."""
SIGNALS = (signal.SIGKILL, signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
ENDINGS: tuple[tuple[str, ...], ...] = (
    ("status",), ("commit", "-m", "concluded"), ("commit", "-a", "-m", "concluded"), ("merge", "--abort"),
    ("cherry-pick", "--abort"), ("revert", "--abort"), ("add", "-A"),
)  # fmt: skip
IDENTITY = {f"GIT_{who}_{what}": said for who in ("AUTHOR", "COMMITTER")
            for what, said in (("NAME", "A Physicist"), ("EMAIL", "physicist@localhost"))}  # fmt: skip


@dataclass(frozen=True)
class Kill:
    """How a trial is killed: at a step, or after so long where that is 0."""

    name: str
    by: signal.Signals
    group: bool
    after: bool
    step: int = 0
    seconds: float = 0.0


def git(folder: Path, *words: str) -> tuple[int, str]:
    """Run git; return its exit code and what it says."""
    done = subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def said(folder: Path, *words: str) -> str:
    """Run git, which must succeed, and return what it says."""
    code, text = git(folder, *words)
    if code:
        raise RuntimeError(f"git {' '.join(words)}: {text}")
    return text


def make_origin(folder: Path) -> Path:
    """Write the repository that trials copy: branches `ours` (checked out), `theirs`, and `ahead` of ours."""
    from pico.history.examples.example import make_example
    from pico.history.git.attributes import install

    root = make_example("shel", folder).root
    install(root)
    said(root, "checkout", "-q", "main")
    (root / "log.txt").write_text("day one\n")
    said(root, "add", "-A")
    said(root, "commit", "-q", "-m", "a log")
    for branch, start, before, after in (("theirs", "main", "520", "530"), ("ours", "main", "290", "300"),
                                         ("ahead", "ours", "300", "310")):  # fmt: skip
        said(root, "checkout", "-q", "-b", branch, start)
        (root / TABLE).write_text((root / TABLE).read_text().replace(f"x: {before}", f"x: {after}"))
        (root / f"{branch}.txt").write_text(branch)
        said(root, "add", "-A")
        said(root, "commit", "-q", "-m", branch)
    said(root, "checkout", "-q", "ours")
    return root


def prepare(origin: Path, root: Path, name: str) -> None:
    """Copy the repository, with somebody's work in it."""
    shutil.rmtree(root, ignore_errors=True)
    shutil.copytree(origin, root, symlinks=True)
    (root / "mine.txt").write_text("mine\n")
    if name in EDITING:
        (root / TABLE).write_text((root / TABLE).read_text().replace("x: 300", "x: 305"))
    if name == "stash pop":
        pico(root, "stash")
    if name not in ("merge", "fast-forward"):  # these refuse edits
        (root / "kept.txt").write_text("staged\n")
        said(root, "add", "kept.txt")
        (root / "log.txt").write_text("day one, edited\n")


def pico(root: Path, *words: str, kill: Kill | None = None, count: Path | None = None) -> int | None:
    """Run a command of PICO in a process, and process group, of its own; return its exit code, None where killed."""
    from commit_steps import EVERY, kill_at
    from pico_cli.main import main

    child = os.fork()
    if not child:
        code = 1
        with contextlib.suppress(BaseException):
            os.setsid()
            to = os.open(root.parent / "out.txt", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
            os.dup2(to, 1)
            os.dup2(to, 2)
            os.chdir(root)
            step = kill.step if kill and kill.step else sys.maxsize
            by, group, after = (kill.by, kill.group, kill.after) if kill else (signal.SIGKILL, True, False)
            done = kill_at(step, after=after, watched=EVERY, by=by, group=group) if kill or count else None
            code = main(words)
            sys.stdout.flush()
            if count and done:
                count.write_text(str(done()))
        os._exit(code)
    if kill and not kill.step:
        time.sleep(kill.seconds)
        with contextlib.suppress(ProcessLookupError):
            (os.killpg if kill.group else os.kill)(child, kill.by)
    _, status = os.waitpid(child, 0)
    return None if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)


def faults(root: Path, kill: Kill, ending: tuple[str, ...], texts: set[str]) -> Iterator[tuple[str, str]]:
    """Conclude by plain git, call the command again, and yield what is wrong, by its kind."""
    from commit_steps import guards_ended

    guards_ended(root / ".git")
    table = (root / TABLE).read_text()
    if table not in texts:
        yield "half", f"the table is neither as before nor as after:\n{table}"
    for words in (ending, ("update-index", "--refresh"), ("commit", "--allow-empty", "-q", "-m", "git goes on")):
        code, text = git(root, *words)
        if ".lock" in text or (code and words[0] == "commit" and "--allow-empty" in words):
            yield "blocked", f"git {' '.join(words)}: {text}"
    yield from half(root, "concluded")
    yield from lost(root, kill.name)
    again = pico(root, *COMMANDS[kill.name])
    text = (root.parent / "out.txt").read_text()
    known = ("nothing to commit", "nothing is shelved", "edits that are not committed", "nothing to", "would be lost")
    if again != 0 and not any(word in text for word in known):
        yield "blocked", f"called again: {again}, {text}"
    yield from half(root, "called again")
    yield from lost(root, kill.name)
    code, text = git(root, "fsck", "--strict", "--no-dangling")
    if code or "error" in text:
        yield "half", text
    if [p for p in root.rglob("*.tmp") if not {".git", ".pico"} & set(p.parts)]:
        yield "half", "a temporary file is left"


def half(root: Path, when: str) -> Iterator[tuple[str, str]]:
    """Yield a commit of a branch that has the other side as an ancestor and not its changes."""
    for branch, wanted in (("theirs", "x: 530"), ("ahead", "x: 310")):
        if git(root, "merge-base", "--is-ancestor", branch, "HEAD")[0] == 0:
            for path, text in ((TABLE, wanted), (f"{branch}.txt", branch)):
                if text not in git(root, "show", f"HEAD:{path}")[1]:
                    yield "half", f"{when}: {branch} is merged, and {path} has nothing of it"


def lost(root: Path, name: str) -> Iterator[tuple[str, str]]:
    """Yield work that is neither in the files, nor staged, nor in a commit (plain git may have made one), nor in the
    stash."""

    def kept(word: str, path: str, *places: str) -> bool:
        file = root / path
        texts = [file.read_text()] if file.is_file() else []
        told = [git(root, "show", f"{at}:{path}") for at in places]
        return any(word in text for text in (*texts, *(text for code, text in told if not code)))

    if not kept("mine", "mine.txt", "ours"):
        yield "lost", "the untracked file"
    if name not in ("merge", "fast-forward"):
        if not any(git(root, "show", f"{at}:kept.txt") == (0, "staged\n") for at in ("", "HEAD", "ours")):
            yield "lost", "what was staged"
        if not kept("edited", "log.txt", "HEAD", "ours"):
            yield "lost", "the edit"
    if name in EDITING and not kept("x: 305", TABLE, "HEAD", "stash@{0}"):
        yield "lost", "the edit of the manifest"


LOADED = ("pygit2", "pico_cli.app", "pico.bench.bench", "pico.bench.commits", "pico.bench.plans",
          "pico.backends.sim.device",
          "pico.history.restoring.checked", "pico.history.restoring.stash", "pico.planning")  # fmt: skip
"""What the commands need: loaded once, before processes are forked."""


def measure(origin: Path, root: Path, name: str) -> tuple[int, float, set[str]]:
    """Return how many steps a command has, how long it takes [s], and how the table is before and after it."""
    prepare(origin, root, name)
    before, began = (root / TABLE).read_text(), time.monotonic()
    code = pico(root, *COMMANDS[name], count=root.parent / "count")
    took = time.monotonic() - began
    if code != 0:
        raise RuntimeError(f"{name}: {(root.parent / 'out.txt').read_text()}")
    return int((root.parent / "count").read_text()), took, {before, (root / TABLE).read_text()}


def draw(kills: int, known: dict[str, tuple[int, float, set[str]]], seed: int) -> Iterator[Kill]:
    """Yield kills: of every command in turn, at its steps in turn, nine in ten; the others at random instants."""
    rng, turns = random.Random(seed), dict.fromkeys(known, seed)
    for number in range(kills):
        name = list(known)[number % len(known)]
        steps, took, _ = known[name]
        by, group = rng.choice(SIGNALS), rng.random() < 0.5
        turns[name] += 1
        step = (turns[name] * 7919) % steps + 1
        if rng.random() < 0.9:
            yield Kill(name, by, group, rng.random() < 0.5, step)
        else:
            yield Kill(name, by, group, False, 0, rng.uniform(0.0, took))


def git_kills(kills: int, seed: int = 0) -> int:
    """Kill Git commands; return how many trials were wrong."""
    os.environ.update(IDENTITY, GIT_CONFIG_GLOBAL=os.devnull, GIT_CONFIG_SYSTEM=os.devnull)
    for module in LOADED:
        importlib.import_module(module)
    count, began = Counter[str](), time.monotonic()
    with tempfile.TemporaryDirectory() as temporary:
        origin, root = make_origin(Path(temporary) / "origin"), Path(temporary) / "trial"
        known = {name: measure(origin, root, name) for name in COMMANDS}
        for number, kill in enumerate(draw(kills, known, seed)):
            prepare(origin, root, kill.name)
            count["killed" if pico(root, *COMMANDS[kill.name], kill=kill) != 0 else "ended first"] += 1
            ending = ENDINGS[(number // len(COMMANDS)) % len(ENDINGS)]
            wrong = list(faults(root, kill, ending, known[kill.name][2]))
            for kind in {kind for kind, _ in wrong}:
                count[kind] += 1
            for kind, text in wrong:
                print(f"{kill}, then git {' '.join(ending)}: {kind}: {text}", flush=True)
    told = ", ".join(f"{count[n]} {n}" for n in ("killed", "ended first", "half", "blocked", "lost"))
    print(f"Git commands: {told}; {time.monotonic() - began:.0f} s", flush=True)
    return count["half"] + count["blocked"] + count["lost"]
