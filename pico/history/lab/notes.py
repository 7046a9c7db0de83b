"""What people say of a part: `notes/PART.md` in the lab's folder, one line each, so that appends merge (`union`)."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

from pico.diagnostics import PicoError, did_you_mean, error
from pico.manifest.file_names import MAX_BYTES
from pico.model.address import renaming_of
from pico.model.record import record
from pico.model.setup import Setup

FOLDER = "notes"
_LINE = re.compile(r"[-*] (\d{4}-\d{2}-\d{2}) ([^:]+): (.*)")


@record
class Note:
    """One note on a part: the day as YYYY-MM-DD, who wrote it, and what. Day and author are empty for a line that
    somebody wrote by hand in another form."""

    text: str
    day: str = ""
    author: str = ""


def require_part(setup: Setup, part: str) -> str:
    """Return the present name of a part, which may be named as it was before; raises PicoError for another word."""
    name = renaming_of(setup.lab).get(part, part)
    if name not in setup.lab.inventory:
        hint = did_you_mean(part, setup.lab.inventory)
        raise PicoError(error("unknown-component", f"the lab has no part `{part}`", hint=hint))
    return name


def note_path(part: str) -> str:
    """Return where the notes on a part are, relative to the lab."""
    return f"{FOLDER}/{part}.md"


def is_note(path: str) -> bool:
    """Return whether a path relative to the lab is that of notes."""
    found = PurePosixPath(path)
    return found.suffix == ".md" and found.parts[:-1] == (FOLDER,) and not found.name.startswith(".")


def notes(files: Mapping[str, bytes], *names: str) -> tuple[Note, ...]:
    """Return the notes on a part by its `names`, present and former ones, oldest first, from the files of a lab by path
    relative to it."""
    texts = (files.get(note_path(name), b"").decode("utf-8", errors="replace") for name in names)
    lines = (line.strip() for text in texts for line in text.splitlines())
    return tuple(sorted((_read(line) for line in lines if line and not line.startswith("#")), key=lambda n: n.day))


def read_note(root: Path, part: str) -> bytes:
    """Return the file of notes on a part of the lab in `root`, empty where there is none; a link is none, for what it
    points at is nobody's note. Raises PicoError where it can't be read."""
    path = root / note_path(part)
    if path.is_symlink() or path.parent.is_symlink() or not path.is_file():
        return b""
    with path.open("rb") as file:
        data = file.read(MAX_BYTES + 1)
    if len(data) > MAX_BYTES:
        raise PicoError(error("too-large", f"{path} is larger than 2 MB", hint="keep the last years of it"))
    return data


def with_note(before: bytes, day: str, author: str, text: str) -> bytes:
    """Return the notes on a part with one more at their end; raises PicoError for a text that is empty."""
    said = " ".join(text.split())
    if not said:
        raise PicoError(error("note", "the note is empty", hint='`pico note p2 "scratched at the rim"`'))
    who = " ".join(author.replace(":", " ").split()) or "somebody"
    missing = b"\n" if before and not before.endswith(b"\n") else b""
    return before + missing + f"- {day} {who}: {said}\n".encode()


def _read(line: str) -> Note:
    match = _LINE.fullmatch(line)
    return Note(text=match[3], day=match[1], author=match[2]) if match else Note(text=line.lstrip("-* "))
