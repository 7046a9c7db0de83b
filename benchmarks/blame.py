"""CPU seconds of `pico blame` over a long history, and whether every answer is right.

    python benchmarks/blame.py [--commits 1000] [--components 1000] [--files 40] [--changes 3] [--merges] [--runs]

The history is random and written by `git fast-import`. A commit changes `--changes` leaves: poses, angles (half of them
written in another unit), parts that go home and come back; now and then it only edits a comment, writes values
otherwise without changing them, or moves a component to another file. With `--merges` about every eighth commit
begins a branch, and branches are merged; where both sides changed a leaf one of them wins, or neither. With `--runs`
every commit carries the document of a run that changed the poses, and the angles were turned by hand.

Printed are CPU seconds (user + system) of whole processes: `start-up` is the command in a lab of one component and one
commit, `cold` the first call, `warm` the least of three more, `next` the call after one more commit. Every leaf's
value, commit, how it was changed, and its whole history are compared with what the generator knows. Exit code 1 where
an answer is wrong, 3 where only a figure is missed: cold 5 s, warm 0.2 s beside start-up.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from startup import measure

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from pico.model.diff import Change  # noqa: E402
from pico.model.plan import LabRef  # noqa: E402
from pico.model.record import canonical  # noqa: E402
from pico.model.trace.run import Cause, Run  # noqa: E402

COLD, WARM = 5.0, 0.2
PITCH = 100
HEAD = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: large}\ncomponents:\n"


@dataclass(frozen=True)
class Turn:
    """A leaf's value since a commit, and what it was before."""

    value: Any
    commit: int
    before: Turn | None = None


@dataclass
class Version:
    """One commit: where components stand (None: at home) and their angles, in which file, and the truth about both."""

    number: int
    pose: dict[str, tuple[float, float, float] | None] = field(default_factory=dict)
    angle: dict[str, float] = field(default_factory=dict)
    file: dict[str, int] = field(default_factory=dict)
    style: dict[str, int] = field(default_factory=dict)
    comment: dict[int, str] = field(default_factory=dict)
    truth: dict[tuple[str, str], Turn] = field(default_factory=dict)

    def next(self, number: int) -> Version:
        maps = (self.pose, self.angle, self.file, self.style, self.comment, self.truth)
        return Version(number, *(dict(m) for m in maps))

    def set(self, name: str, tunable: str, value: Any) -> None:
        """Change a leaf; what a leaf is changed to that it is already is no change."""
        old = self.truth.get((name, tunable))
        if old is None or old.value != value:
            self.truth[name, tunable] = Turn(value, self.number, old)

    def write(self, name: str) -> str:
        """Return a component as the manifest has it; empty for one that is at home."""
        pose, style = self.pose[name], self.style.get(name, 0)
        if pose is None:
            return ""
        x, y, yaw = pose
        xs, angle = (f"{x / 10:.6g} cm", f"{self.angle[name]} deg") if style == 1 else (x, self.angle[name])
        if style == 2:
            return f"  {name}: {{angle: {angle}, pose: {{y: {y}, x: {xs}, yaw: {yaw}}}}}\n"
        return f"  {name}:\n    pose:\n      x: {xs}\n      y: {y}\n      yaw: {yaw}\n    angle: {angle}\n"


