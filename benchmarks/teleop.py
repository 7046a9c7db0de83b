"""Stops who steers, and steers at random: `python benchmarks/teleop.py --stops 50 --sessions 200`.

Stops: `pico teleop` runs in a terminal of this program, which speaks the kitty keyboard protocol, on a bench that
another process serves. A key is held until something moves, then let go, or the terminal is closed, the process killed
or stopped. Measured is when the world moved last, as the process that serves it wrote it down, by the same clock.
Sessions: random keys, nonsense, silence, interruptions and `kill -9`; then journal, what is on the table and what
`pico capture` writes must agree, and a hand that still holds the part is emptied by `pico recover`.
The exit code is 1 where a stop came later than 200 ms (plus braking for an arm on its way), or anything disagrees.
"""

from __future__ import annotations

import argparse
import asyncio
import math
import os
import pty
import random
import select
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from pico.places.bench import BenchPlace

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from kills import preload  # noqa: E402

PATIENCE = 30.0
"""So long a client may take to begin to move [s]."""
BRAKING = 0.2
"""What an arm takes to come to rest that is stopped on its way [s]."""
QUIET = 0.6
"""So long after a stop it is looked at what moved since [s]."""
HOW = ("key released", "terminal closed", "process killed", "process stopped")
REPLIES = {b"\x1b[?u": b"\x1b[?0u", b"\x1b[c": b"\x1b[?62;c", b"\x1b[5n": b"\x1b[0n"}


class Terminal:
    """A terminal with `pico teleop` in it, which speaks the kitty keyboard protocol."""

    def __init__(self, folder: Path, *words: str) -> None:
        self.child, self.link = pty.fork()
        if self.child == 0:
            code = 1
            try:
                os.chdir(folder)
                sys.stdin, sys.stdout, sys.stderr = os.fdopen(0, "r"), os.fdopen(1, "w"), os.fdopen(2, "w")
                from pico_cli.main import main

                code = main(["teleop", *words])
                sys.stdout.flush()
            except BaseException:
                traceback.print_exc()
            finally:
                os._exit(code)
        self.said, self._unread = b"", b""

    def live(self, seconds: float) -> bool:
        """Answer what is asked for a while; return whether anybody still is there."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            if not select.select([self.link], [], [], left)[0]:
                return True
            try:
                data = os.read(self.link, 65536)
            except OSError:
                return False
            if not data:
                return False
            self.said, self._unread = self.said + data, self._unread + data
            for asked, answer in REPLIES.items():
                for _ in range(self._unread.count(asked)):
                    self.send(answer)
                self._unread = self._unread.replace(asked, b"")
            self._unread = self._unread[-8:]
        return True

    def send(self, data: bytes) -> None:
        """Type something."""
        with suppress(OSError):
            os.write(self.link, data)

    def until(self, so: Callable[[], bool], what: str) -> None:
        """Answer until something is so; raises RuntimeError where it never is."""
        limit = time.monotonic() + PATIENCE
        while not so():
            if not self.live(0.01) or time.monotonic() > limit:
                raise RuntimeError(f"{what}: {self.said[-2000:].decode(errors='replace')}")

    def gone(self) -> None:
        """Wait for its process."""
        with suppress(OSError):
            os.close(self.link)
        with suppress(ChildProcessError):
            os.waitpid(self.child, 0)


class Record:
    """The record of motion: a line with the time for each moment at which the world was not as before."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def after(self, moment: float) -> list[float]:
        """Return the times after a moment at which something moved."""
        lines = self.path.read_text().split("\n")[:-1] if self.path.exists() else []
        return [t for line in lines if (t := float(line)) > moment]


def _watching(edge: Any, path: Path) -> None:
    """Have an edge write down when its world moves."""
    file, before, watch = path.open("a"), list[Any](), edge.device.watch

    def look(_: object) -> None:
        world = edge.device._session.world()
        now = [
            {n: (b.pose, b.values) for n, b in world.components.items()},
            {n: r.joints for n, r in world.robots.items()},
        ]
        if now != before:
            before[:] = now
            file.write(f"{time.monotonic():.6f}\n")
            file.flush()

    edge.device.watch = lambda _: watch(look)


