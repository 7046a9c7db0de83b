"""Merges random edits of two branches, and counts what is lost: `python benchmarks/merges.py --cases 2000`.

Every case goes through the merge itself, with either side called ours; `--git` cases go through each command of git,
`--failing` ones through `git merge` with a driver that is missing, killed at random, or never set. `--moves` ones
move parts between several files, and must come out united or in conflict; `--moves-by-git` ones go through `git merge`,
and where that sees no conflict, plan or validate must tell. `--impossible` ones are clean as text but can not stand on
the table: merge, plan and check must refuse them. Prints a line each; the exit code is 1 where anything is wrong.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from datetime import UTC, datetime
from itertools import count, islice
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "history")]

from merging_cases import Case, case, faults, losses  # noqa: E402
from moving_cases import Files, Moved, mistakes, moved_case, stated  # noqa: E402

from pico.diagnostics import ExitCode, PicoError  # noqa: E402
from pico.history.examples.example import make_example  # noqa: E402
from pico.history.git.attributes import GITATTRIBUTES, command, install  # noqa: E402
from pico.history.lab.folder import LabFolder  # noqa: E402
from pico.history.merge.doubts import unsettled  # noqa: E402
from pico.history.merge.manifests import merge  # noqa: E402
from pico.history.merge.markers import Labels  # noqa: E402
from pico.history.merge.trees import contents, opened, unite_commits  # noqa: E402
from pico.history.repository.repository import Repository  # noqa: E402
from pico.manifest.load import load_folder  # noqa: E402

AUTHOR, TIME = ("A Physicist", "physicist@localhost"), datetime(2026, 1, 5, tzinfo=UTC)
ENVIRONMENT = {
    "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull, "GIT_EDITOR": "true",
    "GIT_AUTHOR_NAME": AUTHOR[0], "GIT_AUTHOR_EMAIL": AUTHOR[1],
    "GIT_COMMITTER_NAME": AUTHOR[0], "GIT_COMMITTER_EMAIL": AUTHOR[1],
}  # fmt: skip


def main() -> int:
    """Run everything and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--cases", type=int, default=2000)
    parser.add_argument("--git", type=int, default=50, help="cases for each command of git")
    parser.add_argument("--failing", type=int, default=50, help="cases for each way in which the driver fails")
    parser.add_argument("--first", type=int, default=0, help="seed of the first of these; each command gets its own")
    parser.add_argument("--impossible", type=int, default=200)
    parser.add_argument("--moves", type=int, default=2000, help="cases with moves between files")
    parser.add_argument("--moves-by-git", type=int, default=100, help="with a part taken out and moved, by `git merge`")
    options = parser.parse_args()
    os.environ.update(ENVIRONMENT)
    wrong = pure(options.cases)
    with tempfile.TemporaryDirectory() as folder:
        box, cases = Box(Path(folder)), real(options.first)
        for name, run in (
            ("git merge", box.merge), ("git rebase", box.rebase), ("git cherry-pick", box.cherry_pick),
            ("git revert", box.revert), ("git stash pop", box.stash_pop),
        ):  # fmt: skip
            wrong += told(name, islice(cases, options.git), lambda c, run=run: faults(c, run(c)))
        for name in ("never set", "missing", "killed") if options.failing else ():
            box.break_driver(name)
            lost = told(f"driver {name}", islice(cases, options.failing), lambda c: _unmarked(c, box.merge(c)))
            wrong += lost if name != "never set" else 0  # git alone: said, and not in PICO's hands
    with tempfile.TemporaryDirectory() as folder:
        wrong += moves(Path(folder), options.moves) if options.moves else 0
    with tempfile.TemporaryDirectory() as folder:
        wrong += moves_by_git(Path(folder), options.moves_by_git)
    with tempfile.TemporaryDirectory() as folder:
        wrong += impossible(Path(folder), options.impossible)
    return 1 if wrong else 0


def pure(number: int) -> int:
    """Merge every case in both directions, and return how many went wrong."""
    start, wrong, conflicting = time.process_time(), 0, 0
    for c in map(case, range(number)):
        was, mine, other = (t.encode() for t in (c.base, c.ours, c.theirs))
        forth, back = merge(was, mine, other), merge(was, other, mine)
        conflicts = {(x.path[2], ".".join(x.path[3:])) for x in forth.conflicts}
        same = forth.data == back.data or bool(c.conflicting)
        alike = same and {x.path for x in forth.conflicts} == {x.path for x in back.conflicts}
        wrong += bool(faults(c, forth.data.decode())) or conflicts != c.conflicting or not alike
        conflicting += bool(c.conflicting)
    seconds = (time.process_time() - start) / number / 2
    print(
        f"{number} cases, both ways: {wrong} wrong; {conflicting} hold conflicts; {1000 * seconds:.1f} ms CPU a merge"
    )
    return wrong


