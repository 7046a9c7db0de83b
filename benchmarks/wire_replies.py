"""Whether a driver ever takes a damaged reply for another number.

    python benchmarks/wire_replies.py --seed 1 --replies 500
    python benchmarks/wire_replies.py --seed 1 --replies 60 --only scpi.meter --plant float

Each driver asks its emulator over the wire, and one reply is replaced: a quarter are valid ones (of another value, in
another form that the grammar allows), half are one edit of a byte away from a valid one, a quarter are something else
(an infinity, an error, the reply of another device, half a reply, noise). What came over the wire is read by the
grammar of the vendor's manual, in `wire_grammars.py`, which shares nothing with the drivers. A driver is right if it
gives that value, or says that it is unknown and why; a valid reply must be taken. It is wrong with another number, with
an error that is no diagnostic, and if it does not read a clean reply afterwards.

Not covered: the arm and its gripper (binary frames of the vendor's library), Basler and RealSense (no wire to edit).
Prints a line for each driver, then the wrong ones. Exit code 1: something was wrong. `--plant`: a fault put into the
drivers, which has to be found (exit code 1).
"""

from __future__ import annotations

import argparse
import asyncio
import random
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import wire_grammars as grammar
from wire_grammars import Allowed

from pico.diagnostics import PicoError
from pico.drivers import judging
from pico.drivers.registry import Buses
from pico.emulators import serving
from pico.emulators.behind import Alone
from pico.emulators.registry import emulator
from pico.model.wiring import DeviceEntry

WHO = {"vendor": "Acme", "model": "M1", "serial": "S42", "firmware": "1.2"}
NOISE = b"0123456789+-.,:;?@ EeAOPNF\r\n\t\"'{}[]_xX\x00\x7f\x80\xff"
UNKNOWN = object()
"""What a driver says that does not know."""


@dataclass(frozen=True)
class Case:
    """A driver: its entry, what its emulator has at first, the `question` whose reply is replaced, how it is read, a
    new value for the world behind it, and what the grammar says of a reply (bytes, the true reply, the value)."""

    entry: DeviceEntry
    at_first: dict[str, Any]
    question: Callable[[bytes], bool]
    read: Callable[[Any], Any]
    draw: Callable[[random.Random], tuple[str, Any]]
    says: Callable[[bytes, bytes, Any], Allowed]
    forms: Callable[[bytes, random.Random], bytes] = lambda reply, _: reply
    """Another form of a valid reply that the grammar allows."""
    others: tuple[bytes, ...] = ()
    first: Callable[[Any], Any] | None = None
    """What is done once before it is read, such as homing."""


@dataclass
class Forger:
    """Stands around the conversations of an emulator, and replaces a reply while `forge` is set."""

    question: Callable[[bytes], bool]
    forge: Callable[[bytes], bytes] | None = None
    sent: list[tuple[bytes, bytes]] = field(default_factory=list)
    last: bytes = b""
    """The last true reply to the question."""

    def around(self, made: Any) -> Any:
        """Return a conversation whose replies are passed through."""
        forger = self

        class Around:
            def heard(self, data: bytes) -> bytes:
                said: bytes = made.heard(data)
                if said and forger.question(data):
                    forger.last = said
                if said and forger.forge is not None and forger.question(data):
                    forge, forger.forge = forger.forge, None
                    forged = forge(said)
                    forger.sent.append((said, forged))
                    return forged
                return said

            def due(self) -> bytes:
                found: bytes = made.due()
                return found

        return Around()


async def _number(found: Any) -> Any:
    value = getattr(found, "value", found)
    return UNKNOWN if value is None else value


async def _meter(meter: Any) -> Any:
    return await _number(await meter.power())


async def _axis(axis: Any) -> Any:
    return await _number(await axis.position())


async def _safety(one: Any) -> Any:
    found = (await one.read()).safe
    return UNKNOWN if found is None else found


def _power(draw: random.Random) -> tuple[str, Any]:
    return "power", draw.choice([0.0, -1e-9, 10 ** draw.uniform(-9, 0), draw.uniform(0, 1)])


def _truth(what: str) -> Callable[[random.Random], tuple[str, Any]]:
    return lambda draw: (what, draw.random() < 0.5)