@contextmanager
def recorded(folder: Path, record: Path) -> Iterator[None]:
    """Serve a bench meanwhile whose motion is recorded."""
    from pico.edge.link.server import edge_of, serve

    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.setsid()
            edge = edge_of(BenchPlace(folder, "sim"), "kinematic")
            _watching(edge, record)
            asyncio.run(serve(edge, lambda: os.write(writing, b"1") and None))
        finally:
            os._exit(0)
    os.read(reading, 1)
    try:
        yield
    finally:
        os.kill(child, signal.SIGTERM)
        os.waitpid(child, 0)


def stop(terminal: Terminal, how: str, key: bytes) -> float:
    """Stop who holds a key, and return when."""
    began = time.monotonic()
    if how == "key released":
        terminal.send(b"\x1b[1;1:3" + key)
    elif how == "terminal closed":
        os.close(terminal.link)
    else:
        os.kill(terminal.child, signal.SIGKILL if how == "process killed" else signal.SIGSTOP)
    return began


def stops(
    folder: Path, record: Record, words: tuple[str, ...], how: str, count: int, draw: random.Random
) -> list[float]:
    """Return how long after each stop the world moved last [s]; raises RuntimeError where a held key does not move."""
    found: list[float] = []
    terminal: Terminal | None = None
    key = [b"D", b"C"]
    while len(found) < count:
        if terminal is None:
            terminal = Terminal(folder, *words)
            terminal.until(lambda t=terminal: b"| step" in t.said, "it does not begin")  # type: ignore[misc]
        key.reverse()
        began = time.monotonic()
        terminal.send(b"\x1b[1;1:1" + key[0])
        terminal.until(lambda b=began: len(record.after(b)) >= 5, "a held key does not move")  # type: ignore[misc]
        terminal.live(draw.uniform(0.0, 0.3))
        at = stop(terminal, how, key[0])
        assert record.after(at - 0.4), "nothing moved just before"
        if how == "key released":
            terminal.live(QUIET)
        else:
            time.sleep(QUIET)
        if how == "process stopped":
            os.kill(terminal.child, signal.SIGCONT)
        found.append(max(record.after(at), default=at) - at)
        if how in ("terminal closed", "process killed"):
            terminal.gone()
            terminal = None
            apart(lambda: freed(folder))
        elif how == "process stopped":
            terminal.live(0.3)
            assert not [t for t in record.after(at) if t > at + QUIET], "it moved on by itself"
            terminal.send(b"\x1b[1;1:3" + key[0])
            terminal.live(0.2)
    if terminal is not None:
        terminal.send(b"\x1b[113u")
        while terminal.live(0.2):
            pass
        terminal.gone()
    return found


def taking(folder: Path, record: Record, how: str, count: int, draw: random.Random) -> list[float]:
    """Return how long after each stop an arm moved last that was on its way to take a part in hand [s]."""
    found: list[float] = []
    while len(found) < count:
        began = time.monotonic()
        terminal = Terminal(folder, "p2.pose", "--yes")
        terminal.until(lambda b=began: len(record.after(b)) >= 8, "the arm does not move")  # type: ignore[misc]
        terminal.live(draw.uniform(0.0, 0.5))
        at = stop(terminal, how, b"C")
        assert record.after(at - 0.4), "nothing moved just before"
        time.sleep(2 * QUIET)
        found.append(max(record.after(at), default=at) - at)
        if how == "process stopped":
            os.kill(terminal.child, signal.SIGKILL)
        terminal.gone()
        apart(lambda: freed(folder))
    return found