NEEDLESS = 0.02
"""So many of the merges without a disagreement may conflict all the same."""


def moves(folder: Path, number: int) -> int:
    """Merge every case of several files in both directions, as `pico merge` does, and return how many went wrong:
    in silence, or more than NEEDLESS of those that must be clean in conflict."""
    repository = Repository.init(folder)
    handle = opened(folder)
    start = time.process_time()
    silent = needless = clean = apart = 0
    for seed, c in enumerate(map(moved_case, range(number))):
        commits = _written(repository, c)
        unions = [unite_commits(handle, commits[a], commits[b], Labels()) for a, b in ((1, 2), (2, 1))]
        wrong = [fault for u in unions if u.tree for fault in mistakes(c, _files(handle, u.tree))]
        wrong += ["another result where the sides change places"] if unions[0].tree != unions[1].tree else []
        needlessly = [u for u in unions if not u.tree] if c.free else []
        named = [f"{x.address}: {x.base} | {x.ours} | {x.theirs}" for u in needlessly for _, x in u.conflicts]
        if wrong or needlessly:
            print(f"  seed {seed}: {'; '.join([*wrong, *named, *(path for u in needlessly for path in u.files)][:3])}")
        silent, needless = silent + bool(wrong), needless + len(needlessly)
        clean, apart = clean + 2 * c.free, apart + bool(c.conflicting)
    seconds = (time.process_time() - start) / number / 2
    print(f"{number} cases with moves between files, both ways: {silent} silent; {needless} of {clean} needless;")
    print(f"{apart} hold conflicts; {1000 * seconds:.1f} ms CPU a merge", flush=True)
    return silent + (needless if needless >= NEEDLESS * clean else 0)


def moves_by_git(folder: Path, number: int) -> int:
    """Put cases of several files to `git merge`, which sees one file at a time, and return how many of those that it
    merged wrongly without a conflict neither `pico validate` nor `pico plan` tells."""
    repository = Repository.init(folder)
    install(folder)
    silent = conflicts = kept = dropped = 0
    unseen = ((seed, c) for seed in count() if (c := moved_case(seed)).across and c.across == c.conflicting)
    for seed, c in islice(unseen, number):
        _, ours, theirs = _written(repository, c)
        git = ["git", "-C", str(folder)]
        for words in (["merge", "--abort"], ["checkout", "-q", "-f", "--detach", ours], ["clean", "-qfd"]):
            subprocess.run([*git, *words], capture_output=True, check=False)
        done = subprocess.run([*git, "merge", "-q", "-m", "merge", theirs], capture_output=True, check=False)
        if done.returncode:
            conflicts += 1
            continue
        files = {str(p.relative_to(folder)): p.read_text() for p in sorted(folder.glob("**/*.yaml"))}
        wrong = mistakes(c, files)
        manifests = load_folder(folder)
        told = [*manifests.diagnostics, *unsettled(repository, folder, manifests)]
        kept += bool(wrong)
        missed = [fault for fault in wrong if not any(d.address == fault.partition(" ")[0] for d in told)]
        there = {name for name, _, _ in stated(files)}  # in a file that git takes for a renamed one it is taken out
        dropped += bool(missed) and not any(name in there for name in c.across)
        missed = [fault for fault in missed if fault.partition(" ")[0] not in c.across - there]
        silent += bool(missed)
        if missed:
            print(f"  seed {seed}: {'; '.join(missed[:3])}")
    print(
        f"git merge, a part taken out and moved, {number} cases: {conflicts} in conflict, {kept} wrong, {silent} untold"
    )
    print(f"({dropped}: git took a file for renamed, and the part out of it as one side had)", flush=True)
    return silent


