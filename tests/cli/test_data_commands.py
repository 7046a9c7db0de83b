"""`pico data`: large data goes where copies are kept and comes back, and nothing that is needed gets lost."""

from __future__ import annotations

import json
import os
import shutil
import sys
import time
from pathlib import Path

import pytest
from commanding import Pico, Typed
from data_labs import commit_run, damage, git, put, sha, write_run

from pico.history.data.lab import LabData


def stored(folder: Path) -> set[str]:
    return set(LabData.discover(folder).store.all())


def age(folder: Path, days: float) -> None:
    store = LabData.discover(folder).store
    for name in store.all():
        os.utime(store.path(name), (time.time() - days * 86400,) * 2)


@pytest.fixture
def share(tmp_path: Path) -> Path:
    folder = tmp_path / "share"
    folder.mkdir()
    return folder


@pytest.fixture
def lab(shel: Path, share: Path) -> Path:
    git("config", "pico.data.remote", str(share))
    return shel


def test_what_is_pushed_comes_back_into_a_clone(lab: Path, share: Path, tmp_path: Path, pico: Pico) -> None:
    a = commit_run(lab, "run-a", b"frame a")
    git("switch", "-q", "-c", "side")
    b = commit_run(lab, "run-b", b"frame b", b"longer frame b")
    git("switch", "-q", "main")
    assert pico("data", "push").out.startswith(f"Sent 3 objects, 28 B, to {share}.")
    git("clone", "-q", str(lab), "clone", at=tmp_path)
    clone = tmp_path / "clone"
    git("config", "pico.data.remote", "../share", at=clone)
    assert pico("-C", str(clone), "data", "pull").out.startswith(f"Fetched 3 objects, 28 B, from {share}.")
    assert LabData.discover(clone).store.get(a) == b"frame a"
    assert LabData.discover(clone).store.get(b) == b"longer frame b"
    assert pico("-C", str(clone), "data", "fsck").code == 0


def test_a_second_push_sends_only_what_lacks(lab: Path, share: Path, pico: Pico) -> None:
    commit_run(lab, "run-a", b"frame a")
    assert pico("data", "push", "--json").data["kind"] == "sent"
    before = {p: p.stat().st_mtime_ns for p in share.rglob("*") if p.is_file()}
    assert pico("data", "push").out.startswith("Nothing to be sent")
    b = commit_run(lab, "run-b", b"frame b")
    sent = pico("data", "push", "--json").data["objects"]
    assert [(o["sha256"], o["runs"], o["name"]) for o in sent] == [(b, ["run-b"], "frame0.bin")]
    assert {p: p.stat().st_mtime_ns for p in before} == before


def test_status_says_what_is_where(lab: Path, share: Path, pico: Pico) -> None:
    commit_run(lab, "run-a", b"frame a")
    pico("data", "push")
    here = commit_run(lab, "run-b", b"frame b")
    gone, there = commit_run(lab, "run-c", b"frame c"), commit_run(lab, "run-d", b"frame d")
    spare = put(lab, b"an orphan")
    pico("data", "push", str(share))
    for path in share.rglob(here):
        path.unlink()
    for path in share.rglob(gone):
        path.unlink()
    store = LabData.discover(lab).store
    store.remove(gone)
    store.remove(there)
    found = pico("data", "status", "--json").data
    assert len(found["needs"]) == 4
    assert [n["sha256"] for n in found["unsent"]] == [here]
    assert {n["sha256"] for n in found["absent"]} == {gone, there}
    assert [n["sha256"] for n in found["lost"]] == [gone]
    assert found["spare"] == {spare: len(b"an orphan")}
    out = pico("data", "status").out
    assert f"missing {gone}  frame0.bin of run-c" in out
    assert "`pico data push` sends them" in out
    assert "`pico data pull` brings them" in out


def test_without_a_place_it_says_how_to_name_one(shel: Path, pico: Pico) -> None:
    commit_run(shel, "run-a", b"frame a")
    for words in (["push"], ["pull"]):
        answer = pico("data", *words)
        assert answer.code == 1
        assert "`git config pico.data.remote FOLDER`" in answer.err
    assert pico("data", "status").code == 0


def test_a_share_that_is_not_mounted_is_not_made(lab: Path, tmp_path: Path, pico: Pico) -> None:
    commit_run(lab, "run-a", b"frame a")
    answer = pico("data", "push", str(tmp_path / "nas"))
    assert answer.code == 1
    assert f"there is no folder {tmp_path / 'nas'}" in answer.err
    assert not (tmp_path / "nas").exists()


