"""Full, failing and read-only disks under every write of PICO: `python benchmarks/disks.py [--points 40] [COMMAND...]`.

A small library (`disk_faults.c`, compiled with the system's `cc` and preloaded) counts what a command, the SQLite in
it and the git that it starts write below the lab, and lets the call of a given number fail: ENOSPC and EROFS from there
on, as a disk that is full or was mounted read-only, EIO once, as a bad sector. Each command runs at each of its points
with each fault, in a process and a lab of its own; with `--points` at so many of them, drawn by `--seed`.

Afterwards: nobody speaks of a mistake in PICO; the message says which disk and why, and truly what was not done
(moved, written into manifests, committed); no temporary file, lock or torn file is left (save one that a read-only
disk did not let go of, the journal that SQLite plays back, and the lock of what PICO says that it will end: the next
call must clear them); success was said only where the command did all of it; and the same command on the mended disk,
after what its hint asks for, reaches what it reaches on a good one (or a plan has nothing to do). Prints a table, and
what was wrong; the exit code is 1 where anything was.
"""

from __future__ import annotations

import argparse
import ctypes
import errno
import hashlib
import json
import mmap
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

TELLING = ("apply", "undo", "capture", "commit", "stash", "checkout", "merge", "revert", "cherry-pick", "set", "move")
FAULTS = {"ENOSPC": True, "EIO": False, "EROFS": True}
"""Whether all that comes after the first failure fails, too."""
SAID = {
    "ENOSPC": "no space left",
    "EIO": "input/output error|disk i/o error|unable to|git did not .* in /",
    "EROFS": "read-only",
}
"""Words of which one must be said. Of a single failure git does not always tell the reason, only what it did not do."""
BROKEN = re.compile(r"mistake in PICO|PICO itself failed|Traceback|Exception ignored")
LEFT = re.compile(r"\.tmp$|\.lock$|^incoming$|^index\.before$|-journal$|\.unfinished$|^\.probe")
"""What was to be gone. Git leaves its `tmp_obj_*` to `git gc`, and nothing can be done about it."""
KERNEL = ("write.lock", "lock", "attachment.lock", "commit.lock", "bench.lock")
"""Files that are locked, not left: they stay."""


class Control(ctypes.Structure):
    """What `disk_faults.c` maps."""

    _fields_ = [
        *((name, ctypes.c_long) for name in ("count", "at", "last", "fault", "refused", "stuck")),
        ("root", ctypes.c_char * 4096),
        ("first", ctypes.c_char * 4096),
    ]


class Disk:
    """The disk that fails, below one folder."""

    def __init__(self, control: Path) -> None:
        with control.open("r+b") as file:
            self._map = mmap.mmap(file.fileno(), ctypes.sizeof(Control))
        self.control = Control.from_buffer(self._map)

    @contextmanager
    def failing(self, root: Path, at: int = 0, fault: int = 0, *, on: bool = False) -> Iterator[Control]:
        """Count the writes below `root`; the one with number `at` fails (0: none), and with `on` all after it."""
        new = Control(0, at, sys.maxsize if on else at, fault, 0, 0, str(root).encode(), b"")
        ctypes.pointer(self.control)[0] = new
        try:
            yield self.control
        finally:
            self.control.root = b""


@dataclass(frozen=True)
class Case:
    """A command: how its lab comes about (words of PICO, or what is done to the folder), and what it writes (`out`).

    `looks`: it writes caches only, and must not fail. `adds`: called twice it does more than once. `new`: it wants a
    place where nothing is, which a disk that became read-only can't give back. `porcelain`: git does it all, and what
    it leaves half done on a disk that fails in between is git's to say.
    """

    words: tuple[str, ...]
    before: tuple[tuple[str, ...] | Callable[[Any, Path], None], ...] = ()
    out: str = ""
    looks: bool = False
    adds: bool = False
    new: bool = False
    porcelain: bool = False

    @property
    def tells(self) -> bool:
        """Whether it says what it did not do: it moves parts, or writes manifests or commits."""
        return self.words[0] in TELLING


