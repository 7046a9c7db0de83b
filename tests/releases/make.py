"""Keep laboratories as this version makes them: `python tests/releases/make.py RELEASE`, once before a release.

What is kept is never made again: a later version that cannot read it must learn to.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import keeping

PEOPLE = {
    f"GIT_{who}_{what[0]}": what[1]
    for who in ("AUTHOR", "COMMITTER")
    for what in (("NAME", "A Physicist"), ("EMAIL", "physicist@localhost"))
}
ENVIRONMENT = (
    os.environ | PEOPLE | {"LOGNAME": "physicist", "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull}
)
KILLED = """
import os, pico
bench = pico.open(".")
for event in bench.run(bench.plan({goal!r})):
    if event.data.get("phase") == "transit":
        os.kill(os.getpid(), 9)
"""


class Lab:
    """A laboratory in a folder of its own, and the commands that people would call there."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def call(self, *words: str) -> Any:
        done = subprocess.run(
            [sys.executable, "-m", "pico_cli", *words],
            cwd=self.folder,
            env=ENVIRONMENT,
            capture_output=True,
            text=True,
            check=False,
        )
        return SimpleNamespace(code=done.returncode, out=done.stdout, err=done.stderr)

    def do(self, *words: str) -> None:
        answer = self.call(*words)
        assert answer.code == 0, (words, answer)

    def git(self, *words: str) -> None:
        subprocess.run(["git", *words], cwd=self.folder, env=ENVIRONMENT, check=True, capture_output=True)

    def edit(self, name: str, before: str, after: str) -> None:
        text = (self.folder / name).read_text()
        assert before in text, (name, before)
        (self.folder / name).write_text(text.replace(before, after, 1))

    def killed(self, goal: str) -> None:
        """Apply a goal, and be killed with a part in the hand."""
        code = subprocess.run(
            [sys.executable, "-c", KILLED.format(goal=goal)], cwd=self.folder, env=ENVIRONMENT, check=False
        ).returncode
        assert code == -9, code


def shel(lab: Lab) -> None:
    """Applied, captured, edited, merged, undone, killed and taken up again; a bench that drifted, and saved plans."""
    lab.do("apply", "--auto-approve")
    lab.do("apply", "e1", "--auto-approve")
    lab.do("commit", "-m", "as in e1", "--capture")
    lab.do("set", "p1", "angle=12", "--yes")
    lab.do("sim", "nudge", "p2", "--dx", "5")
    lab.do("commit", "-m", "p1 turned, p2 bumped", "--capture")
    lab.git("checkout", "-q", "-b", "other")
    lab.edit("state/table.yaml", "x: 290", "x: 300")
    lab.do("commit", "-m", "p1 farther right", "--planned")
    lab.git("checkout", "-q", "main")
    lab.do("note", "p2", "a scratch near the rim")
    lab.do("set", "hwp", "angle=10", "--yes")
    lab.do("commit", "-m", "hwp", "--capture")
    lab.do("merge", "other", "-m", "both")
    lab.do("apply", "--auto-approve", "--fidelity", "physics")
    lab.do("commit", "-m", "merged and applied", "--capture")
    lab.do("apply", "e3", "--auto-approve")
    lab.do("undo", "--auto-approve")
    lab.killed("e2")
    lab.do("resume", "--auto-approve")
    lab.do("apply", "--auto-approve")
    lab.do("sim", "nudge", "p2", "--dy", "3")
    for goal in ("e1", "main", "other"):
        lab.do("plan", goal, "--out", f"{goal}.plan")


def crowded(lab: Lab) -> None:
    """Applied, committed, and killed with a part in the hand."""
    lab.do("apply", "--auto-approve")
    lab.do("commit", "-m", "as it stands", "--capture")
    lab.killed("exchange")


def main(release: str) -> None:
    for make in (shel, crowded):
        with tempfile.TemporaryDirectory() as top:
            lab = Lab(Path(top))
            lab.do("init", "--example", make.__name__, "lab")
            lab.folder /= "lab"
            make(lab)
            kept = keeping.RELEASES / release / make.__name__
            keeping.keep(lab.folder, kept)
            # told from a restored one, in which nothing is left of the process that made it
            again = Lab(Path(top) / "again")
            keeping.restore(kept, again.folder)
            (kept / "facts.json").write_text(keeping.written(keeping.facts(again.call, again.folder)))


if __name__ == "__main__":
    main(sys.argv[1])
