"""Links between processes of a lab on the network that go wrong as they are told: on loopback, and between network
namespaces of our own where the machine lets an ordinary user make them."""

from __future__ import annotations

import asyncio
import ctypes
import mmap
import os
import random
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

CLEAR, DEAF, DUMB, SLOW, CUT = range(5)
"""What a link is like: hands all on; loses what the nearer end says, or the farther one; is late by up to a second;
cuts its connections off."""
WEATHER = {"deaf": DEAF, "dumb": DUMB, "slow": SLOW, "cut": CUT}
_NEWNET = 0x40000000
_APART = "PICO_BENCHMARK_APART"


class Weather:
    """What a link is like now, as the processes that were forked since read it."""

    def __init__(self) -> None:
        self._shared = mmap.mmap(-1, 1)

    @property
    def now(self) -> int:
        return self._shared[0]

    @now.setter
    def now(self, value: int) -> None:
        self._shared[0] = value


async def _piped(
    reader: asyncio.StreamReader, writer: asyncio.StreamWriter, lost: int, weather: Weather, whole: list[bool]
) -> None:
    with suppress(OSError):
        while data := await reader.read(65536):
            if weather.now == SLOW:
                await asyncio.sleep(random.uniform(0.05, 1.0))
            elif weather.now == lost:
                whole[0] = False  # what lost bytes must not go on as if it had not
            if weather.now == CUT or (not whole[0] and weather.now != lost):
                break
            if whole[0]:
                writer.write(data)
                await writer.drain()
    writer.transport.abort()


def link(at: tuple[str, int], to: tuple[str, int], weather: Weather) -> None:
    """Hand bytes on between two addresses: killed, both ends are cut off; frozen, nothing comes through."""

    async def client(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            there, back = await asyncio.open_connection(*to)
        except OSError:
            writer.transport.abort()
            return
        whole = [True]
        await asyncio.gather(
            _piped(reader, back, DEAF, weather, whole), _piped(there, writer, DUMB, weather, whole)
        )  # fmt: skip

    async def serve() -> None:
        async with await asyncio.start_server(client, *at):
            await asyncio.Event().wait()

    asyncio.run(serve())


# namespaces


def apart() -> str | None:
    """Go on in a user and network namespace of this process's own, by starting it anew there; return why that is not
    possible, None once it is so."""
    if os.environ.get(_APART):
        return None
    unshare, ip = shutil.which("unshare"), shutil.which("ip")
    if unshare is None or ip is None:
        return "no `unshare` or no `ip`"
    try_it = f"{ip} link set lo up && {ip} link add name one type veth peer name two"
    tried = subprocess.run([unshare, "-rn", "sh", "-c", try_it], capture_output=True, text=True, check=False)
    if tried.returncode:
        return tried.stderr.strip()[:200] or "refused"
    os.environ[_APART] = "1"
    begin = f'{ip} link set lo up; exec "$@"'
    os.execv(unshare, [unshare, "-rn", "sh", "-c", begin, "sh", sys.executable, *sys.argv])
    return None


class Cable:
    """A cable to a second network namespace: what is forked `beyond` it is reached over it alone."""

    def __init__(self) -> None:
        """Raises OSError and CalledProcessError where that can't be made."""
        self._keeper = os.fork()
        if not self._keeper:
            _libc("unshare", _NEWNET)
            while True:
                time.sleep(3600)
        pid, own = str(self._keeper), Path("/proc/self/ns/net").readlink()
        while Path(f"/proc/{pid}/ns/net").readlink() == own:
            time.sleep(0.005)
        self._name, net = f"p{pid}", f"10.{self._keeper // 250 % 250}.{self._keeper % 250}"
        self.here, there = f"{net}.1", f"{net}.2"
        _ip("link", "add", "name", self._name, "type", "veth", "peer", "name", "far", "netns", pid)
        _ip("addr", "add", f"{self.here}/24", "dev", self._name)
        _ip("link", "set", self._name, "up")
        child = os.fork()
        if not child:
            self._enter()
            _ip("link", "set", "lo", "up")
            _ip("addr", "add", f"{there}/24", "dev", "far")
            _ip("link", "set", "far", "up")
            os._exit(0)
        os.waitpid(child, 0)

    def beyond(self, work: Callable[[], None]) -> Callable[[], None]:
        """Return what does the same at the other end."""

        def there() -> None:
            self._enter()
            work()

        return there

    def pull(self, pulled: bool) -> None:
        """Pull it out, so that nothing gets through and nobody is told, or put it in again."""
        _ip("link", "set", self._name, "down" if pulled else "up")

    def close(self) -> None:
        """End the other namespace; the cable goes with it."""
        os.kill(self._keeper, 9)
        os.waitpid(self._keeper, 0)

    def _enter(self) -> None:
        file = os.open(f"/proc/{self._keeper}/ns/net", os.O_RDONLY)
        _libc("setns", file, _NEWNET)
        os.close(file)


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True, capture_output=True)


def _libc(name: str, *arguments: int) -> None:
    libc = ctypes.CDLL(None, use_errno=True)
    if getattr(libc, name)(*arguments):
        raise OSError(ctypes.get_errno(), name)