@dataclass
class Score:
    points: int = 0
    runs: int = 0
    wrong: Counter[str] = field(default_factory=Counter)


def edit(name: str, before: str, after: str) -> Callable[[Any, Path], None]:
    def change(_: Any, lab: Path) -> None:
        text = (lab / name).read_text()
        assert before in text, (name, before)
        (lab / name).write_text(text.replace(before, after, 1))

    return change


def git(*words: str) -> Callable[[Any, Path], None]:
    return lambda _, lab: told(lab, *words)


def told(lab: Path, *words: str) -> None:
    subprocess.run(["git", *words], cwd=lab, check=True, capture_output=True)


def branch(name: str, before: str, after: str) -> Callable[[Any, Path], None]:
    """Make a branch that changes one line, and go back to main."""

    def make(bench: Any, lab: Path) -> None:
        told(lab, "checkout", "-q", "-b", name, "main")
        edit("state/table.yaml", before, after)(bench, lab)
        told(lab, "commit", "-q", "-a", "-m", name)
        told(lab, "checkout", "-q", "main")

    return make


def held(bench: Judge, lab: Path) -> None:
    """Kill `apply e1` while the arm holds a part."""
    from kills import places

    kept = bench.top / "kept-whole"
    shutil.copytree(lab, kept, symlinks=True)
    words = ("apply", "e1", "--auto-approve")
    with bench.disk.failing(lab.parent) as control:
        bench.run(lab, *words)
    for at in range(control.count // 3, control.count):
        bench.restore(kept)
        with bench.disk.failing(lab.parent, at):
            bench.run(lab, *words)
        if "held" in {p[0] for p in places(lab).values()}:  # type: ignore[index]
            shutil.rmtree(kept)
            return
    raise AssertionError("the arm never held a part")


def data_lab(bench: Any, lab: Path) -> None:
    """Let a commit carry a run with data."""
    from pico.history.data.lab import LabData

    for words in RUN:
        bench.do(words)
    store = LabData.discover(lab).store
    pieces = (b"frame a", b"longer frame b" * 9000)
    found = [{"name": f"f{i}.bin", "sha256": store.put(p), "size": len(p)} for i, p in enumerate(pieces)]
    path = next(lab.glob("runs/*/*/*/run.json"))
    artifacts = [one | {"media_type": "application/octet-stream"} for one in found]
    path.write_text(json.dumps(json.loads(path.read_text()) | {"artifacts": artifacts}))
    (lab.parent / "share").mkdir()
    told(lab, "commit", "-q", "-a", "--amend", "--no-edit")


def emptied(_: Any, lab: Path) -> None:
    shutil.rmtree(lab / ".git/pico/cas")


def stranger(_: Any, lab: Path) -> None:
    """Let cameras look, and let the manifests forget p2, which stands on the table."""
    for name in ("lab.yaml", "state/table.yaml"):
        text = re.sub(r"(?m)^  p2:.*\n(?:    .*\n)+", "", (lab / name).read_text())
        (lab / name).write_text(text)


NUDGED = ("sim", "nudge", "p2", "--dx", "5")
RUN = (("set", "p1", "angle=12", "--yes"), ("commit", "-m", "p1", "--capture"))
SIGHT = edit("lab.yaml", "sim:\n", "sim:\n  observe: sight\n")

MINE = edit("state/table.yaml", "x: 520", "x: 530")
THEIRS = branch("left", "x: 290", "x: 300")

CASES: dict[str, Case] = {
    "plan --out": Case(("plan", "e1", "--out", "e1.plan"), out="e1.plan"),
    "plan --picture": Case(("plan", "e1", "--picture", "e1.png"), out="e1.png"),
    "apply": Case(("apply", "e1", "--auto-approve")),
    "capture": Case(("capture",), (NUDGED,)),
    "commit": Case(("commit", "-m", "bumped"), (NUDGED,)),
    "set": Case(("set", "p1", "angle=20", "--yes")),
    "move": Case(("move", "p2", "x=500", "--yes"), adds=True),
    "fmt": Case(("fmt",), (edit("state/table.yaml", "    pose:\n", "    pose:  \n"),)),
    "init": Case(("init", "other"), new=True),
    "init --example": Case(("init", "--example", "minimal", "other"), new=True),
    "merge": Case(("merge", "left", "-m", "both"), (THEIRS, MINE, git("commit", "-qam", "mine"))),
    "revert": Case(("revert", "mine"), (MINE, git("commit", "-qam", "mine"), git("tag", "mine"))),
    "cherry-pick": Case(("cherry-pick", "left"), (THEIRS,)),
    "checkout": Case(("checkout", "e2", "--auto-approve")),
    "checkout --": Case(("checkout", "e1", "--files-only", "--", "p2")),
    "stash": Case(("stash",), (MINE,), porcelain=True),
    "stash pop": Case(("stash", "pop"), (MINE, ("stash",)), porcelain=True),
    "note": Case(("note", "p2", "scratched"), adds=True),
    "render --out": Case(("render", "--out", "bench.png", "--size", "160x120"), out="bench.png"),
    "render svg": Case(("render", "--out", "bench.svg"), out="bench.svg"),
    "plan --graph": Case(("plan", "e1", "--graph", "--out", "plan.dot"), out="plan.dot"),
    "runs show": Case(("runs", "show"), RUN, looks=True),
    "runs export": Case(("runs", "export", "--out", "crate.zip", "--pictures", "none"), RUN, out="crate.zip"),
    "runs export folder": Case(("runs", "export", "--out", "../crate", "--pictures", "none"), RUN),
    "data push": Case(("data", "push", "../share"), (data_lab,)),
    "data pull": Case(("data", "pull", "../share"), (data_lab, ("data", "push", "../share"), emptied)),
    "data pointers": Case(("data", "pointers"), (data_lab,)),
    "import": Case(("import", "--types", "3=linear_polarizer:p2"), (SIGHT, stranger)),
    "undo": Case(("undo", "--auto-approve"), (("apply", "e1", "--auto-approve"),), adds=True),
    "resume": Case(("resume", "--auto-approve"), (held,)),
    "recover": Case(("recover", "--auto-approve"), (held,)),
    "calibrate": Case(("calibrate",), out="calibration/sim.json"),
    "calibrate markers": Case(("calibrate", "markers", "--out", "m.pdf"), out="m.pdf"),
    "sim nudge": Case(NUDGED, adds=True),
    "sim reset": Case(("sim", "reset")),
    "sim faults": Case(("sim", "faults", "drop=0.1"), out=".pico/benches/sim/faults.json"),
    "check --report": Case(("check", "C3", "--report", "r.md", "--pictures", "none"), out="r.md"),
    "bisect run": Case(("bisect", "run", "e2", "C1", "--expect", "p2.pose.yaw < 20.0", "--auto-approve")),
    "status": Case(("status",), looks=True),
    "plan": Case(("plan", "e1"), looks=True),
    "blame": Case(("blame", "p1"), looks=True),
    "log": Case(("log",), looks=True),
    "diff": Case(("diff", "E1-3", "E2-3"), looks=True),
    "drift": Case(("drift",), looks=True),
    "verify": Case(("verify",), looks=True),
    "show": Case(("show", "E1-3"), looks=True),
    "git install": Case(("git", "install"), (("git", "uninstall"),), porcelain=True),
}  # fmt: skip


class Judge:
    """Runs commands in labs of their own on a disk that fails, and looks at what they left."""

    def __init__(self, top: Path, disk: Disk) -> None:
        self.top, self.disk = top, disk
        self.area, self.lab = top / "area", top / "area" / "shel"
        self.said = top / "said.txt"

    def run(self, lab: Path, *words: str) -> int | None:
        from kills import forked

        _, status = os.waitpid(forked(lab, *words, out=str(self.said)), 0)
        return None if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)

    def restore(self, kept: Path) -> None:
        shutil.rmtree(self.lab, ignore_errors=True)
        shutil.copytree(kept, self.lab, symlinks=True)

    def prepare(self, case: Case) -> Path:
        """Make the lab that a command works in, and return what was kept of the whole area."""
        from pico.history.examples.example import make_example
        from pico.history.git.attributes import install

        shutil.rmtree(self.area, ignore_errors=True)
        self.area.mkdir()
        make_example("shel", self.lab)
        install(self.lab)
        self.do(("apply", "--auto-approve"))
        for step in case.before:
            if callable(step):
                step(self, self.lab)
            else:
                self.do(step)
        kept = self.top / "kept"
        shutil.rmtree(kept, ignore_errors=True)
        shutil.copytree(self.area, kept, symlinks=True)
        return kept

    def do(self, words: tuple[str, ...]) -> None:
        code = self.run(self.lab, *words)
        assert code == 0, f"{words}: {code}\n{self.said.read_text()}"

    def again(self, kept: Path) -> None:
        shutil.rmtree(self.area)
        shutil.copytree(kept, self.area, symlinks=True)

    def state(self, out: str) -> dict[str, object]:
        """Return what a command may change: files, HEAD, the table; what is drawn anew each time left out."""
        found: dict[str, object] = {}
        for path in sorted(self.area.rglob("*")):
            name = path.relative_to(self.area)
            if (
                path.is_file()
                and not {".git", ".pico", "runs"} & set(name.parts)
                and name.name != out
                and ".zip" not in name.name
            ):
                found[str(name)] = hashlib.sha256(path.read_bytes()).hexdigest()
            elif path.name == ".git":
                found[f"{name} HEAD"] = heads(path.parent)
        if out and (self.lab / out).exists():
            found["out"] = whole(self.lab / out)
        found["table"] = table(self.lab)
        return found

    def left(self) -> set[str]:
        """Return the temporary files and locks that lie about."""
        found = set()
        for path in self.area.rglob("*"):
            if LEFT.search(path.name) and path.name not in KERNEL and not path.name.startswith("world.json"):
                found.add(str(path.relative_to(self.area)))
        return found