def test_a_share_that_is_full_or_read_only_is_told_in_a_sentence(lab: Path, share: Path, pico: Pico) -> None:
    commit_run(lab, "run-a", b"frame a")
    (share / "tmp").write_text("somebody's file where the folder should be")
    answer = pico("data", "push")
    assert answer.code == 1
    assert "error[data-io]" in answer.err
    assert str(share) in answer.err


def test_what_arrives_damaged_is_refused_and_the_others_come(lab: Path, share: Path, pico: Pico) -> None:
    bad = commit_run(lab, "run-a", b"frame a")
    good = commit_run(lab, "run-b", b"frame b")
    pico("data", "push")
    damage(next(share.rglob(bad)))
    for name in (bad, good):
        LabData.discover(lab).store.remove(name)
    answer = pico("data", "pull")
    assert answer.code == 1
    assert f"the object {bad} is damaged" in answer.err
    assert "frame0.bin of run-a" in answer.err
    assert "another clone may have an intact copy" in answer.err
    assert stored(lab) == {good}
    LabData.discover(lab).store.put(b"frame a")
    assert pico("data", "push").code == 0  # the damaged copy was set aside, so that an intact one can take its place
    assert pico("data", "pull").code == 0
    assert next(share.rglob(f"sha256/*/*/{bad}")).read_bytes() == b"frame a"


def test_what_is_damaged_here_is_not_sent(lab: Path, share: Path, pico: Pico) -> None:
    bad, good = commit_run(lab, "run-a", b"frame a"), commit_run(lab, "run-b", b"frame b")
    damage(LabData.discover(lab).store.path(bad))
    answer = pico("data", "push")
    assert answer.code == 1
    assert f"the object {bad} is damaged" in answer.err
    assert [p.name for p in share.rglob("*") if p.is_file()] == [good]


def test_fsck_names_damaged_and_missing_objects_with_their_runs_and_pull_heals(lab: Path, pico: Pico) -> None:
    bad, gone = commit_run(lab, "run-a", b"frame a"), commit_run(lab, "run-b", b"frame b")
    assert pico("data", "fsck").code == 0
    pico("data", "push")
    damage(LabData.discover(lab).store.path(bad))
    LabData.discover(lab).store.remove(gone)
    answer = pico("data", "fsck")
    assert answer.code == 1
    assert f"damaged {bad}  frame0.bin of run-a" in answer.out
    assert f"missing {gone}  frame0.bin of run-b" in answer.out
    assert pico("data", "pull").code == 0
    assert pico("data", "fsck").code == 0


