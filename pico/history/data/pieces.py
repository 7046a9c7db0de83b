"""Large files on their way, piece by piece, and who is told of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import BinaryIO

from pico.content.store import CHUNK

Heard = Callable[[int], None]
"""Is told how many more bytes are through."""


def pieces(file: BinaryIO, heard: Heard) -> Iterator[bytes]:
    """Yield what is in a file, and tell how many bytes were taken."""
    while piece := file.read(CHUNK):
        yield piece
        heard(len(piece))