def heads(folder: Path) -> str:
    """Return the branches with the manifests that they hold and their subjects, and what is staged."""

    def ask(*words: str) -> str:
        return subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True, check=False).stdout

    found = ask("symbolic-ref", "-q", "HEAD") or ask("rev-parse", "HEAD")
    for ref in ask("for-each-ref", "--format=%(refname)").split():
        if ref.startswith(("refs/heads/", "refs/stash")):
            found += f"{ref} {ask('rev-parse', f'{ref}:state')}{ask('log', '--format=%s', ref)}"
    staged = ask("diff", "--cached", "--name-only", "--", ".", ":(exclude)runs")
    going = sorted(
        n for n in ("MERGE_HEAD", "REVERT_HEAD", "CHERRY_PICK_HEAD", "BISECT_START") if (folder / ".git" / n).exists()
    )
    return f"{found}{staged}{going}"


STANDING = ("nothing moved", "the manifests are as they were", "no commit was made")
"""What a command says that did not come to its end."""


def standing(lab: Path) -> tuple[object, ...]:
    """Return what each word of STANDING is about: table, manifests, HEAD."""
    asked = subprocess.run(["git", "rev-parse", "HEAD"], cwd=lab, capture_output=True, text=True, check=False)
    manifests = {str(path): path.read_bytes() for path in (*lab.glob("*.yaml"), *lab.glob("state/*.yaml"))}
    return table(lab), manifests, asked.stdout


