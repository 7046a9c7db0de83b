"""The benches of `cross_bench.py`: a lab with a simulated, an emulated and a `hardware` bench, the latter wired to
emulators in a process of their own, and a remote bench behind a coordinator."""

from __future__ import annotations

import ctypes
import json
import os
import re
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

GIT = {f"GIT_{who}_{what}": said for who in ("AUTHOR", "COMMITTER") for what, said in
       (("NAME", "Ada"), ("EMAIL", "ada@example.org"))}  # fmt: skip
FAR = "plates/bench1"
"""The bench at the coordinator."""
PACE = "60"
"""How many times faster than real the emulated devices are."""

_HEAD = """\
apiVersion: pico/v1
kind: Lab
metadata: {name: plates, title: Two wave plates and a shutter}
"""
_PARTS = """\
inventory:
  h1: {type: half_wave_plate, pose: {x: 150, y: 200, yaw: 0}}
  h2: {type: half_wave_plate, pose: {x: 250, y: 200, yaw: 0}}
  gate: {type: shutter, pose: {x: 350, y: 200, yaw: 0}}
  meter: {type: power_meter, pose: {x: 500, y: 200, yaw: 180}}
"""
_PLAIN = f"""\
{_HEAD}table: {{size: [600, 400], beam_height: 70}}
robots: {{}}
slots: {{}}
cameras:
  top: {{position: [300, 200, 1500], look_at: [300, 200, 0], field_of_view: 30, pixels: [800, 600]}}
datums:
  front_left: {{marker: 990, x: 40, y: 40}}
  front_right: {{marker: 992, x: 560, y: 40}}
  back_left: {{marker: 993, x: 40, y: 360}}
{_PARTS}"""
_ARM = f"""\
{_HEAD}table: {{size: [1200, 900], beam_height: 70}}
slots:
  storage/a1: {{x: 380, y: 400}}
  storage/a2: {{x: 470, y: 400}}
robots:
  arm1:
    model: xarm7
    mount: {{x: 480, y: 760, yaw: -90}}
cameras:
  top: {{position: [480, 420, 1500], look_at: [480, 420, 0], field_of_view: 50, pixels: [1224, 1024]}}
datums:
  front_left: {{marker: 990, x: 80, y: 60}}
  front_right: {{marker: 992, x: 880, y: 60}}
  back_left: {{marker: 993, x: 80, y: 700}}
{_PARTS}  lens: {{type: plano_convex_100, marker: 1, home: storage/a2}}
"""
LABS = {"plain": _PLAIN, "arm": _ARM}
STATES = {"v1": (0, 0, (660, 380)), "v2": (10, 0, (660, 420)), "v3": (10, 25, (600, 420)), "v4": (40, 25, (660, 420))}
"""Angles of the plates [deg] and the place of the lens [mm] by tag, oldest first."""


def state(kind: str, h1: float, h2: float, lens: tuple[float, float]) -> str:
    """Return the manifest of a state."""
    x, y = lens
    arm = f"  lens:\n    pose: {{x: {x}, y: {y}, yaw: 0}}\n" if kind == "arm" else ""
    parts = f"  gate:\n    shutter: closed\n  h1:\n    angle: {h1:g}\n  h2:\n    angle: {h2:g}\n{arm}  meter: {{}}\n"
    return f"apiVersion: pico/v1\nkind: LabState\nmetadata: {{lab: plates}}\ncomponents:\n{parts}"


def devices(kind: str, at: Mapping[str, Mapping[str, Any]] | None = None) -> str:
    """Return the manifest of the devices, with the addresses `at` if they are known."""
    place = {"host": "127.0.0.1", "port": 1}
    plate = {"driver": "zaber.stage", "map": {"angle": {"property": "position"}},
             "settings": {"counts_per_unit": 100, "unit": "deg", "emulated_speed": 2000}}  # fmt: skip
    found: dict[str, dict[str, Any]] = {
        "top": {"driver": "frames.camera", "address": {**place, "port": 2}},
        "h1_mount": {**plate, "of": "h1", "address": {**place, "device": 1}, "identity": {"serial": "51"}},
        "h2_mount": {**plate, "of": "h2", "address": {**place, "device": 2}, "identity": {"serial": "52"}},
        "gate_box": {"driver": "switches.shutter", "of": "gate", "address": {**place, "port": 3, "name": "gate"}},
        "meter_head": {"driver": "scpi.meter", "of": "meter", "address": {"visa": "TCPIP0::127.0.0.1::4::SOCKET"}},
    }
    if kind == "arm":
        address = {"host": "127.0.0.1"}
        settings = {"tool_z": 172, "pace": float(PACE)}
        found["arm1"] = {"driver": "xarm.arm", "address": address, "settings": settings}
        found["arm1_hand"] = {"driver": "xarm.gripper", "of": "arm1", "address": address}
    for name, there in (at or {}).items():
        found[name]["address"] = dict(there)
    head = "apiVersion: pico/v1\nkind: Devices\nmetadata: {lab: plates}\ndevices:\n"
    return head + "".join(f"  {name}: {json.dumps(entry)}\n" for name, entry in found.items())