def _written(repository: Repository, c: Moved) -> tuple[str, str, str]:
    """Write a case as three commits, and return base, ours and theirs."""

    def commit(files: Files, parents: list[str]) -> str:
        data = {path: text.encode() for path, text in files.items()} | {".gitattributes": GITATTRIBUTES.encode()}
        return repository.write_commit(data, "edit", parents, author=AUTHOR, time=TIME)

    base = commit(c.base, [])
    return base, commit(c.ours, [base]), commit(c.theirs, [base])


def _files(handle: Any, tree: str) -> Files:
    return {path: data.decode() for path, data in contents(handle, handle[tree]).items()}


def told(name: str, cases: Iterable[tuple[int, Case]], judge: Callable[[Case], list[str]]) -> int:
    """Put cases before a judge, print and return how many went wrong."""
    wrong = total = conflicting = 0
    for seed, c in cases:
        found = judge(c)
        total, wrong, conflicting = total + 1, wrong + bool(found), conflicting + bool(c.conflicting)
        if found:
            print(f"  seed {seed}: {'; '.join(found[:3])}")
    print(f"{name}: {total} cases, {conflicting} hold conflicts, {wrong} wrong", flush=True)
    return wrong


def real(first: int = 0) -> Iterator[tuple[int, Case]]:
    """Yield cases, from a seed upward, in which both sides changed something."""
    return ((seed, c) for seed in count(first) if len({(c := case(seed)).base, c.ours, c.theirs}) == 3)


def _unmarked(c: Case, merged: str) -> list[str]:
    """Return what was lost in silence: a value of neither version, or a conflict without markers."""
    missing = ["conflict without markers"] if c.conflicting and "<<<<<<<" not in merged else []
    return [*(f"lost {'.'.join(leaf)}" for leaf in losses(c, merged)), *missing]