def whole(path: Path) -> str:
    """Return whether a file that was written is whole, as its format tells."""
    data = path.read_bytes()
    ends = {".png": b"IEND\xaeB`\x82", ".svg": b"</svg>", ".pdf": b"%%EOF", ".gif": b";", ".dot": b"}", ".md": b""}
    if path.suffix in (".json", ".plan"):
        try:
            json.loads(data)
        except ValueError:
            return f"torn after {len(data)} bytes"
    elif path.suffix == ".zip":
        import zipfile

        if not zipfile.is_zipfile(path) or zipfile.ZipFile(path).testzip():
            return f"torn after {len(data)} bytes"
    elif not data or not data.rstrip().endswith(ends[path.suffix]):
        return f"torn after {len(data)} bytes"
    return "whole"


def table(lab: Path) -> object:
    """Return where the parts of the simulated bench are, and their values."""
    try:
        world = json.loads((lab / ".pico/benches/sim" / "world.json").read_text())
    except FileNotFoundError:
        return None
    return {n: (b["presence"], b.get("pose"), b["values"]) for n, b in world["components"].items()}


def tried(judge: Judge, kept: Path, case: Case, fault: str, at: int, good: Good) -> tuple[str, ...]:
    """Let a command fail at one point; return what was wrong."""
    judge.again(kept)
    with judge.disk.failing(judge.area, at, getattr(errno, fault), on=FAULTS[fault]) as control:
        code = judge.run(judge.lab, *case.words)
    if not control.refused:
        return ()
    said, now, left = judge.said.read_text(), judge.state(case.out), judge.left() - good.left - good.before
    wrong = [*answered(judge, case, fault, code, said, good)]
    if code == good.code and now != good.after:
        wrong.append("untrue success")
    torn, pending = now.get("out", "whole") != "whole", "is begun and not ended" in said
    known = [name for name in left if name.endswith("-journal") or (pending and name.endswith(".git/index.lock"))]
    if torn or (not control.stuck and len(known) < len(left)):
        wrong.append("left over")
    if (now != good.after or left) and not case.porcelain and not (case.new and control.stuck):
        again, more = mended(judge, case, code, good)
        wrong, said = wrong + again, said + more
    if wrong:
        where = f"{fault} at {at}, {control.first.decode()}: {', '.join(wrong)} (exit {code}) {sorted(left) or ''}"
        told = "\n    ".join((f"  {' '.join(case.words)}: {where}", *said.strip().splitlines()[:14]))
        print(told.replace(str(judge.top), ""), flush=True)
    return tuple(wrong)