def test_gc_removes_old_orphans_and_asks_first(lab: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    kept, orphan = commit_run(lab, "run-a", b"frame a"), put(lab, b"an orphan")
    assert "Nothing to remove; 1 object more that nothing needs, but young." in pico("data", "gc", "--auto-approve").out
    age(lab, days=15)
    monkeypatch.setattr("sys.stdin", Typed("n\n"))
    assert pico("data", "gc").code == 1
    assert pico("data", "gc", "--json").code == 1
    assert "1 object that nothing here needs, 9 B" in pico("data", "gc", "--dry-run").out
    assert stored(lab) == {kept, orphan}
    monkeypatch.setattr("sys.stdin", Typed("y\n"))
    assert "Removed 1 object, 9 B freed" in pico("data", "gc").out
    assert stored(lab) == {kept}


def test_gc_keeps_what_any_ref_reflog_index_worktree_or_loose_run_needs(lab: Path, tmp_path: Path, pico: Pico) -> None:
    def on(branch: str, run: str) -> str:
        git("switch", "-q", "-c", branch, "main")
        name = commit_run(lab, run, run.encode())
        git("switch", "-q", "main")
        return name

    kept = {on("side", "of-a-branch"), on("tagged", "of-a-tag"), on("odd", "of-an-odd-ref")}
    git("tag", "t", "tagged")
    git("update-ref", "refs/somebody/else", "odd")
    kept.add(on("dropped", "of-the-reflog"))
    git("branch", "-q", "-D", "tagged", "odd", "dropped")
    git("worktree", "add", "-q", "--detach", str(tmp_path / "second"))
    kept.add(commit_run(tmp_path / "second", "of-a-detached-worktree", b"detached"))
    kept.add(write_run(tmp_path / "second", "loose-in-a-worktree", b"loose"))
    kept.add(write_run(lab, "staged", b"staged"))
    git("add", "runs")
    shutil.rmtree(lab / "runs")
    kept.add(write_run(lab, "loose", b"loose here"))
    orphan = put(lab, b"an orphan")
    assert stored(lab) == kept | {orphan}
    assert pico("data", "gc", "--grace", "0d", "--auto-approve").code == 0
    assert stored(lab) == kept
    git("reflog", "expire", "--expire=now", "--all")
    pico("data", "gc", "--grace", "0d", "--auto-approve")
    assert len(kept - stored(lab)) == 1


def test_what_a_newer_pico_wrote_is_kept_and_what_is_no_run_does_no_harm(lab: Path, pico: Pico) -> None:
    kept = commit_run(lab, "run-a", b"frame a")
    path = lab / "runs" / "2026" / "11" / "run-a" / "run.json"
    path.write_text(path.read_text().replace("pico.run/v1", "pico.run/v9"))
    esc = lab / "runs" / "2026" / "11" / "\x1b[31mred" / "run.json"
    esc.parent.mkdir()
    esc.write_text(json.dumps({"artifacts": [{"sha256": sha(b"x"), "size": float("inf"), "name": "x"}]}))
    hostile = lab / "runs" / "2026" / "11" / "hostile" / "run.json"
    hostile.parent.mkdir()
    for text in ("[]", "{", '{"artifacts": 3}', '{"artifacts": [{"sha256": "../../config", "size": 1, "name": "x"}]}'):
        hostile.write_text(text)
        git("add", "-A")
        git("commit", "-q", "-m", "not of ours")
        assert pico("data", "status").code == 0
        assert pico("data", "gc", "--grace", "0d", "--auto-approve").code == 0
    assert stored(lab) == {kept}


def test_a_name_from_somebody_elses_repository_does_not_rule_the_terminal(lab: Path, pico: Pico) -> None:
    path = lab / "runs" / "2026" / "11" / "run\x1b[2J" / "run.json"
    path.parent.mkdir(parents=True)
    path.write_text(json.dumps({"artifacts": [{"sha256": sha(b"x"), "size": 1, "name": "\x1b]0;mine\x07"}]}))
    git("add", "-A")
    git("commit", "-q", "-m", "hostile")
    out = pico("data", "status").out
    assert f"missing {sha(b'x')}" in out
    assert "\x1b" not in out


def test_what_only_looks_like_a_run_is_not_read(lab: Path, tmp_path: Path, pico: Pico) -> None:
    kept = commit_run(lab, "run-a", b"frame a")
    (lab / "runs" / "2026" / "11" / "link").mkdir()
    (lab / "runs" / "2026" / "11" / "link" / "run.json").symlink_to("/dev/zero")
    (lab / "runs" / "2026" / "11" / "folder" / "run.json").mkdir(parents=True)
    (lab / "runs" / "2026" / "11" / "folder" / "run.json" / "x").write_text("{}")
    for _ in ("loose", "committed"):
        assert pico("data", "gc", "--grace", "0d", "--auto-approve").code == 0
        assert pico("data", "status").code == 0
        git("add", "-A")
        git("commit", "-q", "--allow-empty", "-m", "hostile")
    assert stored(lab) == {kept}


@pytest.mark.parametrize("grace", ["14", "d", "-1d", "1w"])
def test_a_grace_that_is_no_time_is_refused(lab: Path, pico: Pico, grace: str) -> None:
    answer = pico("data", "gc", f"--grace={grace}")
    assert answer.code == 1
    assert "write it as 14d, 6h, 30min or 0d" in answer.err


def test_a_broken_manifest_does_not_keep_the_data_from_being_sent(lab: Path, share: Path, pico: Pico) -> None:
    name = commit_run(lab, "run-a", b"frame a")
    (lab / "lab.yaml").write_text("{")
    assert pico("data", "push").code == 0
    assert [p.name for p in share.rglob("*") if p.is_file()] == [name]


def test_an_object_store_serves_as_a_folder_does(lab: Path, pico: Pico) -> None:
    import fsspec

    files, url = fsspec.filesystem("memory"), "memory://bucket/shel"
    commit_run(lab, "run-a", b"frame a")
    a, b = commit_run(lab, "run-b", b"frame b"), commit_run(lab, "run-c", b"frame c")
    assert len(pico("data", "push", url, "--json").data["objects"]) == 3
    assert pico("data", "push", url).out.startswith("Nothing to be sent")
    path = f"/bucket/shel/sha256/{a[:2]}/{a[2:4]}/{a}"
    files.pipe_file(path, b"fra")  # an upload that broke off
    assert [o["sha256"] for o in pico("data", "push", url, "--json").data["objects"]] == [a]
    files.pipe_file(path, b"Frame b")
    for name in (a, b):
        LabData.discover(lab).store.remove(name)
    answer = pico("data", "pull", url)
    assert answer.code == 1
    assert f"the object {a} is damaged" in answer.err
    assert LabData.discover(lab).store.get(b) == b"frame c"
    files.rm("/bucket", recursive=True)


def test_an_object_store_that_is_not_installed_names_the_extra(
    lab: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "fsspec", None)
    monkeypatch.setitem(sys.modules, "fsspec.core", None)
    answer = pico("data", "push", "s3://bucket/shel")
    assert answer.code == 1
    assert "pip install pico-lab[object-store]" in answer.err
    assert "Traceback" not in answer.err


def test_outside_of_a_repository_it_says_so(tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path))
    (tmp_path / "plain").mkdir()
    answer = pico("-C", str(tmp_path / "plain"), "data", "status")
    assert answer.code == 1
    assert "is in no Git repository" in answer.err


