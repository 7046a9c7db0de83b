"""What replies mean by the manuals of the instruments, read byte by byte; written apart from the drivers.

Each function takes what came over the wire, the reply that the device had sent, and the value behind it, and returns
what a driver may say of it.
"""

from __future__ import annotations

import json
import math
import random
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Allowed:
    """What a driver may say: the `value` if it is not None, and that it is `unknown`, if so."""

    value: Any = None
    unknown: bool = True


NOTHING = Allowed()
DIGITS = "0123456789"


def _line(sent: bytes, end: bytes = b"\n") -> str | None:
    """Return the only line of a reply, after which at most blanks follow; None if there is none, or more than one."""
    line, found, more = sent.partition(end)
    if not found or b"\n" in line or more.strip(b" \t\r\n"):
        return None
    return line.decode("latin-1")


def _scanned(text: str) -> float | None:
    """Return the <NRf> number of IEEE 488.2, 7.7.2, that a text is: mantissa, then an exponent if any."""
    at, digits = 0, ""
    if at < len(text) and text[at] in "+-":
        at += 1
    sign = -1.0 if text.startswith("-") else 1.0
    whole = at
    while at < len(text) and text[at] in DIGITS:
        digits, at = digits + text[at], at + 1
    shift = 0
    if at < len(text) and text[at] == ".":
        at += 1
        start = at
        while at < len(text) and text[at] in DIGITS:
            digits, at = digits + text[at], at + 1
        shift = at - start
    if not digits or at == whole:
        return None
    exponent = 0
    if at < len(text) and text[at] in "eE":
        at += 1
        minus = at < len(text) and text[at] == "-"
        at += at < len(text) and text[at] in "+-"
        start, power = at, ""
        while at < len(text) and text[at] in DIGITS:
            power, at = power + text[at], at + 1
        if at == start or len(power) > 4:
            return None
        exponent = -int(power) if minus else int(power)
    if at != len(text):
        return None
    try:
        return sign * float(f"{int(digits)}e{exponent - shift}")
    except (OverflowError, ValueError):
        return math.inf


def scpi_number(sent: bytes, _: bytes, __: Any) -> Allowed:
    """A number and a line feed. SCPI-99, volume 1, 7.2.1.4: 9.9E37 is infinity, 9.91E37 no number."""
    line = _line(sent)
    found = None if line is None else _scanned(line.strip(" \t\r"))
    if found is None or abs(found) > 1e30:
        return NOTHING
    # a number and a separator or blank in front of it may be refused: no instrument sends that
    return Allowed(found, unknown=sent not in (f"{line}\n".encode("latin-1"), f"{line}\r\n".encode("latin-1")))


def other_number(reply: bytes, draw: random.Random) -> bytes:
    """Another form of the same number, or the number itself."""
    value = float(reply)
    forms = [f"{value:.9E}", f"{value:+.6e}", f"{value:.12f}", f"{value:g}", f"{value!r}"]
    return draw.choice(forms).encode() + draw.choice([b"\n", b"\r\n"])


def scpi_choice(names: Mapping[str, str]) -> Callable[[bytes, bytes, Any], Allowed]:
    """The number of a position as <NRf>, IEEE 488.2, 7.7.2; `names` of them by their numbers."""

    def says(sent: bytes, true: bytes, _: Any) -> Allowed:
        line = _line(sent)
        found = None if line is None else _scanned(line.strip(" \t\r"))
        name = next((name for code, name in names.items() if found == int(code)), None)
        return NOTHING if name is None else Allowed(name, unknown=sent != true)

    return says


def other_choice(reply: bytes, draw: random.Random) -> bytes:
    """Another form of the same number."""
    code = int(reply)
    return draw.choice([f"{code}", f"+{code}", f"{code}.0", f"{code}E+0", f"{code / 10:.1f}E1"]).encode() + draw.choice(
        [b"\n", b"\r\n"]
    )


def scpi_switch(sent: bytes, _: bytes, __: Any) -> Allowed:
    """<Boolean> as it is answered: 1 or 0; some say ON or OFF."""
    line = _line(sent)
    word = "" if line is None else line.strip(" \t\r").upper()
    if word in ("1", "ON", "0", "OFF"):
        return Allowed(word in ("1", "ON"), unknown=line != word)
    number = _scanned(word)  # <NRf> is a number that is rounded, where it is a parameter
    return Allowed(bool(round(number))) if number is not None and abs(number) < 2 else NOTHING


def other_switch(reply: bytes, draw: random.Random) -> bytes:
    """Another form of the same."""
    on = reply.strip() == b"1"
    return draw.choice([b"1\n", b"ON\n", b"1\r\n"] if on else [b"0\n", b"OFF\n", b"0\r\n"])


def _counted(sent: bytes, true: bytes) -> bool | None:
    """Return the state in `state,count`, whose count is above that of every answer before."""
    line = _line(sent)
    state, comma, count = (line or "").strip(" \t\r").partition(",")
    state = state.strip(" \t\r")  # IEEE 488.2, 7.4.1.2: white space, CR included, may stand around a separator
    newest = int(true.strip().split(b",")[1])
    if not comma or state not in ("0", "1") or not count or any(c not in DIGITS for c in count):
        return None
    return state == "1" if int(count) >= newest else None