def answered(judge: Judge, case: Case, fault: str, code: int | None, said: str, good: Good) -> Iterator[str]:
    """Yield what is wrong with an exit code and what was said."""
    if BROKEN.search(said) or code is None:
        yield "internal"
    if case.looks and (code != good.code or "error" in said):
        yield "a look failed"
    elif code not in (good.code, 1, 130):
        yield "exit code"
    elif code == 1 and not re.search(SAID[fault], said.lower()):
        yield "does not say why"
    elif code == 1 and str(judge.area) not in said and "mounted at" not in said:
        yield "does not say where"
    now = standing(judge.lab)
    for words, before, after in zip(STANDING, good.standing, now, strict=True):
        if words in said and before != after:
            yield f"untrue: {words}"
    if code == 1 and case.tells and not re.search(f"{STANDING[1]}|manifests changed", said):
        yield "does not say what was not done"


def mended(judge: Judge, case: Case, code: int | None, good: Good) -> tuple[list[str], str]:
    """Call a command again on the mended disk; return what was wrong then, and what it said."""
    again = judge.run(judge.lab, *case.words)
    if way := re.search(r"help: `pico (recover|capture( p2)?)`", judge.said.read_text()):
        judge.run(judge.lab, *way[1].split(), *(["--auto-approve"] if way[1] == "recover" else []))
        again = judge.run(judge.lab, *case.words)
    after, wrong, said = judge.state(case.out), [], ""
    led = bool(way) and judge.run(judge.lab, "plan", "--detailed-exitcode") == 0  # what was seen is written otherwise
    if after != good.after and not led and not (case.adds and 0 in (code, again)):
        wrong.append("not reached after")
        said = f"\n-- again, on the mended disk: {again}\n{judge.said.read_text()}"
        differ = {name for name in (*after, *good.after) if after.get(name) != good.after.get(name)}
        said += "\n".join(f"   {n}: {after.get(n)} / {good.after.get(n)}"[:400] for n in sorted(differ))
    if left := judge.left() - good.left:
        wrong.append(f"left over for good: {', '.join(sorted(left))}")
    return wrong, said


