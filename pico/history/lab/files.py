"""Files of the working tree written so that a reader sees the old one or the new one."""

from __future__ import annotations

import errno
from collections.abc import Mapping
from pathlib import Path

from pico.diagnostics import PicoError, error
from pico.disk import beside, replace_whole, writing


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
    with writing(path, code="folder"):
        scratch.mkdir(parents=True, exist_ok=True)
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            replace_whole(path, (data,), scratch / "write.tmp")
        except OSError as exc:
            if exc.errno != errno.EXDEV:
                raise
            replace_whole(path, (data,), beside(path))  # `scratch` is on another disk


def _refuse_links(path: Path, lab: Path) -> None:
    """Raise PicoError where a link in the lab would take what is written out of it."""
    named, real = path.parent.absolute(), path.parent.resolve()
    top = lab.resolve()
    if not real.is_relative_to(top) and (named.is_relative_to(top) or named.is_relative_to(lab.absolute())):
        text = f"{path} is not written: a symbolic link leads to {real}, out of the lab"
        raise PicoError(error("symlink", text, hint="put a folder in its place"))