def contact(sent: bytes, true: bytes, _: Any) -> Allowed:
    """A contact that lets current flow is safe. What is not known is not safe: a driver may say either."""
    found = _counted(sent, true)
    if found is None:
        return Allowed(False)
    return Allowed(found, unknown=sent != true)


def contact_of_shut(sent: bytes, true: bytes, _: Any) -> Allowed:
    """The sensor of a shutter, closed if that is shut."""
    found = _counted(sent, true)
    return NOTHING if found is None else Allowed(not found, unknown=sent != true)


def switch(sent: bytes, true: bytes, _: Any) -> Allowed:
    """`number state`: the number of the question, then 1, 0 or ?."""
    line, number = _line(sent), true.split()[0].decode()
    words = (line or "").strip(" \t\r").split(" ")
    if len(words) != 2 or words[0] != number or words[1] not in ("0", "1"):
        return NOTHING
    return Allowed(words[1] == "1", unknown=line != f"{words[0]} {words[1]}")


def switch_of_input(sent: bytes, true: bytes, value: Any) -> Allowed:
    """The same of a safety input: what is not known is not safe."""
    found = switch(sent, true, value)
    return Allowed(False) if found == NOTHING else found


def elliptec(per: float) -> Callable[[bytes, bytes, Any], Allowed]:
    """`<address>PO<8 hexadecimal digits>` and CR LF: pulses in two's complement. `per`: deg or mm of one."""

    def says(sent: bytes, true: bytes, _: Any) -> Allowed:
        if len(sent) != 13 or sent[:3] != true[:3] or sent[11:] != b"\r\n":
            return NOTHING
        value = 0
        for byte in sent[3:11]:
            place = b"0123456789ABCDEF".find(bytes([byte]).upper())
            if place < 0:
                return NOTHING
            value = 16 * value + place
        value -= (1 << 32) if value >> 31 else 0
        return Allowed(value * per, unknown=sent != true)

    return says


def slider(names: Mapping[str, str], travel: int) -> Callable[[bytes, bytes, Any], Allowed]:
    """The same of a slider, in mm: its positions are evenly spread over its `travel` [mm], and it may read up to 2 mm
    beside one. `names` of them by their numbers."""
    places = {name: (int(number) - 1) * travel / (len(names) - 1) for number, name in names.items()}

    def says(sent: bytes, true: bytes, value: Any) -> Allowed:
        found = elliptec(1.0)(sent, true, value)
        name = next((n for n, at in places.items() if found.value is not None and abs(found.value - at) <= 2), None)
        return NOTHING if name is None else Allowed(name, unknown=sent != true)

    return says


def other_slider(reply: bytes, draw: random.Random) -> bytes:
    """The same, up to 2 mm beside."""
    at = int(reply[3:11], 16) + draw.choice([0, 1, 2, -1, -2])
    return reply[:3] + f"{at & 0xFFFFFFFF:08X}".encode() + reply[11:]


def zaber(counts: float) -> Callable[[bytes, bytes, Any], Allowed]:
    """`@device axis id flag status warning data`, `:` and the checksum: with the sum of all between `@` and `:` its low
    byte is 0. Zaber's ASCII Protocol Manual, "Message checksum". `counts` of a mm."""

    def says(sent: bytes, true: bytes, _: Any) -> Allowed:
        line = _line(sent)
        if line is None or not line.startswith("@"):
            return NOTHING
        line = line.rstrip(" \r")  # a blank at its end, or a line feed alone, may pass
        body, colon, checksum = line[1:].partition(":")
        if colon and (
            len(checksum) not in (1, 2)
            or any(c not in "0123456789ABCDEFabcdef" for c in checksum)
            or (sum(body.encode("latin-1")) + int(checksum, 16)) % 256
        ):
            return NOTHING
        words, mine = body.split(" "), true[1:].partition(b":")[0].decode().split(" ")
        if len(words) != len(mine) or words[:3] != mine[:3] or words[3] != "OK" or words[5] != "--":
            return NOTHING
        data = words[6]
        if not data.lstrip("-") or any(c not in DIGITS for c in data.removeprefix("-")):
            return NOTHING
        return Allowed(int(data) / counts, unknown=sent != true)

    return says


def other_zaber(reply: bytes, draw: random.Random) -> bytes:
    """The same while it moves."""
    body = reply[1:].partition(b":")[0].replace(b" IDLE ", draw.choice([b" IDLE ", b" BUSY "]))
    return b"@" + body + b":%02X\r\n" % (-sum(body) % 256)


def frame(sent: bytes, true: bytes, value: Any) -> Allowed:
    """A line of JSON, then the pixels. What is a frame otherwise than it was sent is none."""
    head, _, data = sent.partition(b"\n")
    try:
        said = json.loads(head)
        mine = json.loads(true.partition(b"\n")[0])
        good = said["id"] == mine["id"] and said["bytes"] == len(data) and said["crc32"] == zlib.crc32(data)
        if said["dtype"] not in ("uint8", "uint16"):
            return NOTHING
        pixels = np.frombuffer(data, said["dtype"]).reshape(said["shape"])
    except (ValueError, KeyError, TypeError, RecursionError):
        return NOTHING
    if not good or data != true.partition(b"\n")[2]:
        return NOTHING
    return Allowed(pixels, unknown=sent != true)