@dataclass(frozen=True)
class Good:
    """How a command ends on a good disk."""

    code: int
    count: int
    after: dict[str, object]
    left: set[str]
    before: set[str]
    """What lay about before it: of a command that was killed."""
    standing: tuple[object, ...]
    """How the lab stood before it."""


def judged(judge: Judge, name: str, points: int, seed: int) -> Score:
    """Let one command fail at its points."""
    case, score = CASES[name], Score()
    kept = judge.prepare(case)
    judge.again(kept)
    before, start = judge.left(), standing(judge.lab)
    with judge.disk.failing(judge.area) as control:
        code = judge.run(judge.lab, *case.words)
    if code is None or "error[" in judge.said.read_text():
        print(f"  {name} fails on a good disk: {judge.said.read_text()}")
        score.wrong["fails on a good disk"] += 1
        return score
    good = Good(code, control.count, judge.state(case.out), judge.left(), before, start)
    score.points = good.count
    draw = random.Random(f"{seed}/{name}")
    for fault in FAULTS:
        every = range(1, good.count + 1 if fault != "EROFS" else round(good.count * 1.2) + 1)
        for at in sorted(draw.sample(every, min(points, len(every)))) if points else every:
            score.runs += 1
            score.wrong.update(tried(judge, kept, case, fault, at, good))
    return score


def measure(names: list[str], points: int, seed: int, disk: Disk) -> int:
    """Measure commands and print the table; return how many were wrong."""
    from kills import preload

    import pico.vision.sheets  # noqa: F401

    preload()
    total = Score()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        judge = Judge(Path(folder).resolve(), disk)
        for name in names:
            began = time.monotonic()
            score = judged(judge, name, points, seed)
            total.points, total.runs = total.points + score.points, total.runs + score.runs
            total.wrong.update(score.wrong)
            rows.append(row(name, score))
            print(f"{rows[-1]}   {time.monotonic() - began:.0f} s", flush=True)
    print("\n".join((f"\n{'command':16} {'points':>6} {'runs':>6}  wrong", *rows, row("all", total))))
    return sum(total.wrong.values())


def row(name: str, score: Score) -> str:
    wrong = ", ".join(f"{n} {kind}" for kind, n in sorted(score.wrong.items())) or "0"
    return f"{name:16} {score.points:6} {score.runs:6}  {wrong}"


def preloaded(words: list[str]) -> int:
    """Compile the library and run this program with it; return its exit code."""
    with tempfile.TemporaryDirectory() as folder:
        library, control = Path(folder) / "disk_faults.so", Path(folder) / "control"
        source = ROOT / "benchmarks" / "disk_faults.c"
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", str(library), str(source), "-ldl"], check=True)
        control.write_bytes(bytes(ctypes.sizeof(Control)))
        who = {f"GIT_{r}_{k}": v for r in ("AUTHOR", "COMMITTER") for k, v in (("NAME", "A"), ("EMAIL", "a@localhost"))}
        quiet = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull, "PYTHONDONTWRITEBYTECODE": "1"}
        told = {"LD_PRELOAD": str(library), "DISK_FAULTS": str(control)}
        return subprocess.run([sys.executable, *words], env=os.environ | who | quiet | told, check=False).returncode


def main() -> int:
    """Let disks fail."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("commands", nargs="*", help="of those in CASES; all without")
    parser.add_argument("--points", type=int, default=0, help="of each command and fault; all without")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    if "DISK_FAULTS" not in os.environ:
        return preloaded(sys.argv)
    disk = Disk(Path(os.environ["DISK_FAULTS"]))
    return 1 if measure(given.commands or list(CASES), given.points, given.seed, disk) else 0


if __name__ == "__main__":
    sys.exit(main())