class History:
    """Makes versions one after another."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.rng = random.Random(options.seed)
        self.options = options
        self.names = [f"c{i:05}" for i in range(options.components)]
        self.versions: list[Version] = []
        self.parents: list[tuple[int, ...]] = []
        self.followed: set[int] = set()  # commits that a person made at the end

    def make(self) -> None:
        first = Version(0)
        for i, name in enumerate(self.names):
            first.file[name] = i % self.options.files
            first.pose[name], first.angle[name] = self.somewhere(), self.rng.randrange(360)
            first.set(name, "pose", first.pose[name])
            first.set(name, "angle", first.angle[name])
        self.add(first, ())
        tips = [0]
        while len(self.versions) < self.options.commits:
            here = self.rng.choice(tips) if self.options.merges else tips[0]
            if self.options.merges and len(tips) > 1 and self.rng.random() < 0.12:
                there = self.rng.choice([t for t in tips if t != here])
                made = self.merge(here, there)
                tips = [t for t in tips if t not in (here, there) or (t == there and self.rng.random() < 0.3)]
            else:
                if not (self.options.merges and len(tips) < 6 and self.rng.random() < 0.12):
                    tips.remove(here)
                made = self.edit(here)
            tips.append(made)
        last = tips[-1]
        for other in tips[:-1]:
            last = self.merge(last, other)

    def edit(self, parent: int) -> int:
        """Add a commit that changes something, and return its number."""
        new = self.versions[parent].next(len(self.versions))
        kind = self.rng.random()
        if kind < 0.03:
            new.comment[self.rng.randrange(self.options.files)] = f"# edited in {new.number}\n"
        elif kind < 0.06:
            new.file[self.rng.choice(self.names)] = self.rng.randrange(self.options.files)
        elif kind < 0.09:
            new.style[self.rng.choice(self.names)] = self.rng.randrange(3)
        else:
            for name in self.rng.sample(self.names, min(self.options.changes, len(self.names))):
                self.change(new, name)
        return self.add(new, (parent,))

    def change(self, new: Version, name: str) -> None:
        kind = self.rng.random()
        if kind < 0.05 or new.pose[name] is None:
            self.stow(new, name)
        elif kind < 0.5:
            new.pose[name] = self.somewhere()
            new.set(name, "pose", new.pose[name])
        else:
            new.angle[name] = self.rng.randrange(0, 3600) / 10
            new.style[name] = self.rng.randrange(2)
            new.set(name, "angle", new.angle[name])

    def stow(self, new: Version, name: str) -> None:
        """Take a component out of the state, so that it is at home, or bring it back."""
        new.pose[name] = None if new.pose[name] else self.somewhere()
        new.set(name, "pose", new.pose[name] or f"home/{name}")
        new.set(name, "angle", new.angle[name] if new.pose[name] else None)

    def merge(self, ours: int, theirs: int) -> int:
        """Add a merge, and return its number: per component one side's values, or for some that differ new ones."""
        a, b = self.versions[ours], self.versions[theirs]
        new = a.next(len(self.versions))
        for name in self.names:
            sides = [(v.pose[name], v.angle[name]) for v in (a, b)]
            if sides[0] == sides[1]:
                continue
            taken = a if self.rng.random() < 0.5 else b
            new.pose[name], new.angle[name] = taken.pose[name], taken.angle[name]
            if self.rng.random() < 0.1:
                new.pose[name] = self.somewhere()
            values = {
                "pose": new.pose[name] or f"home/{name}", "angle": new.angle[name] if new.pose[name] else None,
            }  # fmt: skip
            for tunable, value in values.items():
                kept = next((v.truth[name, tunable] for v in (a, b) if v.truth[name, tunable].value == value), None)
                new.truth[name, tunable] = kept or Turn(value, new.number, a.truth[name, tunable])
        return self.add(new, (ours, theirs))

    def add(self, version: Version, parents: tuple[int, ...]) -> int:
        self.versions.append(version)
        self.parents.append(parents)
        return version.number

    def somewhere(self) -> tuple[float, float, float]:
        side = PITCH * 40
        return (self.rng.randrange(100, side), self.rng.randrange(100, side), self.rng.randrange(-180, 180))


