"""CPU seconds and peak memory of cold `pico` processes, beside OpenTofu's for as many resources.

    python benchmarks/startup.py [--sizes 100 1000 5000] [--repeat 5]

Each cell is the least of several runs of a fresh process (user + system time of the child, and its peak resident
set). The bench is simulated and answers at once; every component stands where the manifest wants it, 25 to a file.
An installed program has its bytecode: a run before, which is not counted, writes it into a folder of its own.
OpenTofu 1.12.6, a plan of `terraform_data` resources without changes, measured once on another 2-core machine:
0.21 s, 119 MiB for 100; 1.23 s, 188 MiB for 1,000; 7.9 s, 509 MiB for 5,000; `version` 0.08 s, 92 MiB.
"""

from __future__ import annotations

import argparse
import math
import os
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

TOFU = {"--version": (0.08, 92), 100: (0.21, 119), 1000: (1.23, 188), 5000: (7.9, 509)}
BARS = {"--version": (0.12, None), "--help": (0.12, None), 100: (0.45, 120), 1000: (0.6, 120), 5000: (1.5, 120)}
PITCH = 100
FILE = 25


def write_lab(folder: Path, count: int) -> None:
    """Write a lab of `count` polarizers on a grid, each with its own storage slot, and a state that equals home."""
    columns = math.ceil(math.sqrt(count))
    places = [(100 + PITCH * (i % columns), 100 + PITCH * (i // columns)) for i in range(count)]
    size = 200 + PITCH * columns
    lab = [
        "apiVersion: pico/v1\nkind: Lab\nmetadata: {name: large}",
        f"table: {{size: [{size}, {size}], beam_height: 70}}",
        "robots: {arm1: {model: gantry, mount: {x: 0, y: 0}}}\nslots:",
        *(f"  grid/s{i}: {{x: {x}, y: {y}}}" for i, (x, y) in enumerate(places)),
        "inventory:",
        *(f"  c{i:05}:\n    type: linear_polarizer\n    home: grid/s{i}" for i in range(count)),
    ]
    (folder / "lab.yaml").write_text("\n".join(lab) + "\n")
    (folder / "state").mkdir()
    for first in range(0, count, FILE):
        lines = ["apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: large}\ncomponents:"]
        for i in range(first, min(first + FILE, count)):
            x, y = places[i]
            lines.append(f"  c{i:05}:\n    pose:\n      x: {x}\n      y: {y}\n      yaw: 0\n    angle: 0")
        (folder / "state" / f"group{first // FILE:03}.yaml").write_text("\n".join(lines) + "\n")


def measure(command: list[str], cwd: Path, expect: int = 0) -> tuple[float, float]:
    """Run a process; return its CPU seconds and peak resident memory [MiB]."""
    with Path(os.devnull).open("wb") as null:
        child = subprocess.Popen(command, cwd=cwd, stdout=null)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != expect:
        sys.exit(f"{' '.join(command)} ended with {child.returncode}, expected {expect}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="*", default=[100, 1000, 5000])
    parser.add_argument("--repeat", type=int, default=5)
    options = parser.parse_args()
    pico = str(Path(sysconfig.get_path("scripts")) / "pico")
    print(f"{'':24}{'CPU s':>8}{'bar':>8}{'tofu':>8}{'MiB':>9}{'bar':>7}{'tofu':>7}")
    missed = 0
    with tempfile.TemporaryDirectory() as name:
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
        os.environ["PYTHONPYCACHEPREFIX"] = str(Path(name) / "bytecode")
        jobs: list[tuple[str | int, list[str], Path]] = [
            (w, [pico, str(w)], Path(name)) for w in ("--version", "--help")
        ]
        for size in options.sizes:
            folder = Path(name) / str(size)
            folder.mkdir()
            write_lab(folder, size)
            git = ["git", "-c", "user.name=bench", "-c", "user.email=bench@localhost"]
            for arguments in (["init", "-q"], ["add", "."], ["commit", "-qm", "a large bench"]):
                subprocess.run([*git, *arguments], cwd=folder, check=True)
            jobs.append((size, [pico, "plan", "--detailed-exitcode"], folder))
        for key, command, folder in jobs:
            measure(command, folder)
            runs = [measure(command, folder) for _ in range(options.repeat)]
            cpu, memory = min(r[0] for r in runs), max(r[1] for r in runs)
            (cpu_bar, memory_bar), (tofu_cpu, tofu_memory) = BARS.get(key, (None, None)), TOFU.get(key, ("", ""))
            late = (cpu_bar is not None and cpu > cpu_bar) or (memory_bar is not None and memory > memory_bar)
            missed += late
            label = f"plan of {key}, no change" if isinstance(key, int) else f"pico {key}"
            print(
                f"{label:24}{cpu:8.2f}{cpu_bar or '':>8}{tofu_cpu:>8}{memory:9.0f}{memory_bar or '':>7}{tofu_memory:>7}"
                + ("  missed" if late else "")
            )
    sys.exit(3 if missed else 0)


if __name__ == "__main__":
    main()
