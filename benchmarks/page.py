"""What the page in the browser costs, and how fast it is: `python benchmarks/page.py`, in Chromium, drawn in software.

Prints the size of what is built, how long the twin takes until it is drawn and how long a click on a component in it
is answered, at `pico gui`; then the share of a core that a coordinator takes for one and for three pages that are shown
30 times a second a bench that moves all the time. Exit code 1 where the page is wrong; 3 where a figure misses its bar:
1.5 MB, 4 s, 100 ms, 3 % and 6 % of a core. Seconds of a core count the same on a busy machine, others do not. Without
Chromium, Node and what drives the browser it says so, and ends with 3.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from network_bench import BENCH, answers, coordinator, forked, free_port, until  # noqa: E402
from network_live import telling  # noqa: E402

UI, BUILT = ROOT / "ui", ROOT / "pico/server/static"
SIZE, DRAWN, PICKED, SHARES = 1.5, 4000.0, 100.0, {1: 0.03, 3: 0.06}


def lacks() -> str:
    """Return what is missing to drive a browser."""
    missing = [name for name in ("node", "chromium") if not shutil.which(name)]
    missing += [] if (UI / "node_modules/playwright-core").is_dir() else ["playwright-core (`make test-gui`)"]
    return ", ".join(missing)


@contextmanager
def driven(*words: str) -> Iterator[subprocess.Popen[str]]:
    """Run the script that drives the browser; ended where nobody else does."""
    # Chromium has a socket in its temporary folder, whose path must be short
    environment = os.environ | {"CHROMIUM": str(shutil.which("chromium")), "TMPDIR": "/tmp"}
    whole = ["node", UI / "test/browser/measure.mjs", *words]
    going = subprocess.Popen(
        whole, env=environment, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True
    )
    try:
        yield going
    finally:
        if going.poll() is None:
            os.killpg(going.pid, signal.SIGKILL)
        going.wait()


@contextmanager
def opened(folder: Path) -> Iterator[str]:
    """Have `pico gui` serve an example lab in the twin, and yield the address that it tells."""
    own = {"XDG_CONFIG_HOME": str(folder / "config"), "XDG_STATE_HOME": str(folder / "state")}
    pico = [sys.executable, "-m", "pico_cli"]
    environment = os.environ | own
    subprocess.run([*pico, "init", "--example", "shel", folder / "lab"], env=environment, check=True,
                   capture_output=True)  # fmt: skip
    serving = subprocess.Popen(
        [*pico, "-C", folder / "lab", "--json", "gui", "--no-open"], env=environment, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    try:
        assert serving.stdout is not None
        yield json.loads(serving.stdout.readline())["address"]
    finally:
        serving.send_signal(signal.SIGTERM)
        serving.wait(60)


def seen(folder: Path, opens: int, picks: int) -> tuple[list[bool], list[str]]:
    """Print how fast the page is; return which figures miss their bar, and what is wrong."""
    missed, wrong = list[bool](), list[str]()
    with opened(folder) as address, driven("drawn", address, str(opens), str(picks)) as going:
        text, _ = going.communicate(timeout=600)
        said = [json.loads(line) for line in text.splitlines()]
    if going.returncode:
        return missed, [f"the browser's script ended with {going.returncode}"]
    wrong += [str(one["wrong"]) for one in said if "wrong" in one]
    wrong += [f"a click on {one['name']} was not answered" for one in said if "pick" in one and one["pick"] is None]
    for what, name, most in (("drawn", "drawn", DRAWN), ("a click is answered", "pick", PICKED)):
        found = [one[name] for one in said if one.get(name) is not None]
        if not found:
            wrong.append(f"nothing was {what}")
            continue
        median = statistics.median(found)
        print(f"{what}: median {median:.0f} ms, worst {max(found):.0f} ms of {len(found)}", flush=True)
        missed.append(median > most)
    return missed, wrong


def _spent(process: int) -> float:
    """Return the seconds of a core that a process has taken."""
    words = Path(f"/proc/{process}/stat").read_text().rsplit(") ", 1)[1].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def watched(folder: Path, counts: list[int], seconds: float) -> tuple[list[bool], list[str]]:
    """Print what pages cost the coordinator; return which figures miss their bar, and what is wrong."""
    from pico.history.examples.example import make_example
    from pico.server.access.principal import right
    from pico.server.store.books import books_in
    from pico.server.store.edges import Edges

    books, key, port = books_in(folder / "books"), "5" * 64, free_port()
    books.people.settled("anna", [right("viewer")], by="benchmark")
    code, _ = Edges(books.database).invited(BENCH, "benchmark")
    Edges(books.database).enrolled(code, key)
    lab, missed, wrong = make_example("shel", folder / "shel").root, list[bool](), list[str]()
    serving = forked(lambda: coordinator(folder / "books", port))
    until(lambda: answers(port), 60)
    moving = forked(lambda: telling(port, BENCH, key, lab))
    try:
        for count in counts:
            codes = [books.people.issued("anna", 600.0, by="benchmark", kind="code").secret for _ in range(count)]
            with driven("watch", *(f"http://127.0.0.1:{port}/#code={code}" for code in codes)) as going:
                share, said = _share(going, serving, seconds)
            rate = min(said["frames"]) / said["seconds"]
            print(
                f"{count} page{'s' * (count > 1)}: {100 * share:.1f} % of a core of the coordinator, "
                f"{rate:.1f} frames a second at least", flush=True,
            )  # fmt: skip
            missed.append(share > SHARES.get(count, 1.0))
            if not rate:
                wrong.append("a page was shown nothing")
    finally:
        books.close()
        for child in (serving, moving):
            os.kill(child, 9)
            os.waitpid(child, 0)
    return missed, wrong


def _share(going: subprocess.Popen[str], serving: int, seconds: float) -> tuple[float, dict[str, Any]]:
    """Return the share of a core that a process takes while pages are open, and what they say at the end."""
    assert going.stdin is not None and going.stdout is not None
    assert "watching" in json.loads(going.stdout.readline())
    time.sleep(2.0)  # what is done once is over
    print("begin", file=going.stdin, flush=True)
    assert "begun" in json.loads(going.stdout.readline())
    before, began = _spent(serving), time.monotonic()
    time.sleep(seconds)
    share = (_spent(serving) - before) / (time.monotonic() - began)
    going.stdin.close()
    return share, json.loads(going.stdout.readline())


def main() -> int:
    """Measure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--opens", type=int, default=5)
    parser.add_argument("--picks", type=int, default=20)
    parser.add_argument("--pages", type=int, nargs="+", default=[1, 3])
    parser.add_argument("--seconds", type=float, default=20.0)
    given = parser.parse_args()
    size = sum(path.stat().st_size for path in BUILT.rglob("*") if path.is_file()) / 1e6
    print(f"built: {size:.2f} MB")
    if lacking := lacks():
        print(f"not measured, for want of {lacking}")
        return 3
    missed, wrong = [size > SIZE], list[str]()
    for measure in (
        lambda folder: seen(folder, given.opens, given.picks),
        lambda folder: watched(folder, given.pages, given.seconds),
    ):
        with tempfile.TemporaryDirectory() as temporary:
            more, faults = measure(Path(temporary))
        missed, wrong = missed + more, wrong + faults
    print("\n".join(f"wrong: {one}" for one in wrong), end="\n" * bool(wrong))
    return 1 if wrong else 3 if any(missed) else 0


if __name__ == "__main__":
    sys.exit(main())
