"""Whether what is steered over a network stands still in time: `python benchmarks/network_teleop.py`.

`pico teleop` runs in a terminal of this program, on a bench that it reaches through a coordinator; a key is held until
something moves, then the client is frozen (SIGSTOP), or its line is cut, or loses what it says. Printed is how long
after the last set-point that the edge took something moved last, both by the edge's own clock, and how long after the
deed, which is what a person sees. Exit code 3 where something moved more than 200 ms after that set-point, 1 where it
moved on once the client or its line was back.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pico.places.bench import BenchPlace

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from network_bench import Network  # noqa: E402
from network_links import CLEAR  # noqa: E402
from teleop import QUIET, Record, Terminal, _watching, apart, centred, freed  # noqa: E402

HOW = ("client frozen", "line cut", "line loses what is said")
SPOILT = {"line cut": "cut", "line loses what is said": "deaf"}
KEYS = [b"D", b"C"]


def _noted(path: Path) -> None:
    """Have an edge of this process write down when it takes a set-point."""
    from pico.edge.teleoperating import Teleoperating

    file, hear = path.open("a"), Teleoperating.hear

    def noting(self: Teleoperating, frame: Any) -> Any:
        answer = hear(self, frame)
        if frame.press and not answer.refused:
            file.write(f"{time.monotonic():.6f}\n")
            file.flush()
        return answer

    Teleoperating.hear = noting  # type: ignore[method-assign]


class Steered(Network):
    """A network whose edge writes down when its world moves, and when it takes a set-point."""

    @property
    def moved(self) -> Record:
        return Record(self.folder / "moved.txt")

    @property
    def taken(self) -> Record:
        return Record(self.folder / "taken.txt")

    def work(self) -> Mapping[str, Callable[[], None]]:
        """What each process does."""

        def edge() -> None:
            from pico.edge.link.server import edge_of, serve
            from pico.edge.network.enrolment import read_enrolment
            from pico.edge.network.uplink import Uplink

            enrolment = read_enrolment(BenchPlace(self.beside, "sim"))
            assert enrolment is not None
            _noted(self.taken.path)
            found = edge_of(BenchPlace(self.beside, "sim"), "kinematic")
            _watching(found, self.moved.path)
            asyncio.run(serve(found, beside=Uplink(found, enrolment).run))

        return {**super().work(), "edge": edge}


def begun(network: Steered, terminal: Terminal | None) -> Terminal:
    """Return a terminal in which something is steered."""
    if terminal is None:
        terminal = Terminal(network.checkout, "p2.angle", "--step", "2 deg")
        terminal.until(lambda: b"| step" in terminal.said, "it does not begin")  # type: ignore[union-attr]
    return terminal


def stops(network: Steered, how: str, count: int, draw: random.Random) -> list[tuple[float, float]]:
    """Return how long after the last set-point, and after the deed, something moved last, each time [s]; raises
    RuntimeError where a held key does not move, or something moves on that stood."""
    found: list[tuple[float, float]] = []
    terminal: Terminal | None = None
    for number in range(count):
        terminal, key = begun(network, terminal), KEYS[number % 2]
        began = time.monotonic()
        terminal.send(b"\x1b[1;1:1" + key)
        terminal.until(lambda since=began: len(network.moved.after(since)) >= 5, "a held key does not move")  # type: ignore[misc]
        terminal.live(draw.uniform(0.0, 0.3))
        at = time.monotonic()
        if how == HOW[0]:
            os.kill(terminal.child, signal.SIGSTOP)
        else:
            network.spoil("line", SPOILT[how])
        time.sleep(QUIET)
        last = max(network.moved.after(began))
        found.append((last - network.taken.after(began)[-1], max(last - at, 0.0)))
        stood = time.monotonic()
        if how == HOW[0]:
            os.kill(terminal.child, signal.SIGCONT)
        else:
            network.weather["line"].now = CLEAR
        terminal.live(0.3)
        if network.moved.after(stood):
            raise RuntimeError(f"{how}: it moved on by itself")
        terminal.send(b"\x1b[1;1:3" + key)
        if not terminal.live(0.2) or how != HOW[0]:
            os.kill(terminal.child, signal.SIGKILL)
            terminal.gone()
            terminal = None
            apart(lambda: freed(network.checkout))
    if terminal is not None:
        os.kill(terminal.child, signal.SIGKILL)
        terminal.gone()
        apart(lambda: freed(network.checkout))
    return found


def told(how: str, found: list[tuple[float, float]]) -> int:
    """Tell of some stops, and return how many came late."""
    for what, times in zip(("the last set-point", "that"), zip(*found, strict=True), strict=True):
        ms = sorted(1000 * one for one in times)
        print(f"{how}: moved last {ms[len(ms) // 2]:.0f} ms after {what}, {ms[-1]:.0f} ms at most, of {len(ms)}")
    sys.stdout.flush()
    return sum(one > 0.2 for one, _ in found)


def main() -> int:
    """Measure."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frozen", type=int, default=50)
    parser.add_argument("--cut", type=int, default=50, help="half of them lose what the client says")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    draw, late = random.Random(given.seed), 0
    with tempfile.TemporaryDirectory() as temporary:
        network = Steered(Path(temporary), emulated=False, direct=True)
        network.start()
        try:
            if not network.ready():
                print("the edge did not come to the coordinator")
                return 1
            apart(lambda: centred(network.checkout))
            counts = (given.frozen, given.cut - given.cut // 2, given.cut // 2)
            for how, count in zip(HOW, counts, strict=True):
                late += told(how, stops(network, how, count, draw)) if count else 0
        finally:
            network.close()
    return 3 if late else 0


if __name__ == "__main__":
    sys.exit(main())
