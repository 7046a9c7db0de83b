"""Manifest files: which of a folder count, and their bytes as text. Nothing of a file is trusted."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Iterator, Mapping
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.manifest.source import Source

MAX_BYTES = 2 * 1024 * 1024
MAX_LEVELS = 64
"""Folders in folders."""
_NOT_TEXT = re.compile(r"[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]")
_UTF8_BOM = b"\xef\xbb\xbf"
_OTHER_BOMS = (b"\xff\xfe", b"\xfe\xff", b"\x00\x00\xfe\xff")
_BEGIN = "begin it with `apiVersion: pico/v1`, or delete it"


def shown_path(path: Path) -> str:
    """Return a path as diagnostics show it: relative to the current directory where it lies below."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except (ValueError, OSError):
        return str(path)


def read_folder(root: Path) -> tuple[dict[str, bytes], list[Diagnostic]]:
    """Return every `*.yaml` below `root` by shown path, and what can't be read.

    Left out: dot-files, dot-folders and folders called `runs`. Symbolic links are refused, not followed.
    """
    files: dict[str, bytes] = {}
    found: list[Diagnostic] = []
    for path in _paths(root, found):
        shown = _below(root, path)
        try:
            files[shown] = _read(path, shown)
        except PicoError as exc:
            found.extend(exc.diagnostics)
    return files, found


def _paths(root: Path, found: list[Diagnostic]) -> Iterator[Path]:
    try:
        yield from _walk(root)
    except PicoError as exc:
        found.extend(exc.diagnostics)


def _walk(root: Path) -> Iterator[Path]:
    top = len(root.parts)
    for folder, folders, names in os.walk(root):
        if len(Path(folder).parts) - top >= MAX_LEVELS:
            at = _below(root, Path(folder))
            raise PicoError(_whole(at, "too-deep", f"folders nested deeper than {MAX_LEVELS}", "no lab needs that"))
        folders[:] = sorted(n for n in folders if not n.startswith(".") and n != "runs")
        for name in sorted(names):
            if name.endswith(".yaml") and not name.startswith("."):
                yield Path(folder) / name


def _below(root: Path, path: Path) -> str:
    return str(Path(shown_path(root)) / path.relative_to(root))


def _read(path: Path, shown: str) -> bytes:
    try:
        mode = path.lstat().st_mode
        if stat.S_ISLNK(mode):
            raise PicoError(_whole(shown, "symlink", "a symbolic link is not read", "put the file itself here"))
        if not stat.S_ISREG(mode):
            raise PicoError(_whole(shown, "not-a-file", "not a regular file", "put a text file here, or rename it"))
        with path.open("rb") as file:
            return file.read(MAX_BYTES + 1)
    except OSError as exc:
        hint = "check that the file exists and that you may read it"
        raise PicoError(_whole(shown, "unreadable", f"can't be read: {exc.strerror}", hint)) from exc


def _whole(path: str, code: str, summary: str, hint: str) -> Diagnostic:
    return error(code, f"{path}: {summary}", hint=hint, source=Source(path, "").range(0))


def decode(path: str, data: bytes) -> tuple[Source | None, list[Diagnostic]]:
    """Return the text of a manifest, or why it is none: empty, too large, binary, another encoding."""
    if len(data) > MAX_BYTES:
        hint = "one file a sub-assembly, 10 to 50 components each; measurements belong in `runs/`"
        return None, [_whole(path, "too-large", "larger than 2 MB", hint)]
    if data.startswith(_OTHER_BOMS):
        return None, [_whole(path, "encoding", "not UTF-8 but UTF-16 or UTF-32", "save it as UTF-8")]
    found: list[Diagnostic] = []
    if data.startswith(_UTF8_BOM):
        data = data[len(_UTF8_BOM) :]
        where = Source(path, "").range(0)
        hint = "save it as UTF-8 without BOM; `pico fmt` takes it out"
        found.append(warning("encoding", f"{path}: begins with a byte order mark", hint=hint, source=where))
    try:
        source = Source(path, data.decode("utf-8"))
    except UnicodeDecodeError as exc:
        source = Source(path, data.decode("utf-8", errors="replace"))
        index = len(data[: exc.start].decode("utf-8"))
        what = "binary data" if b"\0" in data else f"the byte 0x{data[exc.start]:02x} is not UTF-8"
        return None, [*found, error("encoding", what, hint="save it as UTF-8 text", source=source.range(index))]
    if not source.content.strip():
        return None, [*found, _whole(path, "empty", "the file is empty", _BEGIN)]
    odd = _NOT_TEXT.search(source.content)
    if odd:
        what = "binary data" if odd[0] == "\0" else f"the control character U+{ord(odd[0]):04X}"
        hint = "manifests are text: remove it"
        return None, [*found, error("encoding", f"{what} in a manifest", hint=hint, source=source.range(odd.start()))]
    return source, found


def decode_all(files: Mapping[str, bytes]) -> tuple[list[Source], list[Diagnostic]]:
    """Return the texts of several files, by sorted path, and what is wrong with them."""
    sources: list[Source] = []
    found: list[Diagnostic] = []
    for path in sorted(files):
        source, wrong = decode(path, files[path])
        found.extend(wrong)
        if source:
            sources.append(source)
    return sources, found
