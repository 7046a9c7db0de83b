"""Each command that writes, wherever git stands: it works, or refuses in words, and nothing is lost."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from commanding import Brought, Pico

MARK = "  # an edit"
WRITERS = {
    "apply": ("apply", "e2", "--auto-approve"),
    "apply the manifest": ("apply", "--auto-approve"),
    "checkout": ("checkout", "e2", "--auto-approve"),
    "checkout files": ("checkout", "e2", "--files-only"),
    "take": ("checkout", "e2", "--files-only", "--", "p2"),
    "commit": ("commit", "--planned", "-m", "more"),
    "capture": ("capture",),
    "note": ("note", "p2", "scratched"),
    "merge": ("merge", "e2"),
    "revert": ("revert", "HEAD"),
    "cherry-pick": ("cherry-pick", "e2"),
    "stash": ("stash",),
    "bisect": ("bisect", "run", "e1", "e1~2", "--expect", "p2.pose.yaw < 10", "--auto-approve"),
}


def git(folder: Path, *words: str, code: int | None = 0) -> str:
    done = subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True, check=False)
    assert code is None or done.returncode == code, done.stdout + done.stderr
    return done.stdout.strip()


def edit(folder: Path, old: str, new: str) -> None:
    path = folder / "state/table.yaml"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def first_x(folder: Path) -> str:
    return next(
        line for line in (folder / "state/table.yaml").read_text().splitlines() if line.strip().startswith("x:")
    )


def conflict(shel: Path) -> None:
    """Two branches that say another x of the same part."""
    here = first_x(shel)
    git(shel, "checkout", "-q", "-b", "theirs")
    edit(shel, here, here.split(":")[0] + ": 301")
    git(shel, "commit", "-q", "-a", "-m", "theirs")
    git(shel, "checkout", "-q", "-b", "ours", "HEAD~1")
    edit(shel, here, here.split(":")[0] + ": 302")
    git(shel, "commit", "-q", "-a", "-m", "ours")


def detached(shel: Path) -> None:
    git(shel, "checkout", "-q", "--detach")


def dirty(shel: Path) -> None:
    here = first_x(shel)
    edit(shel, here, here + MARK)


def staged(shel: Path) -> None:
    dirty(shel)
    git(shel, "add", "-A")


def unborn(shel: Path) -> None:
    git(shel, "checkout", "-q", "--orphan", "fresh")


def merging(shel: Path) -> None:
    conflict(shel)
    git(shel, "merge", "theirs", code=1)


def merged_clean(shel: Path) -> None:
    conflict(shel)
    git(shel, "merge", "--no-commit", "-s", "ours", "theirs")


def rebasing(shel: Path) -> None:
    conflict(shel)
    git(shel, "rebase", "theirs", code=1)


def picking(shel: Path) -> None:
    conflict(shel)
    git(shel, "cherry-pick", "theirs", code=1)


def reverting(shel: Path) -> None:
    conflict(shel)
    git(shel, "revert", "--no-edit", "theirs", code=1)


def bisecting(shel: Path) -> None:
    git(shel, "bisect", "start", "HEAD", "HEAD~2")


STANDINGS: dict[str, Callable[[Path], None]] = {
    f.__name__: f
    for f in (detached, dirty, staged, unborn, merging, merged_clean, rebasing, picking, reverting, bisecting)
}
REFUSED = {(s, w) for s in ("dirty", "staged") for w in ("checkout", "checkout files", "revert", "cherry-pick")}
MOVERS = ("apply", "apply the manifest", "checkout", "bisect")
LIKE_OTHERS = ("staged", "reverting")
"""Stand as `dirty` and `picking` do."""


def takes_long(standing: str, writer: str) -> bool:
    """Return whether a case is left to the slow tests: where arms move, and where another standing is like it."""
    return standing in LIKE_OTHERS or (writer in MOVERS and standing not in ("detached", "dirty", "merging"))


CASES = [pytest.param(s, w, marks=[pytest.mark.slow] if takes_long(s, w) else []) for s in STANDINGS for w in WRITERS]


@pytest.mark.parametrize(("standing", "writer"), CASES)
def test_it_works_or_refuses_and_nothing_is_lost(
    shel: Path, pico: Pico, brought: Brought, standing: str, writer: str
) -> None:
    brought(STANDINGS[standing])
    before, tips = saved(shel), git(shel, "for-each-ref", "--format=%(objectname)").split()
    answer = pico(*WRITERS[writer])
    said = answer.out + answer.err
    assert "PICO itself failed" not in said, said
    assert answer.code in (0, 1, 2, 3, 5, 6, 7)
    assert answer.code == 0 or answer.err.strip() or writer == "apply the manifest", said
    git(shel, "fsck", "--no-dangling", "--strict")
    after = saved(shel)
    if answer.code not in (0, 3):
        assert after == before, said
    reach = git(shel, "rev-list", "--all", "--reflog").split()
    assert set(tips) <= set(reach)
    text = before[1]
    kept = MARK in after[1] if writer in ("take", "capture") and MARK in text else text.strip() in everything(shel)
    assert text == after[1] or kept, said
    if (standing, writer) in REFUSED:
        assert answer.code == 1 and "edit" in answer.err
    if standing == "merged_clean" and writer in ("stash", "merge", "revert", "cherry-pick", "checkout files"):
        assert answer.code == 1 and "a merge is under way" in answer.err and "pico stash" not in answer.err


def saved(shel: Path) -> tuple[str, str, str]:
    """HEAD and its branch, the manifest, and what is staged."""
    head = git(shel, "rev-parse", "--verify", "-q", "HEAD", code=None)
    branch = git(shel, "rev-parse", "--symbolic-full-name", "HEAD", code=None)
    return head + branch, (shel / "state/table.yaml").read_text(), git(shel, "ls-files", "--stage")


def everything(shel: Path) -> str:
    """Every version of the manifest that git has."""
    names = git(shel, "cat-file", "--batch-all-objects", "--batch-check=%(objectname) %(objecttype)").splitlines()
    blobs = "\n".join(n.split()[0] for n in names if n.endswith("blob"))
    done = subprocess.run(
        ["git", "cat-file", "--batch"], cwd=shel, input=blobs, capture_output=True, text=True, check=True
    )
    return done.stdout


def test_a_lock_that_git_stash_does_not_speak_of_is_named(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pico.history.writing.index_lock.ALONE", 0.05)
    table = shel / "state" / "table.yaml"
    table.write_text(table.read_text().replace("x: 520", "x: 530"))
    lock = shel / ".git" / "index.lock"
    lock.touch()
    answer = pico("stash")
    assert answer.code == 1 and str(lock) in answer.err
    lock.unlink()
    assert pico("stash").code == 0