def test_a_folder_on_the_command_line_counts_from_where_it_is_called(shel: Path, share: Path, pico: Pico) -> None:
    name = commit_run(shel, "run-a", b"frame a")
    assert pico("-C", "state", "data", "push", "../../share").code == 0
    assert [p.name for p in share.rglob("*") if p.is_file()] == [name]


def test_gc_removes_nothing_while_a_bench_can_not_say_what_its_runs_need(lab: Path, pico: Pico) -> None:
    orphan = put(lab, b"an orphan")
    assert pico("move", "p1", "x=500", "-y").code == 0
    assert pico("data", "gc", "--grace", "0d", "--dry-run", "--json").data["removable"] == {orphan: 9}
    text = (lab / "lab.yaml").read_text()
    (lab / "lab.yaml").write_text("{")
    answer = pico("data", "gc", "--grace", "0d", "--auto-approve")
    assert answer.code == 1
    assert f"nobody can tell what the runs of the benches in {lab} need still" in answer.err
    assert stored(lab) == {orphan}
    (lab / "lab.yaml").write_text(text)


def test_pointers_are_as_git_lfs_writes_them_and_its_objects_come_back(lab: Path, tmp_path: Path, pico: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    assert pico("set", "p1", "angle=12", "-y").code == 0
    assert pico("commit", "-m", "p1 a little").code == 0
    path = next(lab.glob("runs/*/*/*/run.json"))
    name = put(lab, b"a frame")
    document = json.loads(path.read_text())
    document["artifacts"] = [{"name": "frame.png", "sha256": name, "size": 7, "media_type": "image/png"}]
    path.write_text(json.dumps(document))
    git("commit", "-q", "-a", "--amend", "--no-edit")
    answer = pico("data", "pointers")
    assert answer.code == 0, answer
    assert "1 pointer written, for 7 B." in answer.out
    written = path.parent / "artifacts" / "frame.png"
    text = f"version https://git-lfs.github.com/spec/v1\noid sha256:{name}\nsize 7\n"
    assert written.read_bytes() == text.encode()
    assert "runs/**/artifacts/** filter=lfs diff=lfs merge=lfs -text" in (lab / ".gitattributes").read_text().split(
        "\n"
    )
    object_ = lab / ".git" / "lfs" / "objects" / name[:2] / name[2:4] / name
    assert object_.read_bytes() == b"a frame"
    assert pico("data", "pointers").out.startswith("No pointer to write")
    LabData.discover(lab).store.remove(name)
    assert pico("data", "pull", "lfs", "--json").data["objects"][0]["sha256"] == name
    assert LabData.discover(lab).store.get(name) == b"a frame"
    answer = pico("data", "pointers", "nosuch")
    assert answer.code == 1
    assert "there is no run nosuch" in answer.err
    git("add", ".gitattributes", "runs")
    git("commit", "-q", "-m", "data by LFS")
    assert pico("runs", "list").code == 0
    assert pico("data", "status", "--json").data["absent"] == []
