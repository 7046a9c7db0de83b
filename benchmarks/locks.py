"""Two processes that apply at once: exactly one moves, the other ends with 5 and names it.

`python benchmarks/locks.py --trials 100`. Both plan to one revision, wait for the same signal, and apply. Prints how
often which of the two moved, and exits with 1 where a trial went otherwise.
"""

from __future__ import annotations

import argparse
import collections
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from pico.diagnostics import ExitCode

WORKER = """
import json, os, sys
import pico
from pico.diagnostics import PicoError
bench = pico.open(sys.argv[1])
for line in sys.stdin:
    plan = bench.plan(line.strip())
    print(json.dumps({"operations": len(plan.operations)}), flush=True)
    sys.stdin.readline()
    try:
        report = bench.apply(plan)
        said = {"code": int(report.exit_code), "done": report.done, "text": ""}
    except PicoError as exc:
        said = {"code": int(exc.exit_code), "done": 0, "text": exc.diagnostics[0].summary}
    print(json.dumps({**said, "pid": os.getpid()}), flush=True)
"""


def tell(worker: subprocess.Popen[str], line: str) -> None:
    assert worker.stdin is not None
    worker.stdin.write(line + "\n")
    worker.stdin.flush()


def hear(worker: subprocess.Popen[str]) -> dict[str, Any]:
    assert worker.stdout is not None
    said: dict[str, Any] = json.loads(worker.stdout.readline())
    return said


def trial(workers: list[subprocess.Popen[str]], revision: str) -> tuple[int, str]:
    """Let both apply a revision at once; return which of them moved, and what was wrong."""
    for worker in workers:
        tell(worker, revision)
    planned = [hear(worker)["operations"] for worker in workers]
    for worker in workers:
        tell(worker, "go")
    said = [hear(worker) for worker in workers]
    moved = [n for n, one in enumerate(said) if one["code"] == 0 and one["done"] == planned[n] > 0]
    refused = [n for n, one in enumerate(said) if one["code"] == ExitCode.LOCKED and one["done"] == 0]
    if len(moved) != 1 or len(refused) != 1:
        return -1, f"{revision}: {said}"
    text = said[refused[0]]["text"]
    return moved[0], "" if f"process {said[moved[0]]['pid']}" in text else f"the holder is not named: {text}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trials", type=int, default=100)
    trials = parser.parse_args().trials
    from pico.bench.bench import new_lab

    with tempfile.TemporaryDirectory() as folder:
        lab = Path(folder) / "shel"
        new_lab(lab, "shel")
        start = [sys.executable, "-c", WORKER, str(lab)]
        pipe = subprocess.PIPE
        workers = [subprocess.Popen(start, stdin=pipe, stdout=pipe, text=True) for _ in range(2)]
        moved: collections.Counter[int] = collections.Counter()
        wrong = []
        for n in range(trials):
            which, problem = trial(workers, ("E1-1", "C3")[n % 2])
            moved[which] += 1
            wrong += [problem] if problem else []
        for worker in workers:
            worker.communicate()
    print(
        f"{trials} trials: the first process moved {moved[0]} times, the second {moved[1]} times, wrong: {len(wrong)}"
    )
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
