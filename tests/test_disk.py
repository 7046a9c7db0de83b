"""Files are whole or not there, and a disk that refuses is named."""

from __future__ import annotations

import errno
import os
import sqlite3
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from pico.diagnostics import PicoError
from pico.disk import mount_point, number_of, replace_whole, spoken, unwritable, write_all, write_whole
from pico.history.git import command
from pico.history.merge.lines import merge_lines
from pico.history.merge.markers import Labels


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_file_is_written_with_the_mode_of_the_one_before(tmp_path: Path) -> None:
    path = tmp_path / "plan"
    path.write_text("old")
    path.chmod(0o640)
    write_whole(path, b"new")
    assert path.read_text() == "new" and path.stat().st_mode & 0o777 == 0o640
    assert names(tmp_path) == ["plan"]


def test_what_ends_early_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    def pieces() -> Iterator[bytes]:
        yield b"new"
        raise OSError(errno.EIO, "Input/output error")

    path = tmp_path / "plan"
    path.write_text("old")
    with pytest.raises(OSError, match="Input/output"):
        replace_whole(path, pieces(), tmp_path / "fresh")
    assert path.read_text() == "old" and names(tmp_path) == ["plan"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
def test_a_full_disk_is_named_with_what_to_do() -> None:
    with pytest.raises(PicoError, match="can't write /dev/full: no space left on the disk mounted at ") as raised:
        write_whole(Path("/dev/full"), b"new")
    assert "df -h" in raised.value.diagnostics[0].hint


def test_a_file_takes_the_place_of_a_link_and_leaves_alone_what_that_points_at(tmp_path: Path) -> None:
    (tmp_path / "other").write_text("kept")
    (tmp_path / "plan").symlink_to(tmp_path / "other")
    write_whole(tmp_path / "plan", b"new")
    assert (tmp_path / "other").read_text() == "kept" and (tmp_path / "plan").read_text() == "new"


def test_what_a_killed_writer_left_is_cleared_and_what_a_living_one_writes_is_not(tmp_path: Path) -> None:
    dead = subprocess.Popen(["true"])
    dead.wait()
    for number in (dead.pid, os.getppid()):
        (tmp_path / f".plan.{number}.tmp").write_text("half")
    write_whole(tmp_path / "plan", b"new")
    assert names(tmp_path) == [f".plan.{os.getppid()}.tmp", "plan"]


def test_git_is_listened_to_and_merges_lines_where_there_is_no_room_for_temporary_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "full"))
    said = merge_lines(b"1\n2\n3\n", b"one\n2\n3\n", b"1\n2\nthree\n", Labels("ours", "base", "theirs"))
    assert said == (b"one\n2\nthree\n", True)
    assert list(command.stream(tmp_path, ["version"], doing="say its version"))
    with pytest.raises(PicoError, match="git did not fail"):
        list(command.stream(tmp_path, ["cat-file", "-p", "HEAD"], doing="fail"))


@pytest.mark.skipif(not os.access("/dev/shm", os.W_OK), reason="there is no /dev/shm here")
def test_a_disk_in_memory_is_a_disk_though_its_files_are_below_dev() -> None:
    with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
        path = Path(folder) / "sim" / "world.json"
        write_whole(path, b"new", folders=True)
        before = path.stat().st_ino
        write_whole(path, b"newer")
        assert path.read_text() == "newer" and path.stat().st_ino != before


def test_folders_are_made_only_where_that_is_asked_for(tmp_path: Path) -> None:
    with pytest.raises(PicoError, match="no such file or directory"):
        write_whole(tmp_path / "new" / "plan", b"new")
    write_whole(tmp_path / "new" / "plan", b"new", folders=True)
    assert (tmp_path / "new" / "plan").read_bytes() == b"new"


def test_the_words_of_sqlite_and_git_are_known() -> None:
    database = sqlite3.connect(":memory:")
    database.execute("PRAGMA max_page_count = 2")
    with pytest.raises(sqlite3.OperationalError) as raised:
        for number in range(100):
            database.execute(f"CREATE TABLE t{number} (a)")
    assert number_of(raised.value) == errno.ENOSPC
    assert spoken("fatal: Unable to create '.git/index.lock': Read-only file system") == errno.EROFS
    assert spoken("fatal: bad object HEAD") is None
    assert "read-only" in unwritable(Path("/proc/x"), OSError(errno.EROFS, "")).summary


def test_the_disk_of_a_file_that_is_not_there_yet_is_that_of_its_folder(tmp_path: Path) -> None:
    found = mount_point(tmp_path / "not" / "there")
    assert os.path.ismount(found) and tmp_path.resolve().is_relative_to(found)


def test_of_files_that_belong_together_none_is_written_where_one_can_not_be(tmp_path: Path) -> None:
    (tmp_path / "lab").write_text("old")
    with pytest.raises(PicoError, match=r"can.t write .*state"):
        write_all({tmp_path / "lab": b"new", tmp_path / "gone" / "state": b"new"})
    assert (tmp_path / "lab").read_text() == "old" and names(tmp_path) == ["lab"]