def apart(work: Callable[[], None]) -> None:
    """Do something in a process of its own: threads of this one would not survive a fork."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            work()
            code = 0
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(code)
    if os.waitpid(child, 0)[1]:
        raise RuntimeError("what was to be done apart failed")


def centred(folder: Path) -> None:
    """Bring what is steered to the middle of its range."""
    from pico.bench.bench import Bench

    with Bench.open(folder) as bench:
        bench.apply(bench.single("p2", "set", angle=180))


def freed(folder: Path) -> None:
    """End what a client left behind, and empty the hand."""
    from pico.bench.bench import Bench

    with Bench.open(folder) as bench:
        bench.wait(bench.edge.halt())
        until = time.monotonic() + PATIENCE
        while bench.wait(bench.edge.holder()) is not None and time.monotonic() < until:
            time.sleep(0.02)
        if any(robot.holding for robot in bench.observe().robots.values()):
            bench.apply(bench.recovery.recover_plan())


def measured_stops(given: argparse.Namespace, folder: Path) -> int:
    """Measure all kinds of stops; return how many were late."""
    late = 0
    record = Record(folder.parent / "motion.txt")
    draw = random.Random(given.seed)
    apart(lambda: centred(folder))
    with recorded(folder, record.path):
        for words, count in ((("p2.angle", "--step", "2 deg"), given.stops), (("p2.pose", "--yes"), given.arm)):
            for how in given.how:
                found = stops(folder, record, words, how, count, draw) if count else []
                said = f"{words[0]}: {how}"
                late += told(said, found, BRAKING if words[0] == "p2.pose" else 0.0)
        for how in [how for how in given.how if how != HOW[0]]:
            late += told(f"arm on its way to p2: {how}", taking(folder, record, how, given.arm, draw), BRAKING)
    return late


def told(what: str, found: list[float], braking: float) -> int:
    """Tell of some stops, and return how many came late."""
    if found:
        said = f"median {1000 * sorted(found)[len(found) // 2]:.0f} ms, max {1000 * max(found):.0f} ms"
        print(f"{what}: moved on for {said} after it, of {len(found)}", flush=True)
    return sum(t > 0.2 + braking for t in found)


# sessions


def acts(jog: Any, bench: Any, draw: random.Random) -> None:
    """Do what somebody may do, or something broken."""
    names = [*jog.known, "nonsense"]
    for _ in range(draw.randint(0, 25)):
        what = draw.choice(["step", "step", "step", "frame", "release", "silence", "halt", "stop", "error", "nonsense"])
        name = draw.choice(names)
        longest = jog.known[name].longest if name in jog.known else 1.0
        if what == "step" and name in jog.known:
            jog.step(name, draw.choice([-1, 1]) * draw.choice([0.01, 0.3, 1.0, 5.0]) * longest)
        elif what == "frame":
            jog.hear(tunable=name, by=draw.uniform(-1, 1) * longest, press=jog.press())
        elif what == "nonsense":
            by = draw.choice([math.nan, math.inf, -math.inf, 1e30, 0.0])
            jog.hear(tunable=name, by=by, press=draw.choice([-1, 0, 10**9]))
        elif what == "release":
            jog.hear(release=True)
        elif what == "silence":
            time.sleep(draw.uniform(0.0, 0.25))
        elif draw.random() < 0.15:
            if what == "halt":
                bench.wait(bench.edge.halt())
            elif what == "stop":
                bench.wait(bench.edge.stop())
            else:
                raise ZeroDivisionError


def session(folder: Path, seed: int) -> str:
    """Steer at random in a process of its own, which may be killed; return how that ended."""
    draw = random.Random(seed)
    target = draw.choice([("p2", None), ("p1", "angle"), ("ly_150", None), ("p2", "pose"), ("lx_100", "pose")])
    kill = draw.uniform(0.0, 2.0) if draw.random() < 0.4 else None
    child = os.fork()
    if child == 0:
        code = 1
        try:
            from pico.bench.bench import Bench
            from pico.diagnostics import PicoError

            with Bench.open(folder, fidelity="kinematic") as bench:
                jog = bench.teleop(*target)
                bench.edge.device.pace.factor = draw.choice([None, 5.0])  # type: ignore[attr-defined]
                with suppress(PicoError, ZeroDivisionError), jog:
                    acts(jog, bench, draw)
            code = 0
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(code)
    until = time.monotonic() + (PATIENCE if kill is None else kill)
    while os.waitpid(child, os.WNOHANG) == (0, 0):
        if time.monotonic() > until:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            return "killed" if kill is not None else "hung"
        time.sleep(0.005)
    return "ended"


def disagreements(folder: Path) -> list[str]:
    """Return what of journal, table and capture does not agree after a session."""
    from pico.bench.bench import Bench

    wrong: list[str] = []
    with Bench.open(folder, fidelity="kinematic") as bench:
        bench.recovery.settle()
        memory = bench.edge.memory
        if memory is None or not memory.runs():
            return []
        if memory.unsettled():
            wrong.append("operations are unsettled")
        if any(robot.holding for robot in bench.observe().robots.values()):
            plan = bench.recovery.recover_plan()
            report = bench.apply(plan)
            if report.outcome != "done" or any(r.holding for r in bench.observe().robots.values()):
                wrong.append(f"recover ended {report.outcome}")
        else:
            wrong += _journal(bench, memory)
        bench.capture()
        light = {op.id for op in bench.plan().operations if op.component == "laser"}  # a request, which nobody captures
        left = [op for op in bench.plan().operations if op.id not in light and op.reason.kind != "parked"]
        if left:
            wrong.append(f"after capture the plan still has {[op.primitive + ' ' + op.component for op in left]}")
    return wrong


def _journal(bench: Any, memory: Any) -> list[str]:
    """Return where the last teleoperation, as the journal has it, differs from the table."""
    last = memory.runs()[-1]
    records = [r for r in memory.records(run=last.run) if r.key.split("/")[0] == last.run]
    steered = [r for r in records if r.kind == "intent" and r.data["primitive"] == "teleoperate"]
    if not steered:
        return []
    wrong = [] if len(steered) == 1 else [f"{len(steered)} operations were begun"]
    own = [r for r in records if r.key == steered[0].key]
    if any(r.key.count("~") for r in records):
        wrong.append("steps are in the journal")
    ends = [r for r in own if r.kind in ("done", "failed", "resolved")]
    if any(r.kind == "started" for r in own) and len(ends) != 1:
        wrong.append(f"it has {len(ends)} ends")
    after = (ends[-1].data.get("after") or {}) if ends else {}
    part = bench.observe().components[steered[0].component]
    if after and after.get("presence") == "seen":
        pose = after.get("pose") or {}
        near = part.pose is not None and all(
            abs(getattr(part.pose, k) - pose.get(k, 1e9)) < 1e-6 for k in ("x", "y", "yaw")
        )
        if not near:
            wrong.append(f"the journal has {pose}, the table {part.pose}")
        for name, live in part.values.items():
            if live.value != (after.get("values", {}).get(name) or {}).get("value"):
                wrong.append(f"the journal has another {name} than the table")
    last_said = (ends[-1].data.get("data") or {}).get("last", {}) if ends else {}
    for address, value in last_said.items():
        name = address.partition(".")[2]
        live = part.values[name].value if name in part.values else getattr(part.pose, name)
        if abs(live - value) > 1e-6:
            wrong.append(f"{address} ended at {value}, and is {live}")
    return wrong


def sessions(given: argparse.Namespace, folder: Path) -> int:
    """Steer at random; return after how many sessions anything disagreed."""
    counts, bad = Counter[str](), 0
    for number in range(given.sessions):
        ended = session(folder, given.seed * 100_000 + number)
        try:
            wrong = disagreements(folder)
        except Exception as exc:
            wrong = [f"{type(exc).__name__}: {exc}"]
        wrong += ["it hung"] if ended == "hung" else []
        counts[ended] += 1
        bad += bool(wrong)
        if wrong:
            print(f"session {number} ({ended}): {'; '.join(wrong)}", flush=True)
    told = ", ".join(f"{n} {what}" for what, n in sorted(counts.items()))
    print(f"sessions: {told}; in {bad} of {given.sessions} journal, table and capture disagree", flush=True)
    return bad


def main() -> int:
    """Measure the stops, then steer at random."""
    from pico.history.examples.example import make_example

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stops", type=int, default=50, help="of each kind, of a motor")
    parser.add_argument("--arm", type=int, default=10, help="of each kind, with a part in hand")
    parser.add_argument("--how", choices=HOW, nargs="+", default=HOW, help="kinds of stops")
    parser.add_argument("--sessions", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    preload()
    bad = 0
    with tempfile.TemporaryDirectory() as temporary:
        if given.stops or given.arm:
            bad += measured_stops(given, make_example("shel", Path(temporary) / "stops" / "shel").root)
        if given.sessions:
            bad += sessions(given, make_example("shel", Path(temporary) / "sessions" / "shel").root)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
