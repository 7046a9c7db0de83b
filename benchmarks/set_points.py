"""How evenly set-points reach an arm while the process that wants it to move computes beside.

    python benchmarks/set_points.py --threads 0 4 --seconds 10 --inline

An emulated control box in a process of its own notes when each set-point comes; they are due every 4 ms. Beside the
motion, `--threads` Python threads of the driver's own process compute without a pause. Printed is the time between two
set-points: mean, 95 of 100, the longest. `--inline` also sends them from a thread of that process, in the same run.
The exit code is 1 where a set-point was refused, or an arm did not come to the end of its path.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from pico.diagnostics import PicoError  # noqa: E402
from pico.drivers.bus import Bus  # noqa: E402
from pico.drivers.xarm.arm import DRIVER, XArm  # noqa: E402
from pico.drivers.xarm.path import checked  # noqa: E402
from pico.drivers.xarm.streaming import PERIOD, Stream  # noqa: E402
from pico.emulators.xarm.server import XArmEmulator  # noqa: E402
from pico.model.wiring import DeviceEntry  # noqa: E402

HOME = (0.0, -0.5, 0.0, 0.5, 0.0, 1.0, 0.0)
SERIAL = "XI130500000000"


def box() -> None:
    """Serve an emulated control box; each line read is answered by when its set-points came since the last one [s]."""
    emulator = XArmEmulator(joints=HOME, serial=SERIAL)
    times: list[float] = []
    follow = emulator.box.follow

    def noted(target: Any) -> None:
        times.append(time.monotonic())
        follow(target)

    emulator.box.follow = noted  # type: ignore[method-assign]
    emulator.start()
    print(json.dumps(dict(emulator.address)), flush=True)
    for _ in sys.stdin:
        with emulator.lock:
            said = {"times": times[:], "error": emulator.box.error}
            times.clear()
        print(json.dumps(said), flush=True)
    emulator.close()


class Box:
    """The control box in its process."""

    def __init__(self) -> None:
        words = [sys.executable, "-c", "import set_points; set_points.box()"]
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(words, stdin=pipe, stdout=pipe, text=True, cwd=ROOT / "benchmarks", bufsize=1)
        assert self._process.stdout is not None
        self.address = json.loads(self._process.stdout.readline())

    def ask(self) -> tuple[np.ndarray, int]:
        """Return when set-points came since the last question [s], and the fault of the box."""
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.write("\n")
        said = json.loads(self._process.stdout.readline())
        return np.array(said["times"]), said["error"]

    def close(self) -> None:
        """End it."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait(10)


@contextmanager
def busy(count: int) -> Iterator[None]:
    """Have so many threads compute without a pause, in Python."""
    going = True

    def compute() -> None:
        total = 0
        while going:
            total = (total * 31 + 7) % 1_000_003

    threads = [threading.Thread(target=compute, daemon=True) for _ in range(count)]
    for thread in threads:
        thread.start()
    try:
        yield
    finally:
        going = False
        for thread in threads:
            thread.join()


def path(start: Sequence[float], by: float, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    share = np.linspace(0.0, 1.0, 100)
    joints = np.tile(start, (100, 1))
    joints[:, 0] += by * (3 * share**2 - 2 * share**3)
    return seconds * share, joints


async def inline(arm: XArm, times: np.ndarray, joints: np.ndarray) -> None:
    """Follow a path by set-points from a thread of this process."""
    link = arm._link
    assert link is not None
    stream = Stream("arm1", link, checked("arm1", times, joints, arm.settings), doing="", pace=1.0, set_points=True)
    stream.start()
    await asyncio.wrap_future(stream.done)


async def measured(arm: XArm, control: Box, threads: int, seconds: float, own: bool) -> bool:
    start = (await arm.state()).joints
    control.ask()
    how = inline if own else lambda arm, times, joints: arm.follow(times, joints)
    with busy(threads):
        try:
            await how(arm, *path(start, 0.6 if start[0] < 0.3 else -0.6, seconds))
            failed = ""
        except (PicoError, ConnectionError) as exc:
            failed = f"; failed: {exc}"
    times, fault = control.ask()
    gaps = 1000 * np.diff(times)
    where = "this process" if own else "a process of their own"
    print(f"{threads} busy threads, sent by {where}: {len(times)} set-points, due every {1000 * PERIOD:g} ms{failed}")
    print(f"  {gaps.mean():.1f} ms mean, {np.percentile(gaps, 95):.1f} ms p95, {gaps.max():.1f} ms at most between two")
    return not (failed or fault)


async def run(threads: Sequence[int], seconds: float, peer: bool) -> int:
    control = Box()
    entry = DeviceEntry(driver="xarm.arm", address=control.address, identity={"serial": SERIAL})
    bus: Bus[Any] = Bus(lambda: DRIVER.opened(entry), DRIVER.closed, DRIVER.alive)
    arm = XArm("arm1", entry, bus)
    good = True
    try:
        await arm.connect()
        for count in threads:
            for own in (False, True) if peer else (False,):
                await arm.recover(by_person=True)  # an inline motion may have failed
                good &= await measured(arm, control, count, seconds, own) or own
        return 0 if good else 1
    finally:
        await arm.close()
        control.close()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--threads", type=int, nargs="+", default=[0, 4], help="how many compute beside")
    parser.add_argument("--seconds", type=float, default=10.0, help="how long each path takes")
    parser.add_argument("--inline", action="store_true", help="also send them from a thread of this process")
    asked = parser.parse_args()
    sys.exit(asyncio.run(run(asked.threads, asked.seconds, asked.inline)))


if __name__ == "__main__":
    main()
