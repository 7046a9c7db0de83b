"""Files of the working tree written so that a reader sees the old one or the new one."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Mapping
from pathlib import Path

from pico.diagnostics import PicoError, error


def write_files(root: Path, files: Mapping[str, bytes | None], scratch: Path) -> None:
    """Write files by path relative to `root`, folders as needed, as `write_file` does; None takes a file away."""
    for name, data in sorted(files.items()):
        if data is None:
            (root / name).unlink(missing_ok=True)
        else:
            write_file(root / name, data, scratch)


def write_file(path: Path, data: bytes, scratch: Path) -> None:
    """Write one file whole or not at all, first into the folder `scratch`, so that a kill leaves nothing beside it.

    It is on the disk before it takes the other's place. Only for who holds the lock of writers. Raises PicoError where
    the folder or the disk does not allow it, and where a link leads out of the lab.
    """
    _refuse_links(path, scratch.parent)
    try:
        scratch.mkdir(parents=True, exist_ok=True)
        path.parent.mkdir(parents=True, exist_ok=True)
        _write(path, data, scratch / "write.tmp")
    except OSError as exc:
        if exc.errno != errno.EXDEV:
            raise PicoError(error("folder", f"can't write {path}: {(exc.strerror or str(exc)).lower()}")) from exc
        _write(path, data, path.with_name(f".{path.name}.tmp"))  # `scratch` is on another disk


def _refuse_links(path: Path, lab: Path) -> None:
    """Raise PicoError where a link in the lab would take what is written out of it."""
    named, real = path.parent.absolute(), path.parent.resolve()
    top = lab.resolve()
    if not real.is_relative_to(top) and (named.is_relative_to(top) or named.is_relative_to(lab.absolute())):
        text = f"{path} is not written: a symbolic link leads to {real}, out of the lab"
        raise PicoError(error("symlink", text, hint="put a folder in its place"))


def _write(path: Path, data: bytes, fresh: Path) -> None:
    fresh.unlink(missing_ok=True)
    with fresh.open("xb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    if path.exists():
        shutil.copymode(path, fresh)
    fresh.replace(path)
