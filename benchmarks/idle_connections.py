"""How a coordinator and its STOP fare beside connections that only cost descriptors.

    python benchmarks/idle_connections.py --connections 1100 --limit 1024 --addresses 1

`pico serve --demo minimal` gets `--limit` descriptors (soft and hard). Connections with half a header, from
`--addresses` addresses of this machine, are opened and held; an eighth of them send nothing at all, an eighth begin a
body. Then health, `pico status` and `pico stop` are asked; at last the connections are counted that are still open
after the time in which headers have to be whole. Exit code 3: a figure is missed.
"""

from __future__ import annotations

import argparse
import http.client
import json
import os
import resource
import selectors
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from urllib.parse import urlsplit

PICO = [sys.executable, "-m", "pico_cli"]
HALF = b"GET /api/health HTTP/1.1\r\nHost: localhost\r\nX-A: "
BODY = (
    b"POST /api/login HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 900000\r\n\r\n"
)


def main() -> int:
    """Run, print, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--connections", type=int, default=1100)
    parser.add_argument("--limit", type=int, default=1024)
    parser.add_argument("--addresses", type=int, default=1)
    wanted = parser.parse_args()
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft < wanted.connections + 200:
        resource.setrlimit(resource.RLIMIT_NOFILE, (min(wanted.connections + 200, hard), hard))
    with tempfile.TemporaryDirectory() as folder:
        return measured(Path(folder), wanted.connections, wanted.limit, wanted.addresses)


def measured(folder: Path, connections: int, limit: int, addresses: int) -> int:
    """Serve, hold the connections, and ask."""
    environment = os.environ | {"XDG_CONFIG_HOME": str(folder / "config")}
    words = ["sh", "-c", 'ulimit -n "$0"; exec "$@"', str(limit)]
    words += [*PICO, "serve", "--demo", "minimal", "--folder", str(folder / "demo"), "--port", "0", "--json"]

    def pico(*asked: str, at: Path = folder) -> float:
        began = time.monotonic()
        subprocess.run([*PICO, *asked], cwd=at, env=environment, capture_output=True, check=True, timeout=60)
        return time.monotonic() - began

    log = folder / "log"
    held: list[socket.socket] = []
    with log.open("wb") as said, subprocess.Popen(
        words, cwd=folder, stdout=subprocess.PIPE, stderr=said, text=True, env=environment
    ) as serving:  # fmt: skip
        assert serving.stdout is not None
        try:
            told = json.loads(serving.stdout.readline())
            at = urlsplit(told["url"])
            pico("init", "--example", "minimal", "mine")
            pico("login", told["url"], "--code", told["code"])
            pico("remote", "add", "demo", told["url"], "--default", told["bench"], at=folder / "mine")
            assert at.port
            held.extend(opened(at.port, number, addresses) for number in range(connections))
            began = time.monotonic()
            health = [asked(at.port) for _ in range(20)]
            print(f"health beside {connections} connections: worst {max(health):.3f} s of 20")
            print(f"pico status: {pico('status', at=folder / 'mine'):.1f} s")
            print(f"pico stop: {pico('stop', at=folder / 'mine'):.1f} s")
            time.sleep(max(0.0, 14 - (time.monotonic() - began)))
            left = still_open(held)
            lines = len(log.read_text(errors="replace").splitlines())
            print(
                f"still open after {time.monotonic() - began:.0f} s: {left} of {connections}; lines in the log: {lines}"
            )
            return 3 if left or lines > 20 or max(health) > 2 else 0
        finally:
            for one in held:
                one.close()
            serving.send_signal(signal.SIGINT)
            serving.wait()


def opened(port: int, number: int, addresses: int) -> socket.socket:
    """Return a connection that keeps the server waiting."""
    source = (f"127.0.0.{2 + number % addresses}", 0)
    link = socket.create_connection(("127.0.0.1", port), timeout=10, source_address=source)
    link.sendall({0: b"", 1: BODY}.get(number % 8, HALF))
    return link


def asked(port: int) -> float:
    """Return how long an answer took [s]."""
    began = time.monotonic()
    link = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    link.request("GET", "/api/health")
    assert link.getresponse().status == 200
    link.close()
    return time.monotonic() - began


def still_open(links: list[socket.socket]) -> int:
    """Return how many of some connections the other end has not closed."""
    with selectors.DefaultSelector() as ready:
        for link in links:
            link.setblocking(False)
            ready.register(link, selectors.EVENT_READ)
        count = len(links)
        for key, _ in ready.select(0.5):
            try:
                found = key.fileobj.recv(65536)  # type: ignore[union-attr]
                count -= not found or b"400" in found or b"408" in found
            except OSError:
                count -= 1
        return count


if __name__ == "__main__":
    sys.exit(main())
