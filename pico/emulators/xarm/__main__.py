"""`python -m pico.emulators.xarm`: an emulated arm as a process of its own, and its side channel.

It prints its address as one line of JSON; each line that it then reads is one fault (`fault 31`, `press 1`, `release`,
`freeze`, `thaw`, `kill`, `restart`, `drop`, `delay 0.3`, `duplicate`, `truncate`, `garbage`); at the end of its input
it ends.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Callable, Mapping

from pico.emulators.xarm.server import XArmEmulator

_POSTURE = (0.0, -35.0, 0.0, 40.0, 0.0, 75.0, 0.0)


def channel(emulator: XArmEmulator) -> Mapping[str, Callable[[float], object]]:
    """Return what the words of the side channel do; each takes one number."""
    wires = ("drop", "delay", "duplicate", "truncate", "garbage")
    return {
        "fault": lambda number: emulator.fault(int(number)),
        "press": lambda number: emulator.press(int(number) or 1),
        "release": lambda number: emulator.release(),
        "freeze": lambda number: emulator.freeze(),
        "thaw": lambda number: emulator.thaw(),
        "kill": lambda number: emulator.kill(),
        "restart": lambda number: emulator.restart(),
    } | {kind: lambda number, kind=kind: emulator.wire(kind, seconds=number) for kind in wires}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m pico.emulators.xarm", description="An emulated xArm7.")
    parser.add_argument("--serial", default="XI130500000000")
    parser.add_argument("--pace", type=float, default=1.0, help="how many times faster than real its clock runs")
    parser.add_argument("--joints", type=float, nargs=7, default=_POSTURE, metavar="DEG", help="where the arm stands")
    asked = parser.parse_args()
    served = XArmEmulator(joints=tuple(map(math.radians, asked.joints)), serial=asked.serial, pace=asked.pace)
    served.start()
    print(json.dumps(dict(served.address)), flush=True)
    words = channel(served)
    for line in sys.stdin:
        word, _, number = line.strip().partition(" ")
        if word in words:
            words[word](float(number or 0))
    served.close()
