"""What `damaged_state.py` does to a file."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from random import Random

PAGE = 4096
DELETED = "deleted"
EARLIER = 10**18
"""When a file was damaged [ns]: one that has just been made may be empty."""


def flip_bit(data: bytes, draw: Random) -> bytes:
    """Return the bytes with one bit flipped."""
    return _changed(data, draw.randrange(len(data)), 1 << draw.randrange(8))


def flip_byte(data: bytes, draw: Random) -> bytes:
    """Return the bytes with one byte changed."""
    return _changed(data, draw.randrange(len(data)), draw.randrange(1, 256))


def flip_content(data: bytes, draw: Random) -> bytes:
    """Return the bytes with one bit flipped in what is text: in a database, a value of a row and not free space."""
    places = [at for at, one in enumerate(data) if 0x20 <= one < 0x7F]
    return _changed(data, draw.choice(places), 1 << draw.randrange(7)) if places else data


def cut(data: bytes, draw: Random) -> bytes:
    """Return the beginning of the bytes."""
    return data[: draw.randrange(1, len(data))] if len(data) > 1 else b""


def empty(_: bytes, __: Random) -> bytes:
    """Return no bytes."""
    return b""


def zero_page(data: bytes, draw: Random) -> bytes:
    """Return the bytes with one page of a disk zeroed."""
    at = draw.randrange((len(data) + PAGE - 1) // PAGE) * PAGE
    return data[:at] + bytes(min(PAGE, len(data) - at)) + data[at + PAGE :]


def _changed(data: bytes, at: int, bits: int) -> bytes:
    return data[:at] + bytes([data[at] ^ bits]) + data[at + 1 :]


DAMAGES: dict[str, Callable[[bytes, Random], bytes]] = {
    "bit flipped": flip_bit, "byte changed": flip_byte, "bit of text flipped": flip_content, "cut off": cut,
    "emptied": empty, "page zeroed": zero_page,
}  # fmt: skip


def damage(path: Path, how: str, draw: Random) -> bool:
    """Damage a file; return whether that changed it."""
    before = path.read_bytes()
    if how == DELETED:
        path.unlink()
        return True
    if not before:
        return False
    after = DAMAGES[how](before, draw)
    was = path.stat()
    path.unlink()  # it may be linked to the file that labs are copied from
    path.write_bytes(after)
    path.chmod(was.st_mode)
    os.utime(path, ns=(was.st_atime_ns, EARLIER))
    return after != before