def _frame(draw: random.Random) -> tuple[str, Any]:
    shape = draw.choice([(4, 6), (3, 2, 3), (1, 1)])
    size = int(np.prod(shape))
    kind = draw.choice([np.uint8, np.uint16])
    return "frame", np.array([draw.randrange(256) for _ in range(size)], kind).reshape(shape)


def _asks(word: bytes) -> Callable[[bytes], bool]:
    return lambda data: word in data


def _box(driver: str) -> DeviceEntry:
    return DeviceEntry(driver=driver, emulator="switches", address={"host": "", "port": 0, "name": "s1"})


def _visa(driver: str, stands_in: str, **address: int) -> DeviceEntry:
    return DeviceEntry(driver=driver, emulator=stands_in, address={"visa": "", **address}, identity=WHO)


def _elliptec(driver: str, model: str) -> DeviceEntry:
    address: dict[str, str | int] = {"port": "", "bus": "2"}
    return DeviceEntry(
        driver=driver, emulator="elliptec", address=address, identity={"serial": "11400517", "model": model}
    )


ODD = (b"9.9E37\n", b"-9.90000E+37\n", b"9.91E37\n", b"NAN\n", b"inf\n", b"OVLD\n", b"\n", b'-113,"Undefined header"\n')
BAD = (b"\n", b"what?\n", b"1", b"? 1\n", b"999 1\n", b"1 1 1\n")
CASES: dict[str, Case] = {
    "scpi.meter": Case(
        _visa("scpi.meter", "scpi.meter"), {}, _asks(b"MEAS:POW?"), _meter, _power, grammar.scpi_number,
        grammar.other_number, ODD),
    "pymeasure.pm100": Case(
        _visa("pymeasure.pm100", "scpi.meter"), {}, _asks(b"POW"), _meter, _power, grammar.scpi_number,
        grammar.other_number, ODD),
    "scpi.laser": Case(
        _visa("scpi.laser", "scpi.laser"), {}, _asks(b"OUTP?"), lambda one: one.emitting(), _truth("emission"),
        grammar.scpi_switch, grammar.other_switch, ODD),
    "scpi.safety": Case(
        _visa("scpi.safety", "scpi.contacts", channel=4), {}, _asks(b"INP?"), _safety, _truth("contact"),
        grammar.contact, others=(b"1\n", b"1,1\n", b"1,0\n", b",\n", *ODD)),
    "scpi.shutter": Case(
        _visa("scpi.shutter", "scpi.contacts", channel=3, relay=1), {}, _asks(b"INP?"), lambda one: one.is_open(),
        _truth("open"), grammar.contact_of_shut, others=(b"1\n", b"1,1\n", b"0,0\n", *ODD)),
    "switches.input": Case(_box("switches.input"), {}, _asks(b"read"), _safety, _truth("safe"),
                           grammar.switch_of_input,
                           others=BAD),
    "switches.shutter": Case(_box("switches.shutter"), {}, _asks(b"read"), lambda one: one.is_open(), _truth("open"),
                             grammar.switch, others=BAD),
    "switches.laser": Case(_box("switches.laser"), {}, _asks(b"read"), lambda one: one.emitting(), _truth("emission"),
                           grammar.switch, others=BAD),
    "elliptec.rotator": Case(
        _elliptec("elliptec.rotator", "ELL14"), {"angle": 0.0}, _asks(b"2gp"), _axis,
        lambda draw: ("angle", draw.uniform(0, 359)), grammar.elliptec(360.0 / 143360),
        others=(b"2GS09\r\n", b"2GS02\r\n", b"3PO00001000\r\n", b"2PO0000\r\n", b"\r\n", b"2PO"),
        first=lambda axis: axis.home()),
    "elliptec.stage": Case(
        _elliptec("elliptec.stage", "ELL20"), {"position": 0.0}, _asks(b"2gp"), _axis,
        lambda draw: ("position", draw.uniform(0, 59)), grammar.elliptec(1 / 1024.0),
        others=(b"2GS09\r\n", b"3PO00001000\r\n", b"2PO0000\r\n", b"2GJ00000400\r\n"),
        first=lambda axis: axis.home()),
    "zaber.stage": Case(
        DeviceEntry(driver="zaber.stage", emulator="zaber", address={"host": "", "port": "0", "device": 1},
                    identity={"serial": "12345"}, limits={"position": (0, 50)},
                    settings={"counts_per_unit": 20997.375, "emulated_speed": 1000.0}),
        {"position": 0.0, "homed": True}, _asks(b"get pos"), _axis,
        lambda draw: ("position", draw.uniform(0, 50)), grammar.zaber(20997.375), grammar.other_zaber,
        (b"@01 0 00 RJ IDLE -- BADCOMMAND\r\n", b"@02 1 00 OK IDLE -- 5\r\n", b"\r\n", b"!01 1 IDLE --\r\n")),
    "frames.camera": Case(
        DeviceEntry(driver="frames.camera", emulator="frames", address={"host": "", "port": 0},
                    identity={"serial": "7"}),
        {"frame": np.zeros((2, 2), np.uint8)}, _asks(b"grab"), lambda one: one.grab(), _frame, grammar.frame,
        others=(b"null\n", b"[]\n", b"{}\n", b"\n", b'{"id": 1e999}\n', b"{" * 5000 + b"\n")),
}  # fmt: skip


