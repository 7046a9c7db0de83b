"""Manifest files: which of a folder count, and their bytes as text. Nothing of a file is trusted."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Container, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from shlex import quote

from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.manifest.file_names import (
    MAX_BYTES,
    about,
    declares_api,
    hidden,
    is_manifest,
    misnamed_manifest,
    named_as_manifest,
    set_aside,
    set_aside_from,
)
from pico.manifest.links import head_of, manifest_behind, small_state
from pico.manifest.text.source import Source

MAX_LEVELS = 64
"""Folders in folders."""
_STATE_ONLY = re.compile(rb"\A(?!.*^kind:\s*(?:Lab|ComponentType)\s*$).*^kind:\s*LabState", re.MULTILINE | re.DOTALL)
_NOT_TEXT = re.compile(r"[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]")
_UTF8_BOM = b"\xef\xbb\xbf"
_WIDE = ("not UTF-8 but UTF-16 or UTF-32", "save it as UTF-8")
_NO_TEXT = {
    b"\xff\xfe": _WIDE,
    b"\xfe\xff": _WIDE,
    b"\x00\x00\xfe\xff": _WIDE,
    b"version https://git-lfs.github.com/spec/": ("a pointer of Git LFS, not the file", "fetch it: `git lfs pull`"),
    b"\0GITCRYPT\0": ("encrypted by git-crypt", "decrypt it: `git-crypt unlock`"),
}
"""How files begin that hold no text to read, what they are, and what to do."""


def begin_or_restore(path: str) -> str:
    """Return what to do about a file at `path`, as it is shown, in which nothing is written."""
    begin = "begin it with `apiVersion: pico/v1`, or delete it"
    if ":" in path or path.startswith("the bench's own "):  # of a revision, or of the Lab that a bench keeps
        return begin
    return f"if a commit has it, `git restore {quote(path)}` brings it back; else {begin}"


def shown_path(path: Path) -> str:
    """Return a path as diagnostics show it: relative to the current directory where it lies below."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except (ValueError, OSError):
        return str(path)


def states_alone(data: bytes) -> bool:
    """Return whether a manifest holds states alone, nothing of the bench."""
    return _STATE_ONLY.search(data) is not None


def bench_files(files: Mapping[str, bytes], top: str = "") -> dict[str, bytes]:
    """Return the files that describe the bench, all that may hold more than states, by path below `top`."""
    kept = {path: data for path, data in files.items() if not states_alone(data)}
    return {os.path.relpath(path, top): data for path, data in sorted(kept.items())} if top else kept


def read_folder(root: Path) -> tuple[dict[str, bytes], list[Diagnostic]]:
    """Return every `*.yaml` below `root` by shown path, and what can't be read or is not: a part may stand in it.

    Left out: dot-files, dot-folders and folders called `runs`. Symbolic links are refused, not followed.
    """
    files: dict[str, bytes] = {}
    found: list[Diagnostic] = []
    top = Path(shown_path(root))
    for entry in _walk(root, found):
        path = Path(entry.path)
        shown = str(top / path.relative_to(root))
        try:
            if is_manifest(entry.name):
                files[shown] = _read(path, shown)
            else:
                found.extend(_passed_over(entry, shown, root))
        except PicoError as exc:
            found.extend(exc.diagnostics)
    return files, found


def _walk(root: Path, found: list[Diagnostic]) -> Iterator[os.DirEntry[str]]:
    """Yield what may be a manifest, or have some behind it, by folder and name."""
    below = [root]
    while below:
        folder = below.pop()
        if len(folder.parts) - len(root.parts) >= MAX_LEVELS:
            at = _below(root, folder)
            found.append(about(at, "too-deep", f"folders nested deeper than {MAX_LEVELS}", "no lab needs that"))
            return
        try:
            listed = sorted(os.scandir(folder), key=lambda entry: entry.name)
        except OSError as exc:
            found.append(shut(_below(root, folder), exc))
            continue
        folders = {e: Path(e.path) for e in reversed(listed) if e.is_dir(follow_symlinks=False)}
        below += [path for entry, path in folders.items() if not hidden(entry.name)]
        names = {entry.name for entry in listed}
        yield from (entry for entry in listed if entry not in folders and _counts(entry, names))


def _counts(entry: os.DirEntry[str], beside: Container[str]) -> bool:
    """Return whether a file or link may be a manifest, or one that is set aside and no copy of what is read."""
    if not hidden(entry.name) and (named_as_manifest(entry.name) or entry.is_symlink()):
        return True
    was = set_aside_from(entry.name)
    return bool(was) and was not in beside


def _passed_over(entry: os.DirEntry[str], shown: str, root: Path) -> list[Diagnostic]:
    """Return what to say of a link, or of a file that is not called as manifests are."""
    if set_aside_from(entry.name) and (hidden(entry.name) or not entry.is_symlink()):
        with suppress(OSError):
            return set_aside(shown, small_state(Path(entry.path)))
        return []
    try:
        if entry.is_symlink():
            target = Path(entry.path).readlink()
            found = manifest_behind(Path(entry.path).parent / target, root, shown, str(target))
            return [found] if found else []
        return [misnamed_manifest(shown)] if declares_api(head_of(Path(entry.path))) else []
    except OSError as exc:
        return [shut(shown, exc)]


def shut(shown: str, exc: OSError) -> Diagnostic:
    """Return what to say of a file or folder that can't be read."""
    hint = "check that it exists and that you may read it; what is none of PICO's may lie in a folder with a dot"
    return about(shown, "unreadable", f"can't be read: {exc.strerror}", hint)


def _below(root: Path, path: Path) -> str:
    return str(Path(shown_path(root)) / path.relative_to(root))


def _read(path: Path, shown: str) -> bytes:
    try:
        mode = path.lstat().st_mode
        if stat.S_ISLNK(mode):
            raise PicoError(about(shown, "symlink", "a symbolic link is not read", "put the file itself here"))
        if not stat.S_ISREG(mode):
            raise PicoError(about(shown, "not-a-file", "not a regular file", "put a text file here, or rename it"))
        with path.open("rb") as file:
            return file.read(MAX_BYTES + 1)
    except OSError as exc:
        raise PicoError(shut(shown, exc)) from exc


def decode(path: str, data: bytes) -> tuple[Source | None, list[Diagnostic]]:
    """Return the text of a manifest, or why it is none: empty, too large, binary, another encoding."""
    if len(data) > MAX_BYTES:
        hint = "one file a sub-assembly, 10 to 50 components each; measurements belong in `runs/`"
        return None, [about(path, "too-large", "larger than 2 MB", hint)]
    for start, (summary, hint) in _NO_TEXT.items():
        if data.startswith(start):
            return None, [about(path, "encoding", summary, hint)]
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
        return None, [*found, about(path, "empty", "the file is empty", begin_or_restore(path))]
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