def carried(history: History, version: Version, parents: tuple[int, ...]) -> dict[str, str]:
    """Return the document of the run that a commit carries, by path: it changed the poses."""
    if not history.options.runs or len(parents) > 1:
        return {}
    digest, name = "sha256:" + "0" * 64, f"r{version.number:06}"
    changed = [at for at, turn in version.truth.items() if turn.commit == version.number and at[1] == "pose"]
    document = Run(
        id=name, lab=LabRef(name="large", digest=digest), state_before=digest, state_after=digest, plan=digest,
        cause=Cause(kind="apply"), evidence="kinematic", started_at="2026-01-01T00:00:00Z", outcome="done",
        changes=tuple(Change(component=component, tunable=tunable) for component, tunable in changed),
    )  # fmt: skip
    return {f"runs/2026/{1 + version.number // 100 % 12:02}/{name}/run.json": canonical(document) + "\n"}


def written(history: History, version: Version) -> dict[str, str]:
    """Return the manifests of a version by path."""
    parts: dict[int, list[str]] = {i: [] for i in range(history.options.files)}
    for name in history.names:
        parts[version.file[name]].append(version.write(name))
    return {
        f"state/group{i:03}.yaml": f"{version.comment.get(i, '')}{HEAD}{''.join(lines) or '  {}'}"
        for i, lines in parts.items()
    }


def lab(names: Sequence[str]) -> str:
    slots = [f"  home/{name}: {{x: {100 + PITCH * i}, y: 50}}" for i, name in enumerate(names)]
    parts = [f"  {n}:\n    type: linear_polarizer\n    marker: {i}\n    home: home/{n}" for i, n in enumerate(names)]
    table = f"table: {{size: [{PITCH * (len(names) + 41)}, {PITCH * 41}], beam_height: 70}}"
    robots = "robots: {arm1: {model: gantry, mount: {x: 0, y: 0}}}"
    lines = ["apiVersion: pico/v1\nkind: Lab\nmetadata: {name: large}", table, robots, "slots:", *slots, "inventory:"]
    return "\n".join([*lines, *parts]) + "\n"


def write(history: History, folder: Path) -> list[str]:
    """Write the history as a Git repository, checked out, and return the commits' ids."""
    folder.mkdir()
    subprocess.run(["git", "init", "-q", "-b", "main"], cwd=folder, check=True)
    command = ["git", "fast-import", "--quiet", "--export-marks=marks"]
    with subprocess.Popen(command, cwd=folder, stdin=subprocess.PIPE) as process:
        assert process.stdin is not None
        before: dict[int, dict[str, str]] = {}
        for version, parents in zip(history.versions, history.parents, strict=True):
            files = written(history, version) | {"lab.yaml": lab(history.names)}
            before[version.number] = files
            more = carried(history, version, parents)
            text = [f"commit refs/heads/main\nmark :{version.number + 1}\n"]
            text.append(f"committer A Physicist <a@localhost> {1_760_000_000 + 600 * version.number} +0000\n")
            text.append(block(f"commit {version.number}"))
            text += [f"{'merge' if i else 'from'} :{p + 1}\n" for i, p in enumerate(parents)]
            old = before[parents[0]] if parents else {}
            text += [f"M 100644 inline {p}\n{block(t)}" for p, t in files.items() if old.get(p) != t]
            text += [f"M 100644 inline {p}\n{block(t)}" for p, t in more.items()]
            process.stdin.write("".join(text).encode())
    marks = dict(line.split() for line in (folder / "marks").read_text().splitlines())
    (folder / "marks").unlink()
    subprocess.run(["git", "checkout", "-q", "-f", "main"], cwd=folder, check=True)
    return [marks[f":{v.number + 1}"] for v in history.versions]


def wrong_how(history: History, at: tuple[str, str], commit: int, how: Any) -> list[str]:
    """Return what is wrong with how a leaf is said to have been changed; a follow-up carries no run."""
    kind = "merge" if len(history.parents[commit]) > 1 else "commit"
    if history.options.runs and kind == "commit" and commit not in history.followed:
        kind = "run" if at[1] == "pose" else "hand"
    right = how["kind"] == kind and how.get("run") == (f"r{commit:06}" if kind == "run" else None)
    return [] if right else [f"{at}: {how}, but it is {kind} of {commit}"]


