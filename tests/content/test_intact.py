"""Whether an object is intact: only its own bytes are, what is damaged is set aside, what cannot be read is told."""

from __future__ import annotations

import hashlib
import os
import time
from pathlib import Path
from typing import Any

import pytest

from pico.content import store as storing
from pico.content.store import Store
from pico.diagnostics import PicoError

DATA = b"a camera frame"
NAME = hashlib.sha256(DATA).hexdigest()


def kept(root: Path, data: bytes | None) -> Store:
    """A store with some bytes under the name of others; None for no object."""
    store = Store(root)
    store.put(DATA)
    path = store.path(NAME)
    path.chmod(0o644)
    if data is None:
        path.unlink()
    else:
        path.write_bytes(data)
    return store


@pytest.mark.parametrize("data", [DATA, b"", DATA[:-1], DATA + b"\0", b"A camera frame", b"another one altogether"])
def test_an_object_is_intact_where_it_has_the_bytes_of_its_name_and_else_set_aside(tmp_path: Path, data: bytes) -> None:
    store = kept(tmp_path, data)
    intact = data == DATA
    assert store.is_intact(NAME) is intact
    assert store.has(NAME) is intact and (tmp_path / "damaged" / NAME).exists() is not intact
    if not intact:
        assert (tmp_path / "damaged" / NAME).read_bytes() == data
        with pytest.raises(PicoError) as caught:
            store.is_intact(NAME)
        assert caught.value.diagnostics[0].code == "data-missing", "one that is gone is not told as damaged again"


def code(ask: Any, *given: Any) -> str:
    with pytest.raises(PicoError) as caught:
        ask(*given)
    assert NAME[:12] in str(caught.value) or caught.value.diagnostics[0].code in ("data-io", "data-name")
    return caught.value.diagnostics[0].code


def test_what_is_missing_or_no_name_is_neither_intact_nor_damaged(tmp_path: Path) -> None:
    assert code(kept(tmp_path, None).is_intact, NAME) == "data-missing"
    assert code(Store(tmp_path / "none").is_intact, NAME) == "data-missing"
    assert code(Store(tmp_path).is_intact, "nothing") == "data-name"


@pytest.mark.parametrize("failing", ["open", "read"])
def test_what_the_system_refuses_is_told_and_sets_nothing_aside(
    tmp_path: Path, failing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = kept(tmp_path, DATA)

    def refused(*_: Any, **__: Any) -> Any:
        raise PermissionError(13, "Permission denied")

    if failing == "open":
        monkeypatch.setattr(Path, "open", refused)
    else:
        monkeypatch.setattr(storing, "_read", refused)
    for ask in (store.is_intact, store.get, store.open):
        assert code(ask, NAME) == "data-io"
    monkeypatch.undo()
    assert store.is_intact(NAME) and not (tmp_path / "damaged").exists()


def test_a_damaged_object_of_a_share_that_cannot_be_written_is_refused_each_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = kept(tmp_path, b"damaged")

    def refused(*_: Any, **__: Any) -> Any:
        raise PermissionError(30, "Read-only file system")

    monkeypatch.setattr(Path, "replace", refused)
    assert not store.is_intact(NAME) and not store.is_intact(NAME) and store.has(NAME)
    assert code(store.get, NAME) == "data-damaged"


def test_an_object_larger_than_a_chunk_is_read_to_its_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(storing, "CHUNK", 4)
    store = Store(tmp_path)
    name = store.put(b"0123456789")
    assert store.is_intact(name) and store.get(name) == b"0123456789"
    with store.open(name) as file:
        assert file.read() == b"0123456789"
    store.path(name).chmod(0o644)
    store.path(name).write_bytes(b"012345678X")
    assert not store.is_intact(name)


@pytest.mark.parametrize("needed", [True, False])
@pytest.mark.parametrize("again", [True, False])
@pytest.mark.parametrize("days", [0.9, 1.1])
def test_a_damaged_copy_goes_after_a_day_unless_it_is_all_that_is_left_of_what_is_needed(
    tmp_path: Path, needed: bool, again: bool, days: float
) -> None:
    store = kept(tmp_path, b"damaged")
    assert not store.is_intact(NAME)
    if again:
        store.put(DATA)
    damaged = tmp_path / "damaged" / NAME
    then = time.time() - days * 86400
    os.utime(damaged, (then, then))
    goes = days > 1 and not (needed and not again)
    assert store.sweep({NAME} if needed else ()) == (len(b"damaged") if goes else 0)
    assert damaged.exists() is not goes and store.has(NAME) is again


def test_the_age_of_an_object_is_since_it_was_last_put(tmp_path: Path) -> None:
    store = kept(tmp_path, DATA)
    then = time.time() - 500.0
    os.utime(store.path(NAME), (then, then))
    assert 499.0 < store.age(NAME) < 520.0 and store.remove(NAME, older=1000.0) == 0 and store.has(NAME)
    store.put(DATA)
    assert 0.0 <= store.age(NAME) < 20.0
