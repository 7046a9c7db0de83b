"""What many commits changed, read incrementally, is what reading each of them whole says."""

from __future__ import annotations

import random
import subprocess
from pathlib import Path

import pytest

from pico.history.diff.commits import CommitDiffs
from pico.history.examples.example import make_example
from pico.history.lab.folder import LabFolder


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    make_example("shel", tmp_path / "lab")
    return tmp_path / "lab"


def _edit(lab: Path, rng: random.Random) -> None:
    table, more, bench = lab / "state" / "table.yaml", lab / "state" / "more.yaml", lab / "lab.yaml"
    text = table.read_text()
    what = rng.randrange(6)
    if what == 0:
        table.write_text(text.replace("yaw: 0", f"yaw: {rng.randrange(90)}", 1))
    elif what == 1:
        table.write_text(text + "# a remark\n")
    elif what == 2 and "  p2:\n" in text:
        head, name, rest = text.partition("  p2:\n")
        header = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\ncomponents:\n"
        body = [line for line in rest.splitlines() if line.startswith("    ")]
        rest = "".join(f"{line}\n" for line in rest.splitlines() if not line.startswith("    "))
        table.write_text(head + rest)
        more.write_text(header + name + "\n".join(body) + "\n")
    elif what == 3:
        table.write_text(text.replace("angle: 22.75", f"angle: {rng.randrange(90)} deg"))
    elif what == 4:
        bench.write_text(bench.read_text().replace("home: storage/b2", "home: storage/b3"))
    else:
        (lab / "ci.yaml").write_text(f"on: {rng.randrange(99)}\n")


@pytest.mark.parametrize("seed", range(3))
def test_incremental_is_whole(lab: Path, seed: int) -> None:
    rng = random.Random(seed)
    who = ["-c", "user.name=A", "-c", "user.email=a@localhost"]
    for number in range(12):
        _edit(lab, rng)
        subprocess.run(["git", "add", "-A"], cwd=lab, check=True)
        subprocess.run(["git", *who, "commit", "-qm", f"edit {number}", "--allow-empty"], cwd=lab, check=True)
    folder = LabFolder(lab)
    repository, diffs = folder.history(), CommitDiffs(folder)
    for commit in repository.log(repository.tips()):
        whole = folder.entry(commit)
        assert diffs.entry(commit) == whole
        mine = [c for c in diffs.entry(commit, names=["p2"]).changes if c.component == "p2"]
        assert mine == [c for c in whole.changes if c.component == "p2"]