def edited(reply: bytes, draw: random.Random) -> bytes:
    """Return a reply with one byte replaced, put in, left out, or swapped with the next one."""
    at, byte = draw.randrange(len(reply)), bytes([draw.choice(NOISE)])
    kind = draw.randrange(4)
    if kind == 0:
        return reply[:at] + byte + reply[at + 1 :]
    if kind == 1:
        return reply[:at] + byte + reply[at:]
    if kind == 2:
        return reply[:at] + reply[at + 1 :]
    return reply[:at] + reply[at : at + 2][::-1] + reply[at + 2 :]


def other(reply: bytes, case: Case, draw: random.Random) -> bytes:
    """Return something else than a valid reply."""
    kind = draw.randrange(4)
    if kind == 0 or not case.others:
        return bytes(draw.choice(NOISE) for _ in range(draw.randrange(1, 12))) + b"\n"
    if kind == 1:
        return reply[: draw.randrange(len(reply))]
    return draw.choice(case.others)


def same(found: Any, value: Any) -> bool:
    """Return whether a driver gave a value, to what rounding does."""
    if isinstance(value, np.ndarray):
        return isinstance(found, np.ndarray) and found.dtype == value.dtype and np.array_equal(found, value)
    if isinstance(value, bool) or isinstance(found, bool):
        return found is value
    return value is not None and isinstance(found, int | float) and abs(found - value) <= 1e-9 * max(1.0, abs(value))


async def asked(one: Any, case: Case) -> Any:
    """Return what a driver reads, UNKNOWN if it says so, or the exception that is no diagnostic."""
    try:
        found = await case.read(one)
        return UNKNOWN if found is None else found
    except PicoError as exc:
        return UNKNOWN if exc.diagnostics and exc.diagnostics[0].summary else exc
    except Exception as exc:
        return exc


@contextmanager
def wire(case: Case) -> Iterator[tuple[DeviceEntry, Alone, Forger]]:
    """Yield the entry of an emulated device, what is behind it, and the forger on its wire."""
    behind, forger = Alone(case.at_first), Forger(case.question)
    served, line = serving.TcpServed.__init__, serving.SerialServed.__init__

    def of_tcp(self: Any, conversation: Any) -> None:
        served(self, lambda: forger.around(conversation()))

    def of_line(self: Any, conversation: Any) -> None:
        line(self, forger.around(conversation))

    serving.TcpServed.__init__, serving.SerialServed.__init__ = of_tcp, of_line  # type: ignore[method-assign]
    try:
        running = emulator(str(case.entry.emulator)).started({"it": (case.entry, behind)})
    finally:
        serving.TcpServed.__init__, serving.SerialServed.__init__ = served, line  # type: ignore[method-assign]
    try:
        address = {**case.entry.address, **running.address}
        yield DeviceEntry(
            driver=case.entry.driver, address=address, identity=case.entry.identity, limits=case.entry.limits,
            settings=case.entry.settings,
        ), behind, forger  # fmt: skip
    finally:
        running.close()


