"""One kind of file below `.pico`: what it is, and the one way in which it is read, written and called damaged.

A file is JSON with its own checksum in front: `{"sha256": "...",` and then the document. So a flipped bit or a lost
piece is noticed before anything is made of the document. Files without a checksum are of an earlier PICO and are read
as they are. All that is written is written whole or not at all.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import re
import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeVar

from pico.base.formats import Format
from pico.base.plain_files import aside_of, open_lock, other_than_file, read_file, set_aside
from pico.diagnostics import Diagnostic, PicoError, error
from pico.disk import unwritable, write_whole, writing
from pico.version import NEWER, upgrade_hint

T = TypeVar("T")
ASIDE = "`mv {path} {aside}`"
"""Puts what is damaged where nothing reads it, under a name that is free; nothing is deleted."""
Kind = Literal["cache", "process", "memory", "record", "safety"]
"""`cache`: made anew by itself. `process`: counts only while a process lives. `memory`: what the next look at the bench
finds again. `record`: gone for good if it is deleted. `safety`: never read as empty; nothing moves until a person
decides."""
_CHECKED = re.compile(rb'\{"sha256": ?"([0-9a-f]{64})"(?:, ?|(?=\}))')
_MARK = b'{"sha256":'
"""How a file with a checksum begins; with one byte changed, it is damaged and not of an earlier PICO."""
_WRONG = (KeyError, TypeError, ValueError, AttributeError, RecursionError, OverflowError)
"""What a document raises that is not what its reader expects."""


@dataclass(frozen=True)
class StateFile:
    """One kind of file, by the pattern of its path."""

    pattern: str
    """Its path below `.pico`, or below Git's own folder if it begins with `.git/`; BENCH, LASER and other words in
    capitals stand for names, `**` for all that is below a folder."""
    kind: Kind
    holds: str
    """What it is for."""
    writer: str
    """Who writes it: a command, or a part of PICO."""
    lost: str
    """What is lost if it is deleted; empty if nothing is."""
    remedy: str
    """What a person does about a damaged one: commands, with {path} for its path; empty if PICO mends it itself."""
    format: Format | None = None
    """The format that its `schema` names; None for a file that names none: its first version counts."""
    code: str = "state-file"
    """The code of what is said of a damaged one."""
    text: str = ""
    """What it is if it is not JSON: `SQLite, version 4`, `text`, `empty`."""

    keeps_newer: bool = False
    """Whether a command of this PICO must not replace a file of a newer one."""

    @property
    def name(self) -> str:
        """The last part of its path."""
        return self.pattern.rpartition("/")[2]

    @property
    def schema(self) -> str:
        """What a document of it says that it is: format and version."""
        return self.format.schema if self.format else ""

    @property
    def is_expendable(self) -> bool:
        """Whether it may be deleted at any time without loss."""
        return self.kind in ("cache", "process")

    def path(self, folder: Path) -> Path:
        """Return its path in the folder of its bench, or of the lab."""
        return folder / self.name

    # reading

    def read(self, path: Path, make: Callable[[dict[str, Any]], T]) -> T | None:
        """Return what `make` makes of the document at `path`, None if there is no file.

        `make` may raise KeyError, TypeError, ValueError or AttributeError for a document that is none of its kind.
        Raises PicoError for a file that can't be read or is damaged; of a file that is expendable, or only a memory,
        None is returned instead.
        """
        try:
            return self.made(path, read_file(path), make)
        except FileNotFoundError:
            return None
        except OSError as exc:
            wrong = PicoError(self.unreadable(path, exc.strerror or str(exc)))
        except PicoError as exc:
            wrong = exc
        if self.kind in ("safety", "record"):
            raise wrong
        return None

    def made(self, path: Path, data: bytes, make: Callable[[dict[str, Any]], T]) -> T:
        """Return what `make`, see `read`, makes of the bytes of the file at `path`. Raises PicoError if it is damaged,
        whatever its kind."""
        try:
            return make(self.parse(data))
        except _WRONG as exc:
            raise PicoError(self.damaged(path, _cause(exc))) from exc

    def parse(self, data: bytes) -> dict[str, Any]:
        """Return the document that the bytes of a file hold, in the current version of its format. Raises ValueError,
        RecursionError."""
        if checked := _CHECKED.match(data):
            if hashlib.sha256(data[checked.end() :]).hexdigest().encode() != checked[1]:
                raise ValueError("its checksum does not match what it holds")
            document = json.loads(b"{" + data[checked.end() :])
        elif sum(one == other for one, other in zip(data, _MARK, strict=False)) >= len(_MARK) - 1:
            raise ValueError("the line with its checksum is damaged")
        else:
            if not data.strip():
                raise ValueError("the file is empty")
            document = json.loads(data)
        if isinstance(document, dict):
            document.pop("sha256", None)  # an earlier PICO rewrote the file and carried it along
        return self.lifted(document)

    def lifted(self, document: object) -> dict[str, Any]:
        """Return a document of any version up to the current one as the current one has it. Raises ValueError."""
        if self.format:
            return self.format.lifted(document)
        if not isinstance(document, dict):
            raise ValueError(f"it holds {type(document).__name__} where an object is expected")
        return document

    def wrong(self, path: Path, make: Callable[[dict[str, Any]], object] = dict) -> Diagnostic | None:
        """Return what is wrong with the file at `path`, None if nothing is or there is none; for whoever checks all."""
        try:
            self.made(path, read_file(path), make)
        except FileNotFoundError:
            return None
        except OSError as exc:
            return self.unreadable(path, exc.strerror or str(exc))
        except PicoError as exc:
            return exc.diagnostics[0]
        return None

    # writing

    def dump(self, document: Mapping[str, Any], indent: int | None = None) -> bytes:
        """Return the bytes of a file that holds a document, with its schema and checksum."""
        named = {"schema": self.format.schema, **document} if self.format else document
        separators = (",", ":") if indent is None else None
        text = json.dumps(named, indent=indent, separators=separators, sort_keys=indent is None)
        rest = text.encode()[1:] + b"\n"
        mark = b'{"sha256": "%s"' % hashlib.sha256(rest).hexdigest().encode()
        return mark + (b"" if rest.startswith(b"}") else b", ") + rest

    def write(
        self, path: Path, document: Mapping[str, Any], *, indent: int | None = None, durable: bool = True,
        what: str = "",
    ) -> None:  # fmt: skip
        """Write a document, whole or not at all. `durable`: on the disk when this returns; `what`: what is said if it
        can't be written. Raises PicoError."""
        self.put(path, self.dump(document, indent), durable=durable, what=what)

    def put(self, path: Path, data: bytes, *, durable: bool = True, what: str = "") -> None:
        """Write the bytes of a file as `write` does. What lies there and is no file is moved aside. Raises
        PicoError."""
        code = self.code if self.code != "state-file" else "unwritable"
        with writing(path, what=what, code=code):
            set_aside(path)
        write_whole(path, data, what=what, code=code, folders=True, durable=durable)

    def lock(self, path: Path) -> int:
        """Open the file of a kernel lock, made with its folder if it is missing. Raises PicoError, also for what is no
        file."""
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            return open_lock(path)
        except OSError as exc:
            raise PicoError(self.unusable(path, exc)) from exc

    # what is said

    def damaged(self, path: Path, cause: str) -> Diagnostic:
        """Return that the file at `path` is damaged: why, what is lost with it, and what to do."""
        way = self.way_on(path)
        code, hint = self.code, way
        if "of a newer PICO" in cause:
            code = NEWER if self.keeps_newer else code
            hint = upgrade_hint() if self.keeps_newer else f"{upgrade_hint()}; otherwise {way}"
        return error(code, f"{path} cannot be read: {cause}", detail=self._detail, hint=hint)

    def unusable(self, path: Path, exc: OSError) -> Diagnostic:
        """Return what keeps the file at `path` from being opened: something else in its place, permissions, or the
        disk."""
        if exc.errno in (errno.EINVAL, errno.EACCES, errno.EPERM):
            return self.unreadable(path, exc.strerror or str(exc))
        return unwritable(path, exc, code=self.code)

    def unreadable(self, path: Path, cause: str) -> Diagnostic:
        """Return that the disk or its permissions withhold the file at `path`, or that something else is in its
        place."""
        return error(
            self.code, f"{path} cannot be read: {cause.lower()}", detail=self._detail, hint=self._opening(path)
        )

    def _opening(self, path: Path) -> str:
        """Return the command after which a file at `path` can be opened, and what to do then."""
        if other_than_file(path) or path.is_symlink():
            if ASIDE in self.remedy:
                return self.way_on(path)
            after = self.way_on(path) if self.remedy and "`rm " not in self.remedy else "PICO makes it anew"
            return f"{ASIDE.format(path=quoted(path), aside=quoted(aside_of(path)))}; then {after}"
        try:
            own = path.lstat().st_uid == os.geteuid()
        except OSError:
            if obstacle := next((p for p in path.parents if os.path.lexists(p) and not p.is_dir()), None):
                aside = ASIDE.format(path=quoted(obstacle), aside=quoted(aside_of(obstacle)))
                return f"{aside}: it stands where PICO keeps a folder; then call the command again"
            return f"let this user enter its folder (`ls -ld {quoted(path.parent)}`), then call the command again"
        way = f"chmod u+rw {quoted(path)}" if own else f'sudo chown "$USER" {quoted(path)}'
        return f"let this user read and write it: `{way}`; then call the command again"

    @property
    def _detail(self) -> str:
        if self.is_expendable or not self.lost:
            return f"it holds {self.holds}; nothing is lost with it"
        return f"it holds {self.holds}; lost with it: {self.lost}"

    def way_on(self, path: Path) -> str:
        """Return what to do about a damaged file at `path`."""
        return (
            self.remedy.format(path=quoted(path), aside=quoted(aside_of(path)), stem=path.stem)
            or f"`rm {quoted(path)}`; PICO makes it anew when it is needed"
        )


def quoted(path: Path) -> str:
    """Return a path as a shell takes it."""
    return shlex.quote(str(path))


def _cause(exc: Exception) -> str:
    if isinstance(exc, KeyError):
        return f"no {exc}"
    if isinstance(exc, UnicodeDecodeError):
        return "it is not text"
    text = str(exc).partition("): ")[0] + ")" if str(exc).startswith("of a newer") else str(exc)
    if text.startswith(("no pico.", "of a newer")):
        return f"it is {text}"
    return (text.splitlines() or [type(exc).__name__])[0][:120]