def follow(history: History, folder: Path) -> str:
    """Make one more commit, as a person would, and return its id."""
    history.followed.add(history.edit(len(history.versions) - 1))
    for path, text in written(history, history.versions[-1]).items():
        (folder / path).write_text(text)
    who = ["-c", "user.name=A Physicist", "-c", "user.email=a@localhost"]
    subprocess.run(["git", *who, "commit", "-qam", "one more", "--allow-empty"], cwd=folder, check=True)
    return subprocess.check_output(["git", "rev-parse", "HEAD"], cwd=folder, text=True).strip()


def told(pico: str, folder: Path) -> Any:
    """Return the whole history of every leaf as the command tells it."""
    return json.loads(subprocess.check_output([pico, "blame", "--history", "--json"], cwd=folder))


def block(text: str) -> str:
    return f"data {len(text.encode())}\n{text}\n"


def wrong_answers(history: History, ids: Sequence[str], answer: Any) -> list[str]:
    """Return what differs from the truth, a line each."""
    truth = history.versions[-1].truth
    said_of = {(leaf["component"], leaf["tunable"]): leaf for leaf in answer["leaves"]}
    there = {at for at, turn in truth.items() if turn.value is not None}
    found = [f"{at} is missing or too much" for at in sorted(there ^ said_of.keys())]
    for at in sorted(there & said_of.keys()):
        turn: Turn | None = truth[at]
        found += wrong_how(history, at, turn.commit, said_of[at]["last"]["how"])
        for said in said_of[at]["history"]:
            value = said.get("after")
            value = tuple(value.values()) if isinstance(value, dict) else value
            if turn is None or value != turn.value or said["commit"] != ids[turn.commit]:
                found.append(f"{at}: {said['commit'][:7]} {value}, but it is {turn}")
                break
            turn = turn.before
        else:
            found += [f"{at}: {turn} is not told"] if turn else []
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--commits", type=int, default=1000)
    parser.add_argument("--components", type=int, default=1000)
    parser.add_argument("--files", type=int, default=40)
    parser.add_argument("--changes", type=int, default=3)
    parser.add_argument("--merges", action="store_true")
    parser.add_argument("--runs", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    history, tiny = History(options), History(argparse.Namespace(**(vars(options) | {"components": 1, "commits": 1})))
    history.make()
    tiny.make()
    pico = str(Path(sysconfig.get_path("scripts")) / "pico")
    with tempfile.TemporaryDirectory() as name:
        folder, small = Path(name) / "large", Path(name) / "small"
        ids = write(history, folder)
        write(tiny, small)
        measure([pico, "blame"], small)
        start = min(measure([pico, "blame"], small)[0] for _ in range(3))
        cold = measure([pico, "blame"], folder)[0]
        warm = min(measure([pico, "blame"], folder)[0] for _ in range(3))
        size = (folder / ".git/pico/blame.sqlite").stat().st_size / 1e6
        found = wrong_answers(history, ids, told(pico, folder))
        ids.append(follow(history, folder))
        more = measure([pico, "blame"], folder)[0]
        found += wrong_answers(history, ids, told(pico, folder))
    merges = sum(len(p) > 1 for p in history.parents)
    print(f"{len(ids)} commits ({merges} merges), {options.components} components in {options.files} files")
    late = cold > COLD or warm - start > WARM
    print(f"start-up {start:.2f} s · cold {cold:.2f} s (limit {COLD:g}) · warm {warm:.2f} s,", end=" ")
    print(f"{warm - start:.2f} beside start-up (limit {WARM:g}) · next {more:.2f} s · cache {size:.1f} MB")
    print(f"{len(found)} of {len(history.versions[-1].truth)} answers wrong", *found[:10], sep="\n  ")
    sys.exit(1 if found else 3 if late else 0)


if __name__ == "__main__":
    main()
