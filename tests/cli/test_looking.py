"""Who opens a lab to look leaves git as it was; who writes has git call PICO, and is told so once."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest
from commanding import Pico, edit

LOOKS = (
    "status", "plan", "plan e1", "plan --explain", "plan --graph", "log", "diff", "diff C3 E1-3", "blame", "drift",
    "verify", "show",
    "runs list", "catalog parts", "get p1", "validate", "capture --dry-run", "set p1 angle=3 --dry-run",
    "drift --watch --looks 1",
    "render --view top", "ruler p1 p2", "note p1", "stash list", "data status", "sim nudge p1 --dx 1",
)  # fmt: skip
"""Commands that write neither commits nor manifests and move nothing of the bench."""
WRITES = (
    "apply --auto-approve", "apply e1 --auto-approve -- p2", "set p1 angle=3", "capture", "commit -m x --capture",
    "note p1 scratched", "merge e2", "stash push", "revert HEAD", "cherry-pick E1-2", "checkout e1 --files-only",
)  # fmt: skip
SAID = "from now on git merges manifests through PICO here"


@pytest.fixture
def clone(shel: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A lab as somebody gets it, of whom git knows nothing but that."""
    folder = tmp_path / "clone"
    subprocess.run(["git", "clone", "-q", str(shel), str(folder)], check=True)
    for branch in ("e1", "e2"):
        subprocess.run(["git", "branch", "-q", branch, f"origin/{branch}"], cwd=folder, check=True)
    monkeypatch.chdir(folder)
    return folder


def kept(folder: Path) -> dict[str, bytes]:
    """Return what git keeps, apart from caches of PICO's own."""
    git = folder / ".git"
    files = (p for p in git.rglob("*") if p.is_file() and git / "pico" not in p.parents)
    return {p.relative_to(git).as_posix(): p.read_bytes() for p in files}


@pytest.mark.parametrize("words", LOOKS)
def test_looking_writes_nothing_into_git(clone: Path, pico: Pico, words: str) -> None:
    os.utime(clone / "state" / "table.yaml")  # git would refresh its index
    before = kept(clone)
    answer = pico(*words.split())
    assert answer.code in (0, 1) and "Traceback" not in answer.err and "error[" not in answer.err, answer
    assert kept(clone) == before
    assert SAID not in answer.err


@pytest.mark.parametrize("words", WRITES)
def test_writing_has_git_call_pico_and_says_so_once(clone: Path, pico: Pico, words: str) -> None:
    if words.startswith("stash"):
        edit(clone / "state" / "table.yaml", "exposure: 10", "exposure: 11")
    assert pico(*words.split()).err.count(SAID) == 1
    assert b"pico.history.merge.driver" in kept(clone)["config"]
    assert SAID not in pico(*words.split()).err


def test_doctor_says_that_git_does_not_know_pico_yet(clone: Path, pico: Pico) -> None:
    assert "the next command that writes sets them, too" in pico("doctor").err


def test_drift_and_verify_tell_what_happened_and_plan_what_brings_it_back(shel: Path, pico: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    pico("sim", "nudge", "p2", "--dx", "5")
    assert pico("move", "lx_100", "x=600", "y=420", "yaw=0", "-y").code == 0
    assert pico("set", "p1", "angle=60", "-y").code == 0
    for words in (["drift"], ["verify", "HEAD"], ["verify"]):
        told = " ".join(pico(*words).out.split())
        assert "~ p2 moved 5 mm (dx +5) from (520, 420, 0°) to (525, 420, 0°)" in told
        assert "+ lx_100 placed at (600, 420, 0°) from storage/a1" in told
        assert "~ p1.angle 90 → 60 deg" in told
    changes = {(c["component"], c["tunable"]): c for c in pico("drift", "--json").data["changes"]}
    assert (changes["p2", "pose"]["before"]["x"], changes["p2", "pose"]["after"]["x"]) == (520, 525)
    plan = " ".join(pico("plan").out.split())
    assert "~ p2 (525, 420, 0°) → (520, 420, 0°)" in plan and "~ p1.angle 60 → 90 deg" in plan
    assert "- lx_100 (600, 420, 0°) → storage/a1" in plan


def test_a_part_that_left_the_inventory_is_a_stranger_that_status_and_plan_name(shel: Path, pico: Pico) -> None:
    assert pico("apply", "e1", "--auto-approve").code == 0
    edit(Path("lab.yaml"), "  lx_125:\n    type: plano_convex_125\n    marker: 5\n    home: storage/a3\n", "")
    edit(Path("state/table.yaml"), "  lx_125:\n    slot: storage/a3\n", "")
    assert pico("bench", "update", "--auto-approve").code == 0
    assert "unknown/5 - - (395, 420, 0°)" in " ".join(pico("status").out.split())
    plan = pico("plan")
    assert "note[stranger]: unknown/5 stands at (395, 420, 0°)" in plan.err and "`pico import`" in plan.err
    drift = pico("drift")  # HEAD still has the part
    assert drift.code == 0 and "~ p2 turned +30°" in " ".join(drift.out.split()) and "lx_125" not in drift.out
    assert pico("render", "--view", "top", "--size", "240", "--out", "with.png").code == 0
    assert pico("render", "--view", "top", "--size", "240", "--manifest", "--out", "without.png").code == 0
    assert Path("with.png").read_bytes() != Path("without.png").read_bytes()
    assert pico("render", "--out", "bench.svg").code == 0 and "unknown/5" in Path("bench.svg").read_text()
    assert pico("ruler", "unknown/5", "p1").code == 0


def test_before_the_first_commit_nothing_is_called_committed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pico: Pico
) -> None:
    assert pico("init", str(tmp_path / "bench")).code == 0
    monkeypatch.chdir(tmp_path / "bench")
    assert pico("apply", "--auto-approve").code == 0
    told = pico("status").out
    assert "nothing is committed yet" in told and "committed (" not in told
    assert " · the manifest ·" in pico("plan").out
