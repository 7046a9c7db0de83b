"""Whether a driver ever takes a damaged reply for another number.

    python benchmarks/wire_replies.py --seed 1 --replies 500
    python benchmarks/wire_replies.py --seed 1 --replies 60 --only scpi.meter --plant float

Each driver asks its emulator over the wire, and one reply is replaced: a quarter are valid ones (of another value, in
another form that the grammar allows), half are one edit of a byte away from a valid one, a quarter are something else
(an infinity, an error, the reply of another device, half a reply, noise). What came over the wire is read by the
grammar of the vendor's manual, in `wire_grammars.py`, which shares nothing with the drivers. A driver is right if it
gives that value, or says that it is unknown and why; a valid reply must be taken. It is wrong with another number, with
an error that is no diagnostic, and if it does not read a clean reply afterwards.

The arm and its gripper speak binary frames (`wire_xarm.py`). Basler and RealSense have no wire to edit: stand-ins for
the vendors' libraries give damaged results (`wire_cameras.py`). Prints a line for each driver, then the wrong ones.
Exit code 1: something was wrong. `--plant`: a fault put into the drivers (`wire_plants.py`), which has to be found
(exit code 1). `--plants` tries every planted fault on each driver that it is in, and fails if one is not found.
"""

from __future__ import annotations

import argparse
import asyncio
import random
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from wire_cases import CASES, UNKNOWN, Case
from wire_grammars import Allowed
from wire_plants import PLANTS

from pico.diagnostics import PicoError
from pico.drivers.registry import Buses
from pico.emulators import serving
from pico.emulators.behind import Alone
from pico.emulators.registry import emulator
from pico.model.wiring import DeviceEntry

NOISE = b"0123456789+-.,:;?@ EeAOPNF\r\n\t\"'{}[]_xX\x00\x7f\x80\xff"


@dataclass
class Forger:
    """Stands around the conversations of an emulator, and replaces a reply while `forge` is set."""

    question: Callable[[bytes], bool]
    forge: Callable[[bytes], bytes] | None = None
    sent: list[tuple[bytes, bytes]] = field(default_factory=list)
    last: bytes = b""
    """The last true reply to the question."""

    def passed(self, asked: bytes, said: bytes) -> bytes:
        """Return what is sent in place of the true reply to a request."""
        if not said or not self.question(asked):
            return said
        self.last = said
        if self.forge is None:
            return said
        forge, self.forge = self.forge, None
        self.sent.append((said, forge(said)))
        return self.sent[-1][1]

    def around(self, made: Any) -> Any:
        """Return a conversation whose replies are passed through."""
        forger = self

        class Around:
            def heard(self, data: bytes) -> bytes:
                return forger.passed(data, made.heard(data))

            def due(self) -> bytes:
                found: bytes = made.due()
                return found

        return Around()


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
    if kind > 1 and case.odd is not None:
        return case.odd(reply, draw)
    if kind == 0 or not case.others:
        return bytes(draw.choice(NOISE) for _ in range(draw.randrange(1, 12))) + b"\n"
    if kind == 1:
        return reply[: draw.randrange(len(reply))]
    return draw.choice(case.others)


def same(found: Any, value: Any) -> bool:
    """Return whether a driver gave a value, to what rounding does."""
    if isinstance(value, np.ndarray):
        return (
            isinstance(found, np.ndarray)
            and found.dtype == value.dtype
            and np.array_equal(found, value, equal_nan=value.dtype.kind == "f")
        )
    if isinstance(value, tuple):
        return isinstance(found, tuple) and len(found) == len(value) and all(map(same, found, value))
    if isinstance(value, bool | str) or isinstance(found, bool | str):
        return type(found) is type(value) and found == value
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
    forger = Forger(case.question)
    if case.wire is not None:
        with case.wire(case, forger) as (entry, own):
            yield entry, own, forger
        return
    behind = Alone(case.at_first)
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


def main() -> int:
    """Run, print, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--replies", type=int, default=500)
    parser.add_argument("--only", nargs="*", default=list(CASES))
    parser.add_argument("--plant", choices=list(PLANTS))
    parser.add_argument("--plants", action="store_true", help="whether each planted fault is found")
    wanted = parser.parse_args()
    if wanted.plants:
        return _found(wanted)
    if wanted.plant:
        PLANTS[wanted.plant].put()
    print(f"seed {wanted.seed}, {wanted.replies} replies a driver")
    every = []
    for name in wanted.only:
        counts, wrong = asyncio.run(fuzzed(name, CASES[name], wanted.replies, random.Random(f"{wanted.seed} {name}")))
        every += wrong
        print(f"{name:22} {len(wrong)} wrong; " + ", ".join(f"{k} {n}" for k, n in sorted(counts.items())), flush=True)
    for one in every[:40]:
        print(one)
    return 1 if every else 0


def _found(wanted: argparse.Namespace) -> int:
    """Return 1 if a planted fault is not found in one of its drivers."""
    missed = 0
    for plant, name in ((plant, name) for plant, one in PLANTS.items() for name in one.drivers):
        words = ["--seed", wanted.seed, "--replies", wanted.replies, "--plant", plant, "--only", name]
        done = subprocess.run([sys.executable, __file__, *map(str, words)], capture_output=True, check=False)
        found = done.returncode == 1 and b" wrong; " in done.stdout and b" 0 wrong; " not in done.stdout
        missed += not found
        print(f"{plant} in {name}: {'found' if found else 'NOT found'}", flush=True)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
