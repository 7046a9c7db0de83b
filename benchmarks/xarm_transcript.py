"""The emulated xArm7 against the vendor's firmware, frame by frame: the same requests to both, and what differs.

    python benchmarks/xarm_transcript.py --docker            # starts the vendor's image, where Docker and it are
    python benchmarks/xarm_transcript.py --firmware HOST     # a control box, real or simulated, that runs already
    python benchmarks/xarm_transcript.py                     # the emulator's half alone

Nothing is enabled and nothing moves: what is sent asks, or sets what is lost at the next restart; with a real arm at
the other end its settings are to be made again. The image is the vendor's (its article on the Studio in Docker names
it), is started as an xArm7, and never fetched from here. Where it can't be run, that the comparison was not done is
said.
"""

from __future__ import annotations

import argparse
import math
import shutil
import socket
import struct
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from pico.emulators.xarm.server import XArmEmulator

IMAGE = "danielwang123321/uf-ubuntu-docker"
START = "/xarm_scripts/xarm_start.sh 7 7; sleep infinity"
REPORTS = {30001: 145, 30002: 587, 30003: 135}


@dataclass(frozen=True)
class Asked:
    """One request; `same`: how much of two answers must agree: all of them, or their length and status."""

    what: str
    register: int
    payload: bytes = b""
    same: str = "all"


def packed(*values: float) -> bytes:
    return struct.pack(f"<{len(values)}f", *values)


RANGE = packed(*[v for _ in range(7) for v in (-1.0, 1.0)])
SCRIPT = (
    Asked("version", 1, same="length"),
    Asked("serial numbers", 2, same="length"),
    Asked("state", 13, same="length"),
    Asked("commands in the queue", 14),
    Asked("error and warning", 15),
    Asked("clear the error", 16),
    Asked("clear the warning", 17),
    Asked("stop", 12, b"\x04"),
    Asked("state after a stop", 13),
    Asked("tool offset", 35, packed(0, 0, 172, 0, 0, 0)),
    Asked("load", 36, packed(0.8, 0, 0, 60)),
    Asked("collision sensitivity", 37, b"\x04"),
    Asked("collision sensitivity that there is not", 37, b"\x09"),
    Asked("gravity direction", 51, packed(0, 0, -1)),
    Asked("boundary", 52, struct.pack("<6i", 800, -800, 800, -800, 1200, -100)),
    Asked("tool speed", 47, packed(250.0)),
    Asked("joint speed", 48, packed(1.0)),
    Asked("joint range", 58, RANGE),
    Asked("rebound", 60, b"\x00"),
    Asked("self-collision", 77, b"\x01"),
    Asked("tool model", 78, b"\x01"),
    Asked("reduced mode", 50, b"\x00"),
    Asked("limits", 53),
    Asked("pose", 41, same="length"),
    Asked("joints", 42, same="length"),
    Asked("forward kinematics", 44, packed(0.3, -0.4, 0.1, 0.8, -0.2, 1.1, 0.5), same="pose"),
    Asked("joints beyond their limits", 45, packed(0, 0, 0, 9, 0, 0, 0)),
    Asked("set-point in the wrong mode", 29, packed(*[0.0] * 10)),
    Asked("velocity in the wrong mode", 81, packed(*[0.0] * 7) + b"\x01" + packed(0.1)),
    Asked("a register that there is not", 99),
)


def said(host: str, port: int) -> list[bytes]:
    """What a control box answers to the script, one answer a request; b'' where none came."""
    found = []
    with socket.create_connection((host, port), timeout=5.0) as box:
        for number, asked in enumerate(SCRIPT, 1):
            body = bytes([asked.register]) + asked.payload
            box.sendall(struct.pack(">HHH", number, 2, len(body)) + body)
            found.append(answer(box, number))
    return found


def answer(box: socket.socket, number: int) -> bytes:
    try:
        while True:
            head = exactly(box, 6)
            transaction, _, length = struct.unpack(">HHH", head)
            body = exactly(box, length)
            if transaction == number and body[0] != 0xFF:
                return head + body
    except (TimeoutError, ConnectionError):
        return b""


