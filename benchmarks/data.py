"""The large data of runs: `python benchmarks/data.py --commits 10000 --objects 200 --size 1 --kills 200`.

`--commits`: a history with a run in each commit, and how long it takes to tell what they need. `--objects` of `--size`
MB each: put, push to a folder, push again, fetch into a clone, read again, remove; MB a second of wall time, and CPU
seconds. `--kills`: kill -9 of `pico data push` at random instants; the place must hold whole objects only, and the push
after it must send the rest. On the disk of TMPDIR.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT)]
MEGABYTE = 1_000_000


def git(folder: Path, *words: str, data: bytes = b"") -> str:
    """Run git and return what it says."""
    environment = os.environ | {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull}
    done = subprocess.run(["git", *words], cwd=folder, input=data, env=environment, capture_output=True, check=True)
    return done.stdout.decode()


def history(folder: Path, runs: list[list[bytes]], names: list[str]) -> None:
    """Make a repository with one commit a run; a run names some objects by hash."""
    folder.mkdir()
    git(folder, "init", "-q", "-b", "main")
    lines: list[bytes] = []
    for number, (objects, name) in enumerate(zip(runs, names, strict=True)):
        artifacts = [{"name": "frame.bin", "sha256": sha(o), "size": len(o)} for o in objects]
        document = json.dumps({"schema": "pico.run/v1", "id": name, "artifacts": artifacts}).encode()
        state = b"x: %d\n" % number
        lines.append(
            b"commit refs/heads/main\ncommitter A <a@localhost> %d +0000\ndata 1\nc" % (1_700_000_000 + number)
        )
        month = number * 12 // len(runs) + 1
        for path, data in ((f"runs/2026/{month:02d}/{name}/run.json", document), ("state/table.yaml", state)):
            lines.append(b"M 644 inline %s\ndata %d\n%s" % (path.encode(), len(data), data))
    git(folder, "fast-import", "--quiet", data=b"\n".join(lines) + b"\n")
    git(folder, "reset", "-q", "--hard", "main")


def sha(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def timed(what: str, size: float, work: Callable[[], Any]) -> Any:
    """Do something and print how fast it was; `size` in MB, or 0."""
    wall, cpu = time.perf_counter(), sum(os.times()[:4])  # git's as well
    found = work()
    wall, cpu = time.perf_counter() - wall, sum(os.times()[:4]) - cpu
    rate = f"{size / wall:8.0f} MB/s" if size else " " * 13
    print(f"{what:<34} {rate} {wall:8.2f} s {cpu:8.2f} s CPU", flush=True)
    return found


def walked(folder: Path, commits: int) -> None:
    """Print how long it takes to tell what a long history needs."""
    from pico.history.data.lab import LabData

    history(folder, [[b"%d" % n] for n in range(commits)], [f"run-{n:06d}" for n in range(commits)])
    data = LabData.discover(folder)
    found = timed(f"needs of {commits} runs", 0, data.needs)
    assert len(found) == commits


def moved(top: Path, objects: int, size: float) -> None:
    """Print how fast objects go to a folder and come back."""
    from pico.history.data.lab import LabData

    contents = [random.Random(n).randbytes(int(size * MEGABYTE)) for n in range(objects)]
    lab, clone, share, total = top / "lab", top / "clone", top / "share", objects * size
    history(lab, [[c] for c in contents], [f"run-{n:06d}" for n in range(objects)])
    share.mkdir()
    git(top, "clone", "-q", str(lab), str(clone))
    data, other = LabData.discover(lab), LabData.discover(clone)
    timed(f"put {objects} objects of {size:g} MB", total, lambda: [data.store.put(c) for c in contents])
    timed("push to a folder", total, lambda: data.push(str(share)))
    timed("push again: nothing lacks", 0, lambda: data.push(str(share)))
    timed("fetch into a clone", total, lambda: other.pull(str(share)))
    assert timed("read all again", total, other.check).well
    git(clone, "update-ref", "-d", "refs/heads/main")
    git(clone, "update-ref", "-d", "refs/remotes/origin/main")
    git(clone, "update-ref", "-d", "refs/remotes/origin/HEAD")
    git(clone, "rm", "-rq", "--cached", ".")
    git(clone, "clean", "-fdqx")
    git(clone, "reflog", "expire", "--expire=now", "--all")
    freed = timed("remove what nothing needs", 0, lambda: other.remove(other.garbage(0.0), 0.0))
    assert freed == sum(map(len, contents)), freed


def killed(top: Path, kills: int) -> int:
    """Kill pushes at random instants and return how often something was wrong afterwards."""
    from pico.content.store import Store
    from pico.history.data.lab import LabData

    draw, wrong = random.Random(1), 0
    contents = [draw.randbytes(200_000) for _ in range(30)]
    lab = top / "killed"
    history(lab, [contents], ["run-0"])
    data = LabData.discover(lab)
    for content in contents:
        data.store.put(content)
    code = "import sys; from pico.history.data.lab import LabData; from pathlib import Path; print();"
    code += "sys.stdout.flush(); LabData.discover(Path(sys.argv[1])).push(sys.argv[2])"
    for number in range(kills):
        share = top / f"share-{number}"
        share.mkdir()
        words = [sys.executable, "-c", code, str(lab), str(share)]
        process = subprocess.Popen(words, cwd=ROOT, stdout=subprocess.PIPE)
        assert process.stdout
        process.stdout.readline()
        time.sleep(draw.uniform(0, 0.4))
        process.send_signal(signal.SIGKILL)
        process.communicate()
        there = Store(share)
        before = list(there.all())
        whole = all(there.is_intact(name) for name in before)
        sent = data.push(str(share))
        if not whole or len(before) + len(sent.objects) != len(contents) or len(list(there.all())) != len(contents):
            wrong += 1
            print(f"kill {number}: {len(before)} objects before, whole: {whole}, {len(sent.objects)} sent after")
    print(f"{kills} pushes killed, {wrong} left something half or lost")
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--commits", type=int, default=10_000)
    parser.add_argument("--objects", type=int, default=200)
    parser.add_argument("--size", type=float, default=1.0)
    parser.add_argument("--kills", type=int, default=200)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        top = Path(temporary)
        walked(top / "long", given.commits)
        moved(top, given.objects, given.size)
        return 1 if killed(top, given.kills) else 0


if __name__ == "__main__":
    sys.exit(main())
