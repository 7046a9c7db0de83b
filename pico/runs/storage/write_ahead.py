"""The write-ahead log of a journal: whether a part of it is damaged that SQLite would pass over in silence.

SQLite reads the log up to the first frame whose checksum does not match, and takes the rest for what a power failure
cut off. A journal makes each record durable before the next, or the one after that, so that a failure can leave one
transaction behind a frame that is not whole; more than that were on the disk. Format: https://www.sqlite.org/fileformat2.html#walformat.
"""

from __future__ import annotations

import struct
import time
from contextlib import suppress
from pathlib import Path

from pico.base.plain_files import read_file

LITTLE, BIG = 0x377F0682, 0x377F0683
HEADER, FRAME = 32, 24
CUT_OFF = 1
"""So many transactions behind a damaged frame may be what a power failure left."""
PAUSE = 0.05
"""Seconds after which a log is read again that another process may write at this moment."""


def lost_transactions(journal: Path) -> int:
    """Return how many transactions in the log beside a journal SQLite would pass over though they were durable."""
    path = journal.with_name(f"{journal.name}-wal")
    with suppress(OSError):
        if path.stat().st_size < HEADER + FRAME:
            return 0
        if found := _behind(read_file(path)):
            time.sleep(PAUSE)
            return found[1] if _behind(read_file(path))[:1] == found[:1] else 0
    return 0


def _behind(data: bytes) -> tuple[tuple[int, bytes], int] | tuple[()]:
    """Return where the log is damaged (the frame, and the salts of its header) and how many transactions lie behind
    that; empty if it is not damaged, or may have been cut off."""
    magic, _, size = struct.unpack_from(">III", data)
    if size not in (512 << n for n in range(8)):
        size = 4096
    order = ">" if magic == BIG else "<"
    sums, sound = _sums(order, data[:24], (0, 0)), magic in (LITTLE, BIG)
    sound = sound and struct.unpack_from(">II", data, 24) == sums
    salts = data[16:24] if sound else data[HEADER + 8 : HEADER + 16]
    damaged, behind = (None if sound else 0), 0
    for number, at in enumerate(range(HEADER, len(data) - FRAME - size + 1, FRAME + size)):
        if data[at + 8 : at + 16] != salts:  # of an earlier turn of the log, or damaged
            if damaged is None:
                damaged = number
            continue
        if damaged is None:
            sums = _sums(order, data[at : at + 8] + data[at + FRAME : at + FRAME + size], sums)
            if struct.unpack_from(">II", data, at + 16) != sums:
                damaged = number
        elif data[at + 4 : at + 8] != b"\0\0\0\0":  # the last frame of a transaction
            behind += 1
    return ((damaged, data[16:24]), behind) if damaged is not None and behind > CUT_OFF else ()


def _sums(order: str, data: bytes, before: tuple[int, int]) -> tuple[int, int]:
    one, other = before
    words = struct.unpack(f"{order}{len(data) // 4}I", data)
    for first, second in zip(words[::2], words[1::2], strict=True):
        one = (one + first + other) & 0xFFFFFFFF
        other = (other + second + one) & 0xFFFFFFFF
    return one, other
