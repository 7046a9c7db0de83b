"""Run `pip install` with the arguments given, and say every few seconds what it is doing.

Left alone, pip is silent for a minute (`--quiet`) or prints hundreds of lines. This prints one line that changes on a
terminal, and else a line every ten seconds. What pip printed is shown in full if it fails.
"""

from __future__ import annotations

import re
import subprocess
import sys
import threading
import time
from collections.abc import Iterable

STEP = re.compile(
    r"^\s*(Collecting|Downloading|Using cached|Installing collected packages|Building|Preparing)\b:?\s*(.*)"
)
EVERY = 10.0
"""Seconds between two lines if the output is not a terminal."""


class Progress:
    """What pip does at present, in a few words."""

    def __init__(self) -> None:
        self.doing = "starting"
        self.packages = 0
        self.started = time.monotonic()

    def read(self, line: str) -> None:
        """Learn from a line that pip printed."""
        if not (step := STEP.match(line)):
            return
        verb, rest = step.groups()
        name = re.split(r"[\s=<>~!\[(;,]", rest, maxsplit=1)[0].rpartition("/")[2]
        if verb == "Collecting":
            self.packages += 1
            self.doing = f"package {self.packages}: {name}"
        elif verb.startswith("Installing"):
            self.doing = f"unpacking {rest.count(',') + 1} packages"
        else:
            self.doing = f"package {self.packages}: {verb.lower()} {name.partition('-')[0]}"

    def __str__(self) -> str:
        return f"  {time.monotonic() - self.started:3.0f} s  {self.doing}"


def report(progress: Progress, ended: threading.Event) -> None:
    """Print what pip does until it ends."""
    terminal = sys.stdout.isatty()
    while not ended.wait(0.2 if terminal else EVERY):
        print(f"\r{str(progress)[:78]:78}" if terminal else progress, end="" if terminal else "\n", flush=True)
    if terminal:
        print(f"\r{'':78}\r", end="", flush=True)


def install(arguments: Iterable[str]) -> int:
    """Run `pip install`, and return its exit code."""
    command = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "--disable-pip-version-check",
        "--progress-bar",
        "off",
        *arguments,
    ]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    assert process.stdout is not None
    progress, ended, lines = Progress(), threading.Event(), []
    teller = threading.Thread(target=report, args=(progress, ended), daemon=True)
    teller.start()
    for line in process.stdout:
        lines.append(line)
        progress.read(line)
    code = process.wait()
    ended.set()
    teller.join()
    if code:
        print("".join(lines), end="", file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(install(sys.argv[1:]))
