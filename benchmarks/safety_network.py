"""How soon a coordinator tells of light that could not be ended.

    python benchmarks/safety_network.py [--links ...] [--states ...]

A coordinator, an edge with emulated lasers at the wire (`benchmarks/safety_world.py`) and a client are processes of
their own. A door opens while the link to all lasers and shutters is dead: its box answers nothing (`silent`), or it
is gone (`cut`). Printed is after how long the stream that pages watch says so, and after how long a look through the
coordinator does, as `pico status` takes it. The exit code is 3 if either takes longer than 2 s.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from itertools import product
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from network_restoration import going, said  # noqa: E402
from safety_chain import TOLD, beside  # noqa: E402
from websockets.sync.client import connect  # noqa: E402

from pico.bench.bench import Bench  # noqa: E402
from pico.diagnostics import PicoError  # noqa: E402
from pico.edge.network.tokens import token_of  # noqa: E402

NAME = "minimal/bench1"
LINKS = {"silent": ("freeze", "light", True), "cut": ("cut", "light")}
"""How the link to lasers and shutters dies."""
STATES = ("idle", "measuring")
WAIT = 10.0
"""How long is waited for each to be told [s]."""
WORDS = "MAY STILL EMIT"


class Coordinated:
    """A bench at the wire whose edge is enrolled with a coordinator, and the client's checkout `desk`."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self.lab, self.desk, self._stack = folder / "edge" / "minimal", folder / "desk" / "minimal", stack
        pipe = subprocess.PIPE
        words = beside("safety_world", str(self.lab))
        self.world = subprocess.Popen(words, stdin=pipe, stdout=pipe, text=True, bufsize=1, cwd=ROOT / "benchmarks")
        stack.callback(self._over)
        assert self.world.stdout is not None and self.world.stdout.readline().strip() == '"ready"'
        subprocess.run(["git", "init", "-q", str(self.lab)], check=True)
        shutil.copytree(self.lab, self.desk)
        serving = stack.enter_context(going(folder, "serve", "--port", "0", "--folder", str(folder / "books")))
        self.url = serving["url"]
        said(self.desk, "remote", "add", "far", self.url)
        said(self.desk, "login", "far", "--code", serving["code"])
        code = said(self.desk, "token", "enrol", NAME)[0]["enrolment"]["code"]
        said(self.lab, "--backend", "hardware", "edge", "enrol", self.url, "--code", code)
        stack.enter_context(going(self.lab, "--backend", "hardware", "edge"))
        said(self.desk, "bench", "use", NAME)
        until = time.time() + 30
        while not self._connected() and time.time() < until:
            time.sleep(0.1)

    def ask(self, *words: Any) -> Any:
        """Have the world do something, and return its answer."""
        assert self.world.stdin is not None and self.world.stdout is not None
        self.world.stdin.write(json.dumps(words) + "\n")
        return json.loads(self.world.stdout.readline())

    def _connected(self) -> bool:
        try:
            with Bench.open(self.desk) as bench:
                return bool(bench.observe().components)
        except PicoError:
            return False

    def light(self) -> None:
        """Let both lasers emit, as a person does at the desk."""
        with Bench.open(self.desk) as bench:
            for name, tunable, value in (("laser", "emission", "true"), ("laser", "shutter", "open"),
                                         ("bare", "emission", "true")):  # fmt: skip
                report = bench.apply(bench.single(name, "set", **{tunable: value}))
                assert report.outcome == "done", report
        assert all(self.ask("lit").values())

    def told(self, link: str, state: str) -> dict[str, float | None]:
        """Return after how long [s] stream and look told that light could not be ended, None if they did not."""
        self.light()
        with self._acting(state), Bench.open(self.desk) as bench, self._page() as heard:
            found: dict[str, float | None] = {"stream": None, "look": None}
            self.ask(*LINKS[link])
            began = self.ask("pull", "door_box", True)
            while time.time() < began + WAIT and None in found.values():
                if found["look"] is None and any(WORDS in one.summary for one in bench.observe().problems):
                    found["look"] = time.time() - began
                if found["stream"] is None and (at := heard()) is not None:
                    found["stream"] = at - began
        return found

    @contextmanager
    def _page(self) -> Iterator[Callable[[], float | None]]:
        """Watch the bench as a page does; yields when it was told, by the wall [s]."""
        at: list[float] = []
        url = self.url.replace("http", "ws", 1) + f"/api/benches/{NAME}/live"
        with connect(url, additional_headers={"authorization": f"Bearer {token_of(self.url)}"}, proxy=None,
                     max_queue=None) as socket:  # fmt: skip

            def hear() -> None:
                for text in socket:
                    if isinstance(text, str) and WORDS in text:
                        at.append(time.time())

            thread = threading.Thread(target=hear, daemon=True)
            thread.start()
            yield lambda: at[0] if at else None

    @contextmanager
    def _acting(self, state: str) -> Iterator[None]:
        if state == "idle":
            yield
            return
        words = beside("safety_acts", str(self.desk), state, "")
        client = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, cwd=ROOT / "benchmarks")
        try:
            assert client.stdout is not None
            if client.stdout.readline().strip() != "there":
                raise SystemExit(f"the bench is not {state}")
            yield
        finally:
            client.kill()
            client.communicate()

    def _over(self) -> None:
        assert self.world.stdin is not None
        self.world.stdin.close()
        try:
            self.world.wait(20)
        except subprocess.TimeoutExpired:
            self.world.kill()


def main() -> int:
    """Try every combination, each on a bench of its own, and print what became of it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--links", nargs="*", default=list(LINKS), choices=list(LINKS))
    parser.add_argument("--states", nargs="*", default=list(STATES), choices=STATES)
    asked = parser.parse_args()
    os.environ |= {"PICO_EMULATED_PACE": "10", "GIT_CONFIG_GLOBAL": os.devnull}
    late = False
    for link, state in product(asked.links, asked.states):
        with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
            os.environ["XDG_CONFIG_HOME"] = str(Path(folder) / "config")
            found = Coordinated(Path(folder), stack).told(link, state)
        late |= any(at is None or at > TOLD for at in found.values())
        shown = ", ".join(f"{what} {'nothing' if at is None else f'{at:.2f} s'}" for what, at in found.items())
        print(f"door, {link} link, {state}: {shown}", flush=True)
    print("a bar was missed" if late else f"every one was told within {TOLD:g} s")
    return 3 if late else 0


if __name__ == "__main__":
    sys.exit(main())
