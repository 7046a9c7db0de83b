"""Writes what is published into a folder or a zip file, complete or not at all, the same bytes each time."""

from __future__ import annotations

import shutil
import zipfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import BinaryIO

from pico.bench.publishing.parts import File
from pico.content.store import CHUNK, Store
from pico.diagnostics import PicoError, error
from pico.disk import writing


def write(files: Iterable[File], store: Store, out: Path, moment: datetime) -> None:
    """Write `files` to `out`, a new zip file where it ends with `.zip`, else a new folder; `moment` dates them.

    Raises PicoError where `out` exists or can't be written, and for objects that are damaged.
    """
    with writing(out):
        if out.exists() and not (out.is_dir() and not any(out.iterdir())):
            raise PicoError(error("exists", f"{out} exists already", hint="name another place with `--out`"))
        fresh = out.with_name(f".{out.name}.unfinished")
        _discard(fresh)
        try:
            (_write_zip if out.suffix.lower() == ".zip" else _write_folder)(files, store, fresh, moment)
            if out.is_dir():
                out.rmdir()
            fresh.rename(out)
        except BaseException:
            with suppress(OSError):
                _discard(fresh)
            raise


def _write_zip(files: Iterable[File], store: Store, out: Path, moment: datetime) -> None:
    date = max(moment.astimezone(UTC), datetime(1980, 1, 1, tzinfo=UTC)).timetuple()[:6]
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
        for file in files:
            entry = zipfile.ZipInfo(file.path, date)
            entry.compress_type, entry.create_system, entry.external_attr = zipfile.ZIP_DEFLATED, 3, 0o100644 << 16
            with archive.open(entry, "w", force_zip64=file.size >= 1 << 31) as target, _source(file, store) as pieces:
                for piece in pieces:
                    target.write(piece)


def _write_folder(files: Iterable[File], store: Store, out: Path, _: datetime) -> None:
    for file in files:
        path = out / file.path
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("xb") as target, _source(file, store) as pieces:
            for piece in pieces:
                target.write(piece)


@contextmanager
def _source(file: File, store: Store) -> Iterator[Iterator[bytes]]:
    if file.content is not None:
        yield iter((file.content,))
        return
    with store.open(file.sha256) as source:
        yield _pieces(source)


def _pieces(source: BinaryIO) -> Iterator[bytes]:
    while piece := source.read(CHUNK):
        yield piece


def _discard(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)
