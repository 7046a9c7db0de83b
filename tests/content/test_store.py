"""The content store: what went in comes out, or an error that names it; never half of it."""

from __future__ import annotations

import hashlib
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pico.content.store import Store
from pico.diagnostics import PicoError


def sha(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def files(store: Store) -> list[Path]:
    return sorted(p for p in store.root.rglob("*") if p.is_file())


@given(pieces=st.lists(st.binary(max_size=200), max_size=5))
@settings(max_examples=30, deadline=None)
def test_what_goes_in_in_any_form_comes_out(pieces: list[bytes]) -> None:
    with TemporaryDirectory() as folder:
        store, data = Store(Path(folder) / "cas"), b"".join(pieces)
        path = Path(folder) / "file"
        path.write_bytes(data)
        names = {store.put(data), store.put(path), store.put(iter(pieces))}
        assert names == {sha(data)}
        assert store.get(sha(data)) == data
        assert list(store.all()) == [sha(data)]
        assert (store.has(sha(data)), store.size(sha(data))) == (True, len(data))
        assert files(store) == [store.root / "sha256" / sha(data)[:2] / sha(data)[2:4] / sha(data)]


def test_objects_are_read_only(tmp_path: Path) -> None:
    store = Store(tmp_path)
    assert store.path(store.put(b"frame")).stat().st_mode & 0o777 == 0o444


def test_a_store_that_was_never_written_is_empty(tmp_path: Path) -> None:
    store = Store(tmp_path / "nothing")
    assert list(store.all()) == []
    assert not store.has(sha(b""))
    with pytest.raises(PicoError, match=f"the object {sha(b'')} is not in"):
        store.get(sha(b""))
    assert not store.root.exists()


@pytest.mark.parametrize("change", [lambda b: b[:-1], lambda b: b + b"x", lambda b: b"X" + b[1:], lambda b: b""])
def test_a_damaged_object_is_named_and_set_aside_and_an_intact_copy_takes_its_place(tmp_path: Path, change) -> None:
    store = Store(tmp_path)
    name = store.put(b"a camera frame")
    store.path(name).chmod(0o644)
    store.path(name).write_bytes(change(b"a camera frame"))
    with pytest.raises(PicoError, match=f"the object {name} is damaged"):
        store.get(name)
    assert not store.has(name)
    assert (tmp_path / "damaged" / name).read_bytes() == change(b"a camera frame")
    store.put(b"a camera frame")
    assert store.get(name) == b"a camera frame"


def test_putting_it_again_heals_an_object_that_was_damaged_unnoticed(tmp_path: Path) -> None:
    store = Store(tmp_path)
    name = store.put(b"a camera frame")
    store.path(name).chmod(0o644)
    store.path(name).write_bytes(b"A camera frame")
    store.put(b"a camera frame")
    assert store.is_intact(name)


def test_what_has_another_hash_than_expected_is_not_kept(tmp_path: Path) -> None:
    store = Store(tmp_path)
    with pytest.raises(PicoError, match=f"the object {sha(b'right')} is damaged: what arrived has the SHA-256"):
        store.put(b"wrong", expected=sha(b"right"))
    assert files(store) == []


def test_a_source_that_breaks_off_leaves_nothing(tmp_path: Path) -> None:
    def broken():
        yield b"half"
        raise OSError(5, "Input/output error", "share")

    store = Store(tmp_path)
    with pytest.raises(PicoError, match="share: input/output error"):
        store.put(broken())
    assert files(store) == []


@pytest.mark.parametrize("name", ["", "../../../etc/passwd", "AB" * 32, "ab" * 31, "sha256:" + "ab" * 32])
def test_a_name_that_is_no_hash_reaches_no_file(tmp_path: Path, name: str) -> None:
    for ask in (Store(tmp_path).has, Store(tmp_path).get, Store(tmp_path).remove):
        with pytest.raises(PicoError, match="is not a SHA-256"):
            ask(name)


def test_what_is_no_object_is_not_listed(tmp_path: Path) -> None:
    store = Store(tmp_path)
    name = store.put(b"frame")
    (store.path(name).parent / "notes.txt").write_text("mine")
    stray = tmp_path / "sha256" / "00" / "00" / name
    stray.parent.mkdir(parents=True)
    stray.write_bytes(b"frame")
    assert list(store.all()) == [name]


def test_only_what_is_old_enough_is_removed(tmp_path: Path) -> None:
    store = Store(tmp_path)
    name = store.put(b"frame")
    assert store.remove(name, older=3600) == 0
    assert store.has(name)
    os.utime(store.path(name), (time.time() - 7200,) * 2)
    assert store.age(name) > 7000
    store.put(b"frame")
    assert store.remove(name, older=3600) == 0  # putting it again made it new
    assert store.remove(name) == 5
    assert store.remove(name) == 0
    assert files(store) == []


def test_only_temporary_files_that_nobody_writes_any_more_are_swept(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.put(b"frame")
    for name, age in (("old", 2 * 86400), ("new", 10)):
        (tmp_path / "tmp" / name).write_bytes(b"half")
        os.utime(tmp_path / "tmp" / name, (time.time() - age,) * 2)
    assert store.sweep() == 4
    assert [p.name for p in (tmp_path / "tmp").iterdir()] == ["new"]


def test_many_writers_and_a_remover_at_once_never_leave_half_an_object(tmp_path: Path) -> None:
    data = [bytes([n]) * 50_000 for n in range(4)]

    def write(number: int) -> None:
        store = Store(tmp_path)
        assert store.put(data[number % 4]) == sha(data[number % 4])
        if number % 5 == 0:
            store.remove(sha(data[number % 4]))

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(write, range(80)))
    store = Store(tmp_path)
    assert all(store.is_intact(name) for name in store.all())
    assert set(files(store)) == {store.path(name) for name in store.all()}


_WRITER = """
import os, sys
from pathlib import Path
from pico.content.store import Store
store, number = Store(Path(sys.argv[1])), 0
while True:
    store.put(b"%d" % number * 20_000)
    print(number, flush=True)
    number += 1
"""


def test_a_writer_killed_at_any_moment_leaves_whole_objects_or_none(tmp_path: Path) -> None:
    said = []
    for kill in range(5):
        writer = subprocess.Popen([sys.executable, "-c", _WRITER, str(tmp_path)], stdout=subprocess.PIPE, text=True)
        assert writer.stdout
        said = [writer.stdout.readline() for _ in range(3 + kill)]
        writer.send_signal(signal.SIGKILL)
        writer.communicate()
    store = Store(tmp_path)
    found = list(store.all())
    assert all(store.is_intact(name) for name in found)
    assert {sha(line.strip().encode() * 20_000) for line in said} <= set(found)


def test_what_a_writer_left_that_is_dead_goes_with_the_next_one_and_that_of_others_stays(tmp_path: Path) -> None:
    store, tmp = Store(tmp_path), tmp_path / "tmp"
    tmp.mkdir()
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    here = os.uname().nodename
    names = {
        "dead": f".{here}-a.{dead.pid}.tmp",
        "alive": f".{here}-b.{os.getpid()}.tmp",
        "there": f".x-c.{dead.pid}.tmp",
    }
    for name in names.values():
        (tmp / name).write_bytes(b"half")
    store.put(b"whole")
    assert sorted(path.name for path in tmp.iterdir()) == sorted([names["alive"], names["there"]])
