"""Keys one by one from a terminal: when they go down, and where the terminal tells it, when they come up again.

Releases are told by the kitty keyboard protocol (sw.kovidgoyal.net/kitty/keyboard-protocol), which is asked for and
given back. Elsewhere a key that is held is pressed again and again.
"""

from __future__ import annotations

import os
import re
import select
import sys
import termios
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Literal

ASK, ALIVE = b"\x1b[?u\x1b[c", b"\x1b[5n"
"""What a terminal is asked: does it know the protocol, which is answered before what every terminal answers; and: is it
there?"""
BEGIN, END = b"\x1b[>15u\x1b[?1004h", b"\x1b[<u\x1b[?1004l"
"""Events of all keys, with what they would type, and of the focus; and none any more."""
PATIENCE = 0.5
"""Seconds that a terminal has to answer; over a slow link it counts as one that reports no releases."""
ALONE = 0.03
"""An escape after which nothing comes for so long is the key Esc [s]."""
_ARROWS = {"A": "up", "B": "down", "C": "right", "D": "left"}
_NUMBERED = {5: "pgup", 6: "pgdn"}
_CODES = {27: "esc", 9: "tab", 13: "enter"}
_BYTES = {b"\x1b": "esc", b"\x03": "ctrl-c", b"\t": "tab", b"\r": "enter", b"\n": "enter", b"\x04": "ctrl-d"}
_SEQUENCE = re.compile(rb"\x1b\[([<=>?]?)([0-9:;]*)([A-Za-z~])|\x1bO([A-D])")
_CTRL, _RELEASE, _REPEAT = 4, 3, 2
_LONGEST = 64
"""Bytes of the longest sequence that is waited for."""
_MODIFIERS = frozenset(range(57441, 57455))
"""Keys that are reported, too, and do nothing alone: shift, control and their like."""

Kind = Literal["press", "repeat", "release", "alive", "unfocused", "lost"]


@dataclass(frozen=True, slots=True)
class Key:
    """What happened: a key by name (`left`, `esc`, `ctrl-c`, `+`, ...); or, without one, the terminal says that it is
    there (`alive`), that the focus went elsewhere, or it is gone (`lost`)."""

    kind: Kind
    name: str = ""


class Keys:
    """The keys of the terminal that standard input is, while it is entered. `releases`: whether they are told;
    `answers`: whether it says that it is there."""

    def __init__(self) -> None:
        self._in = sys.stdin.fileno()
        self._out = -1
        self._before: list[Any] | None = None
        self._data = b""
        self._since = 0.0
        self.releases = self.answers = False

    def __enter__(self) -> Keys:
        self._out = os.open(os.ttyname(self._in), os.O_WRONLY | os.O_NOCTTY)
        self._before = termios.tcgetattr(self._in)
        try:
            raw = termios.tcgetattr(self._in)
            raw[3] &= ~(termios.ICANON | termios.ECHO | termios.ISIG | termios.IEXTEN)
            raw[0] &= ~(termios.IXON | termios.ICRNL)
            raw[6][termios.VMIN], raw[6][termios.VTIME] = 0, 0
            termios.tcsetattr(self._in, termios.TCSANOW, raw)
            self.releases = self._knows()
            if self.releases:
                self._write(BEGIN)
        except BaseException:
            self.restore()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, exc: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.restore()

    def restore(self) -> None:
        """Leave the terminal as it was; more than once does no harm."""
        if self._before is None:
            return
        before, self._before = self._before, None
        if self.releases:
            self._write(END)
        with suppress(termios.error):  # it is gone
            termios.tcsetattr(self._in, termios.TCSAFLUSH, before)  # what was typed ahead was meant for here
        os.close(self._out)

    def ask(self) -> None:
        """Ask the terminal whether it is there: it answers with `alive`."""
        self._write(ALIVE)

    def read(self, seconds: float) -> list[Key]:
        """Return what happened, waiting at most so long for anything."""
        if not self._arrived(seconds):
            return [Key("lost")]
        stale = time.monotonic() - self._since > ALONE
        found, self._data = decoded(self._data, stale)
        return found

    def _write(self, data: bytes) -> None:
        with suppress(OSError):  # reading says so
            os.write(self._out, data)

    def _arrived(self, seconds: float) -> bool:
        """Read what there is; return whether the terminal still is there."""
        try:
            if select.select([self._in], [], [], seconds)[0]:
                data = os.read(self._in, 4096)
                self._data, self._since = self._data + data, time.monotonic()
                return bool(data)
        except OSError:
            return False
        return True

    def _knows(self) -> bool:
        """Whether the terminal knows the protocol."""
        self._write(ASK)
        until = time.monotonic() + PATIENCE
        while (left := until - time.monotonic()) > 0 and self._arrived(left):
            if re.search(rb"\x1b\[\?[0-9;]*c", self._data):
                self.answers = True
                break
        found = re.search(rb"\x1b\[\?[0-9]*u", self._data) is not None
        self._data = re.sub(rb"\x1b\[\?[0-9;]*[uc]", b"", self._data)
        return found


def decoded(data: bytes, stale: bool) -> tuple[list[Key], bytes]:
    """Return what happened, as a terminal writes it, and what is left: the beginning of a sequence, of which more will
    come unless it is `stale`. What nobody here knows is left out."""
    found: list[Key] = []
    while data:
        sequence = _SEQUENCE.match(data)
        if sequence:
            data = data[sequence.end() :]
            found += _sequence(sequence)
        elif data[0] == 0x1B and not stale and len(data) < _LONGEST:
            break
        else:
            found += _plain(data[:1])
            data = data[1:]
    return found, data


def _plain(byte: bytes) -> Iterator[Key]:
    name = {b"\x1b": "esc", b"\x03": "ctrl-c", b"\t": "tab", b"\r": "enter", b"\n": "enter", b"\x04": "ctrl-d"}.get(
        byte
    )
    text = name or (byte.decode("ascii", "replace") if 0x20 <= byte[0] < 0x7F else "")
    if text:
        yield Key("press", text)


def _sequence(found: re.Match[bytes]) -> Iterator[Key]:
    mark, numbers, final = (found[n].decode() if found[n] else "" for n in (1, 2, 3))
    if found[4]:
        yield Key("press", _ARROWS[found[4].decode()])
    elif final == "n" and numbers == "0":
        yield Key("alive")
    elif final == "O" and not numbers:
        yield Key("unfocused")
    elif not mark and final in "ABCDu~":
        yield from _key(numbers, final)


def _key(numbers: str, final: str) -> Iterator[Key]:
    """Yield a key as the protocol tells it: `code:shifted ; modifiers:event ; text`."""
    fields = [[int(part) if part else 0 for part in field.split(":")] for field in (numbers or "1").split(";")]
    code, (modifiers, event) = fields[0], ([*fields[1], 1][:2] if len(fields) > 1 else [1, 1])
    kind: Kind = "release" if event == _RELEASE else "repeat" if event == _REPEAT else "press"
    if final in _ARROWS:
        yield Key(kind, _ARROWS[final])
    elif final == "~" and code[0] in _NUMBERED:
        yield Key(kind, _NUMBERED[code[0]])
    elif final == "u" and code[0] not in _MODIFIERS:
        typed = code[1] if len(code) > 1 and (modifiers - 1) & 1 and code[1] else code[0]
        name = _CODES.get(code[0]) or (chr(typed) if 0x20 <= typed < 0x7F else "")
        if name:
            yield Key(kind, f"ctrl-{name}" if (modifiers - 1) & _CTRL else name)