def git(folder: Path, *words: str) -> str:
    """Return the output of git in a folder; raises CalledProcessError."""
    return subprocess.run(
        ["git", *words], cwd=folder, check=True, capture_output=True, text=True, env={**os.environ, **GIT}
    ).stdout.strip()  # fmt: skip


def lab_in(folder: Path, kind: str, at: Mapping[str, Mapping[str, Any]] | None = None) -> None:
    """Create the lab with its history in a folder: a tag for each of `STATES`, and the branch `side`."""
    (folder / "state").mkdir(parents=True)
    git(folder, "init", "-q", "-b", "main")
    (folder / "lab.yaml").write_text(LABS[kind])
    (folder / "devices.yaml").write_text(devices(kind, at))
    (folder / ".gitignore").write_text(".pico/\n")
    for tag, numbers in STATES.items():
        (folder / "state" / "table.yaml").write_text(state(kind, *numbers))
        git(folder, "add", "-A")
        git(folder, "commit", "-q", "-m", tag)
        git(folder, "tag", tag)
    git(folder, "branch", "side", "v2")


# the hardware bench: emulators in a process of their own, and a proxy on each wire

_ARM_MOVES = {23, 29, 81}
"""Registers of the arm's controller that make it move: joints, servo set-points, Cartesian set-points."""


def mutating(driver: str, data: bytes) -> list[str]:
    """Return the commands in the bytes to a device that make it act; the others only query it."""
    if driver.startswith("zaber"):
        return [m.decode() for m in re.findall(rb"/\d+ \d+(?: \d+)? (?:home|move|stop|set)\b[^\n]*", data)]
    if driver.startswith("switches"):
        return [m.decode() for m in re.findall(rb"set \w+ [01]", data)]
    if driver.startswith("scpi"):
        return [m.decode() for m in re.findall(rb"(?:SENS:CORR:WAV |OUTP |ROUT:)[^\n]*", data)]
    if driver.startswith("xarm"):
        from pico.emulators.xarm.frames import split

        return [f"register {f.register}" for f in split(data)[0] if f.register in _ARM_MOVES or _grips(f)]
    return []


def _grips(frame: Any) -> bool:
    """Return whether a request to the arm moves its gripper: it writes registers on the line of the tool."""
    return frame.register == 124 and len(frame.payload) > 2 and frame.payload[2] in (0x06, 0x10)


class Wire:
    """A TCP proxy that records what clients send: the number of `bytes`, and the commands that make the device act."""

    def __init__(self, driver: str, host: str, port: int) -> None:
        self.driver, self._behind = driver, (host, port)
        self.bytes, self.mutating, self.open = 0, list[str](), 0
        self._lock = threading.Lock()
        self._listening = socket.create_server((host if host.startswith("127.") else "127.0.0.1", 0))
        self.port: int = self._listening.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self) -> None:
        while True:
            front, _ = self._listening.accept()
            try:
                back = socket.create_connection(self._behind)
            except OSError:
                front.close()
                continue
            for end in (front, back):
                end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            with self._lock:
                self.open += 1
            threading.Thread(target=self._pass_on, args=(front, back, True), daemon=True).start()
            threading.Thread(target=self._pass_on, args=(back, front, False), daemon=True).start()

    def _pass_on(self, end: socket.socket, other: socket.socket, to_device: bool) -> None:
        with suppress(OSError):
            while data := end.recv(65536):
                if to_device:
                    with self._lock:
                        self.bytes += len(data)
                        self.mutating += mutating(self.driver, data)
                other.sendall(data)
        with suppress(OSError):
            other.shutdown(socket.SHUT_WR)
        if to_device:
            with self._lock:
                self.open -= 1