def exactly(box: socket.socket, count: int) -> bytes:
    data = b""
    while len(data) < count:
        more = box.recv(count - len(data))
        if not more:
            raise ConnectionError
        data += more
    return data


def report_sizes(host: str) -> dict[int, int]:
    """How long the first report on each port says that it is."""
    found = {}
    for port in REPORTS:
        with socket.create_connection((host, port), timeout=5.0) as box:
            found[port] = struct.unpack(">I", exactly(box, 4))[0]
    return found


def agree(asked: Asked, ours: bytes, theirs: bytes) -> bool:
    if asked.same == "all" or not theirs:
        return ours == theirs
    if len(ours) != len(theirs) or ours[:8] != theirs[:8]:
        return False
    if asked.same == "pose":
        a, b = struct.unpack("<6f", ours[8:]), struct.unpack("<6f", theirs[8:])
        turns = [abs(math.remainder(x - y, 2 * math.pi)) for x, y in zip(a[3:], b[3:], strict=True)]
        return max(*(abs(x - y) for x, y in zip(a[:3], b[:3], strict=True)), *turns) < 0.5
    return True


@contextmanager
def vendors_firmware() -> Iterator[tuple[str, int]]:
    """The vendor's image, started and ended."""
    run = ["docker", "run", "--pull", "never", "-d", "--rm", "--entrypoint", "/bin/bash", IMAGE, "-c", START]
    name = subprocess.run(run, check=True, capture_output=True, text=True).stdout.strip()
    try:
        where = ["docker", "inspect", "-f", "{{range .NetworkSettings.Networks}}{{.IPAddress}}{{end}}", name]
        host = subprocess.run(where, check=True, capture_output=True, text=True).stdout.strip()
        for _ in range(120):
            try:
                socket.create_connection((host, 502), timeout=1.0).close()
                break
            except OSError:
                time.sleep(1.0)
        yield host, 502
    finally:
        subprocess.run(["docker", "kill", name], check=False, capture_output=True)


def without_docker() -> str:
    """Why the vendor's image can't be run here; '' where it can."""
    if not shutil.which("docker") or subprocess.run(["docker", "info"], check=False, capture_output=True).returncode:
        return "no Docker here"
    seen = subprocess.run(["docker", "image", "inspect", IMAGE], check=False, capture_output=True)
    return f"the vendor's image is not here (docker pull {IMAGE})" if seen.returncode else ""


def compare(ours: list[bytes], our_sizes: dict[int, int], host: str, port: int) -> None:
    theirs, sizes = said(host, port), report_sizes(host)
    differing = [
        (asked, a, b) for asked, a, b in zip(SCRIPT, ours, theirs, strict=True) if not agree(asked, a, b)
    ]  # fmt: skip
    for asked, a, b in differing:
        print(f"differs: {asked.what} (register {asked.register})\n  emulator {a.hex(' ')}\n  firmware {b.hex(' ')}")
    for at in REPORTS:
        if sizes[at] != our_sizes[at]:
            print(f"differs: length of reports on {at}: emulator {our_sizes[at]}, firmware {sizes[at]}")
    print(f"{len(SCRIPT) - len(differing)} of {len(SCRIPT)} answers alike")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--firmware", metavar="HOST[:PORT]", help="a control box that runs already")
    parser.add_argument("--docker", action="store_true", help="start the vendor's image as the control box")
    asked = parser.parse_args()
    emulator = XArmEmulator(joints=(0.0, -0.5, 0.0, 0.5, 0.0, 1.0, 0.0))
    emulator.start()
    try:
        ours = said(str(emulator.address["host"]), int(emulator.address["port"]))
        sizes = report_sizes(str(emulator.address["host"]))
    finally:
        emulator.close()
    print(f"emulator: {len(ours)} requests, {sum(map(bool, ours))} answers; reports of {sizes} bytes")
    if asked.firmware:
        host, _, port = asked.firmware.partition(":")
        compare(ours, sizes, host, int(port or 502))
    elif asked.docker and not (why := without_docker()):
        with vendors_firmware() as (host, at):
            compare(ours, sizes, host, at)
    else:
        why = why if asked.docker else "not asked for (--docker, or --firmware HOST)"
        print(f"comparison with the vendor's firmware: not done: {why}")


if __name__ == "__main__":
    main()