class Box:
    """A repository in which a case is played through a command of git; each returns what the file then holds."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.file = folder, folder / "table.yaml"
        self.repository = Repository.init(folder)
        self.git("checkout", "-q", "--detach", self.commit("", []))
        install(folder)

    def git(self, *arguments: str) -> None:
        subprocess.run(["git", *arguments], cwd=self.folder, capture_output=True, check=False)

    def commit(self, text: str, parents: list[str]) -> str:
        files = {"table.yaml": text.encode(), ".gitattributes": GITATTRIBUTES.encode()}
        return self.repository.write_commit(files, "edit", parents, author=AUTHOR, time=TIME)

    def play(self, at: str, *arguments: str) -> str:
        for name in ("rebase-merge", "sequencer", "CHERRY_PICK_HEAD", "REVERT_HEAD", "MERGE_HEAD"):
            left = self.folder / ".git" / name
            shutil.rmtree(left) if left.is_dir() else left.unlink(missing_ok=True)
        self.git("checkout", "-q", "-f", "--detach", at)
        self.git(*arguments)
        return self.file.read_text()

    def branches(self, c: Case) -> tuple[str, str, str]:
        base = self.commit(c.base, [])
        return base, self.commit(c.ours, [base]), self.commit(c.theirs, [base])

    def merge(self, c: Case) -> str:
        _, ours, theirs = self.branches(c)
        return self.play(ours, "merge", "-q", "-m", "merge", theirs)

    def rebase(self, c: Case) -> str:
        _, ours, theirs = self.branches(c)
        return self.play(theirs, "rebase", "-q", ours)

    def cherry_pick(self, c: Case) -> str:
        _, ours, theirs = self.branches(c)
        return self.play(ours, "cherry-pick", theirs)

    def revert(self, c: Case) -> str:
        before = self.commit(c.theirs, [])
        undone = self.commit(c.base, [before])
        return self.play(self.commit(c.ours, [undone]), "revert", "--no-edit", undone)

    def stash_pop(self, c: Case) -> str:
        base, ours, _ = self.branches(c)
        self.play(base)
        self.file.write_text(c.theirs)
        self.git("stash", "-q")
        return self.play(ours, "stash", "pop", "-q")

    def break_driver(self, how: str) -> None:
        """Let the driver fail from now on: never set, missing, or killed after up to 0.4 s."""
        if how == "never set":
            self.git("config", "--remove-section", "merge.pico")
            return
        stand_in = self.folder / ".git" / "stand-in"
        if how == "killed":
            script = f'#!/bin/sh\nexec timeout -s KILL 0.$(($$ % 4))$(($$ % 10))1 {sys.executable} "$@"\n'
            stand_in.write_text(script)
            stand_in.chmod(0o755)
        self.git("config", "merge.pico.driver", command().replace(sys.executable, str(stand_in)))


COMMANDED = 10
"""Each so manieth impossible merge is also put to the `pico check` command, in a process of its own."""


def impossible(folder: Path, count: int) -> int:
    """Merge branches that put two parts into one place, and return how many of them `pico merge`, `pico plan` or
    `pico check` let through, or refused without naming both."""
    from pico.bench.bench import Bench
    from pico.bench.checking import check
    from pico.history.merge.checked import merge as merge_checked

    root = make_example("shel", folder / "shel").root
    rng, through, git, commanded = random.Random(1), 0, ["git", "-C", str(root)], 0
    for number in range(count):
        a, b = _two_places(root, rng)
        for branch, (name, pose) in (("a", a), ("b", b)):
            subprocess.run([*git, "checkout", "-q", "-f", "-B", branch, "main"], check=True)
            _put(root, name, pose)
            subprocess.run([*git, "commit", "-q", "-a", "-m", branch], check=True)
        names = {a[0], b[0]}
        refused = set()
        try:
            merge_checked(LabFolder(root), "a")
        except PicoError as exc:
            refused = _pairs(exc.diagnostics, names) if exc.exit_code == ExitCode.IMPOSSIBLE else set()
        clean = subprocess.run([*git, "merge", "-q", "-m", "merge", "a"], check=False, capture_output=True)
        assert clean.returncode == 0, clean.stderr
        with Bench.open(root) as bench:
            planned = bench.plan()
        ok = names <= refused and planned.errored and names <= _pairs(planned.diagnostics, names)
        for base in (None, "main"):  # where the branch began, by itself and named
            checked = check(root, base, environment={})
            ok &= checked.exit_code == ExitCode.IMPOSSIBLE and names <= _pairs(checked.labs[0].diagnostics, names)
        if number % COMMANDED == 0:
            commanded += 1
            ok &= _refused_by_command(root, names)
        through += not ok
        if not ok:
            print(f"  {number}: {a} and {b}")
    print(
        f"{count} merges clean as text and impossible on the table, put to merge, plan and check ({commanded} also to"
    )
    print(f"the command): {through} let through, or without the pair's names")
    return through


def _refused_by_command(root: Path, names: set[str]) -> bool:
    """Return whether `pico check`, in the working tree and against main, exits with 3 and says both names."""
    pico = [sys.executable, "-c", "import sys; from pico_cli.main import main; sys.exit(main())", "check"]
    done = [subprocess.run([*pico, *base], cwd=root, capture_output=True, text=True, check=False)
            for base in ((), ("main",))]  # fmt: skip
    said = [next((line for line in d.stderr.splitlines() if line.startswith("error")), "") for d in done]
    return all(d.returncode == ExitCode.IMPOSSIBLE for d in done) and all(n in line for n in names for line in said)


def _pairs(found: object, names: set[str]) -> set[str]:
    """Return which of two names are in a diagnostic that has both."""
    return next((names for d in found if d.severity == "error" and all(n in d.summary for n in names)), set())


Place = tuple[str, tuple[float, float]]


def _two_places(root: Path, rng: random.Random) -> tuple[Place, Place]:
    """Return two parts, each with a free place on the beam, that have no room beside each other."""
    from pico.history.merge.checked import overlapping

    while True:
        a, b = rng.sample(("p1", "p2", "lx_100", "lx_125", "ly_150", "ly_200"), 2)
        x, y = rng.randint(280, 900), rng.randint(380, 460)
        at = {a: (x, y), b: (x + rng.randint(-50, 50), y + rng.randint(-50, 50))}
        folders = []
        for name, pose in at.items():
            subprocess.run(["git", "-C", str(root), "checkout", "-q", "-f", "main"], check=True)
            _put(root, name, pose)
            folders.append(LabFolder(root).manifests)
        subprocess.run(["git", "-C", str(root), "checkout", "-q", "-f", "main"], check=True)
        if not any(overlapping(manifests) for manifests in folders):
            return (a, at[a]), (b, at[b])


def _put(root: Path, name: str, pose: tuple[float, float]) -> None:
    """Put a part somewhere, as capture would write it."""
    from pico.manifest.edit import set_values
    from pico.model.pose import Pose

    path = root / "state" / "table.yaml"
    path.write_text(set_values(path.read_text(), {name: {"pose": Pose(*pose, 0.0)}}))


if __name__ == "__main__":
    sys.exit(main())