async def fuzzed(name: str, case: Case, replies: int, draw: random.Random) -> tuple[Counter[str], list[str]]:
    """Return how replies were taken, and what was wrong."""
    counts, wrong = Counter[str](), list[str]()
    with wire(case) as (entry, behind, forger):
        buses = Buses()
        one: Any = buses.opened("it", entry)
        await one.connect()
        if case.first:
            await case.first(one)
        for _ in range(replies):
            what, value = case.draw(draw)
            behind.write(what, value)
            kind = draw.choices(["valid", "edited", "other"], [1, 2, 1])[0]
            seed = draw.random()

            def forge(reply: bytes, kind: str = kind, seed: float = seed) -> bytes:
                mine = random.Random(seed)
                valid = case.forms(reply, mine)
                return valid if kind == "valid" else (edited if kind == "edited" else _other(case))(valid, mine)

            forger.forge, count = forge, len(forger.sent)
            found = await asked(one, case)
            forger.forge = None
            if len(forger.sent) == count:
                wrong.append(f"{name}: it did not ask")
                continue
            true, sent = forger.sent[-1]
            allowed = case.says(sent, true, value)
            counts[f"{kind}: {'unknown' if found is UNKNOWN else 'a value'}"] += 1
            if complaint := judged(found, allowed, kind):
                wrong.append(f"{name}: {kind} reply {sent[:80]!r} (true {true[:80]!r}) gave {complaint}")
            clean = await recovered(one, case)
            if not same(clean, case.says(forger.last, forger.last, value).value):
                wrong.append(f"{name}: after {sent[:80]!r} a clean reply {forger.last[:80]!r} gave {shown(clean)}")
        with suppress(PicoError):
            await buses.close()
    return counts, wrong


def _other(case: Case) -> Callable[[bytes, random.Random], bytes]:
    return lambda reply, draw: other(reply, case, draw)


def judged(found: Any, allowed: Allowed, kind: str) -> str:
    """Return what is wrong of an answer; empty for nothing."""
    if found is UNKNOWN:
        return "unknown, and is valid" if kind == "valid" and not allowed.unknown else ""
    if isinstance(found, BaseException):
        return f"{type(found).__name__}: {found}"
    if allowed.value is None or not same(found, allowed.value):
        return f"{shown(found)}, and means {'nothing' if allowed.value is None else shown(allowed.value)}"
    return ""


async def recovered(one: Any, case: Case) -> Any:
    """Return what clean replies give in the end: a driver may need to ask a few times."""
    for _ in range(4):
        found = await asked(one, case)
        if found is not UNKNOWN:
            break
    return found


def shown(value: Any) -> str:
    """Return a value for a person."""
    return "unknown" if value is UNKNOWN else repr(value)[:100]


def _loose_number(raw: str, unit: str, **_: Any) -> Any:
    from pico.model.instruments.readout import Readout, unknown

    try:
        return Readout(unit=unit, value=float(raw), raw=raw)
    except ValueError:
        return unknown(unit, "garbled", raw)


def planted(fault: str) -> None:
    """Put a fault into the drivers."""
    if fault == "float":  # takes what Python takes
        judging.number = _loose_number  # type: ignore[assignment]
    elif fault == "sentinel":  # over-range is a number
        judging._LEAST_SENTINEL = 1e99
    elif fault == "switch":  # whatever is not off is on
        judging.switched = lambda raw: raw.strip() not in ("0", "OFF")
    elif fault == "hex":  # takes as many digits as come
        judging.hexadecimal = lambda raw, digits, **_: int(raw, 16)
    elif fault == "picture":  # believes the header
        from pico.drivers import frames

        frames.zlib = type("zlib", (), {"crc32": staticmethod(lambda _: None)})  # type: ignore[assignment]


PLANTS = {"float": "scpi.meter", "sentinel": "scpi.meter", "switch": "scpi.laser", "hex": "elliptec.rotator"}


def main() -> int:
    """Run, print, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--replies", type=int, default=500)
    parser.add_argument("--only", nargs="*", default=list(CASES))
    parser.add_argument("--plant", choices=[*PLANTS, "picture"])
    wanted = parser.parse_args()
    if wanted.plant:
        planted(wanted.plant)
    print(f"seed {wanted.seed}, {wanted.replies} replies a driver")
    every = []
    for name in wanted.only:
        counts, wrong = asyncio.run(fuzzed(name, CASES[name], wanted.replies, random.Random(f"{wanted.seed} {name}")))
        every += wrong
        print(f"{name:18} {len(wrong)} wrong; " + ", ".join(f"{k} {n}" for k, n in sorted(counts.items())), flush=True)
    for one in every[:40]:
        print(one)
    return 1 if every else 0


if __name__ == "__main__":
    sys.exit(main())