def _table(root: Path, place: Path, ready: int) -> None:
    """Serve the emulators of the lab in `root`. Write the addresses to the file descriptor `ready`, then answer each
    connection to the socket `place` with the traffic so far."""
    os.environ["PICO_EMULATED_PACE"] = PACE
    from pico.backends.emulated.bench import brought_up
    from pico.backends.instruments import emulated
    from pico.manifest.load import load_folder
    from pico.places.bench import BenchPlace

    setup, _ = load_folder(root).require()
    assert setup.wiring
    _, running = brought_up(setup, BenchPlace(root, "emulated"), emulated(dict(setup.wiring.devices)))
    wires, at = dict[tuple[str, int], Wire](), dict[str, dict[str, Any]]()
    for name, entry in running.entries.items():
        visa = str(entry.address.get("visa", ""))
        host, port = ("127.0.0.1", int(visa.split("::")[2])) if visa else (entry.address["host"], entry.address["port"])
        wire = wires.get((str(host), int(port))) or Wire(entry.driver, str(host), int(port))
        wires[str(host), int(port)] = wire
        at[name] = {"visa": f"TCPIP0::127.0.0.1::{wire.port}::SOCKET"} if visa else {**entry.address, "port": wire.port}
    listening = socket.socket(socket.AF_UNIX)
    listening.bind(str(place))
    listening.listen()
    os.write(ready, json.dumps(at).encode() + b"\n")
    while True:
        asking, _ = listening.accept()
        with asking:
            for _ in range(40):  # bytes of the last client may still be in the buffers of its closed connection
                if not any(wire.open for wire in wires.values()):
                    break
                threading.Event().wait(0.01)
            traffic = {w.driver: [w.bytes, w.mutating] for w in wires.values()}
            asking.sendall(json.dumps(traffic).encode())


@dataclass
class Traffic:
    """What the devices of the hardware bench have received, by driver."""

    bytes: dict[str, int] = field(default_factory=dict)
    mutating: dict[str, list[str]] = field(default_factory=dict)
    """The commands that make a device act, in their order."""


def read_traffic(place: Path) -> Traffic:
    """Return what the devices have received so far."""
    with socket.socket(socket.AF_UNIX) as asking:
        asking.connect(str(place))
        answer = b""
        while data := asking.recv(65536):
            answer += data
    found = json.loads(answer)
    return Traffic({k: v[0] for k, v in found.items()}, {k: v[1] for k, v in found.items()})


TIED = [True]
"""Whether processes that are forked from now on end with their parent; what PICO forks itself does not."""


def end_with_parent() -> None:
    """Have the system kill this process when its parent ends, on Linux."""
    if TIED[0] and sys.platform == "linux":
        ctypes.CDLL(None).prctl(1, signal.SIGKILL, 0, 0, 0)


def fork(work: Callable[[int], None]) -> tuple[int, str]:
    """Run `work` in a child process; return the number of the process, and the first line that it writes to the file
    descriptor that it is given."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.close(reading)
            os.setsid()
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                signal.signal(number, signal.SIG_DFL)
            work(writing)
        except BaseException as exc:
            print(f"{work!r} ended: {exc!r}", file=sys.stderr, flush=True)
        finally:
            os._exit(1)
    os.close(writing)
    line = b""
    while not line.endswith(b"\n") and (data := os.read(reading, 65536)):
        line += data
    os.close(reading)
    return child, line.decode()


def kill(child: int) -> None:
    """Kill a process that `fork` started."""
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)


@contextmanager
def benches(folder: Path, kind: str) -> Iterator[dict[str, Path]]:
    """Set up the four benches in a folder. Yields `main`, the checkout, `far`, the folder of the remote bench, and
    `wires`, the socket for `read_traffic`."""
    from relaying import relayed

    from pico.edge.network.remotes import Remote, Remotes, keep

    table, far, main, wires = (folder / name for name in ("table", "far", "main", "wires"))
    (table / "state").mkdir(parents=True)
    (table / "lab.yaml").write_text(LABS[kind])
    (table / "devices.yaml").write_text(devices(kind))
    (table / "state" / "table.yaml").write_text(state(kind, *STATES["v1"]))
    lab_in(far, kind)
    child, addresses = fork(lambda ready: _table(table, wires, ready))
    try:
        if not addresses:
            raise RuntimeError("the emulators of the hardware bench did not come up")
        lab_in(main, kind, json.loads(addresses))
        with relayed(far) as url:
            keep(main, Remotes({"lab": Remote(url)}))
            yield {"main": main, "far": far, "wires": wires}
    finally:
        kill(child)
