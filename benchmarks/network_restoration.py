"""The case study over a network of this machine beside the embedded one: `python benchmarks/network_restoration.py`.

Coordinator, edge and client are processes of their own. The bench goes from E3-2 to E1-1, and with `--recipe`
the whole recipe runs; each is done again embedded, in a copy of the same repository. Printed are what is compared (the
plan's digest, which operations were done in which order, where every tunable then stands; of the recipe the state of
each of its commits) and the seconds that either took. Exit code 1 where the two differ.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from pico.model.plan import plan_from_json

PICO = [sys.executable, "-m", "pico_cli"]


def said(folder: Path, *words: str) -> list[Any]:
    """Return the documents that a command prints as JSON; raises SystemExit where it fails."""
    done = subprocess.run([*PICO, "-C", str(folder), "--json", *words], capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{words}: exit code {done.returncode}: {done.stdout[-1500:]}{done.stderr[-1500:]}")
    return [json.loads(line) for line in done.stdout.splitlines()]


@contextmanager
def going(folder: Path, *words: str) -> Iterator[Any]:
    """Let a command go on meanwhile that says that it does; yields what it said."""
    with subprocess.Popen([*PICO, "-C", str(folder), "--json", *words], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            yield json.loads(process.stdout.readline())
        finally:
            process.send_signal(signal.SIGTERM)
            process.wait(60)


def digest_apart(plan: dict[str, Any]) -> str:
    """Return the digest of a plan without the bench that it names."""
    return replace(plan_from_json(json.dumps(plan)), bench=None).sealed().digest


def restored(lab: Path, path: Sequence[str], fidelity: str) -> dict[str, Any]:
    """Return the plan of a restoration, what was done of it in which order, and how the bench then stands."""
    said(lab, "checkout", path[0], "-y", "--fidelity", fidelity)
    plan = said(lab, "plan", path[1], "--fidelity", fidelity)[0]
    events = said(lab, "checkout", path[1], "-y", "--fidelity", fidelity)
    rows = said(lab, "status")[0]["rows"]
    return {
        "plan": digest_apart(plan),
        "operations": [e["operation"] for e in events if e.get("kind") == "operation_done"],
        "end": {f"{row['component']}.{row['tunable']}": row["live"] for row in rows},
    }


def run_recipe(lab: Path, fidelity: str, tilts: str) -> dict[str, Any]:
    """Return the state of each commit that the recipe made, by its branch and message."""
    said(lab, "run", "shel", "-y", "--fidelity", fidelity, "-p", f"tilts={tilts}", "-p", f"again={tilts}")
    words = [
        "git",
        "-C",
        str(lab),
        "log",
        "--format=%s|%(trailers:key=Pico-State,valueonly,separator=%x20)",
        "--tags=a/*",
    ]
    found = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    return {"commits": sorted(found.splitlines())}


def compared(what: str, alone: Path, desk: Path, act: Any) -> bool:
    """Do something embedded and over the network, print what is the same, and return whether all is."""
    found, seconds = [], []
    for lab in (alone, desk):
        began = time.monotonic()
        found.append(act(lab))
        seconds.append(time.monotonic() - began)
    same = {key: found[0][key] == found[1][key] for key in found[0]}
    sizes = ", ".join(f"{key} ({len(v) if isinstance(v := found[0][key], list | dict) else 1})"
                      f" {'the same' if same[key] else 'OTHERWISE'}" for key in same)  # fmt: skip
    print(f"{what}: {sizes}; {seconds[0]:.0f} s embedded, {seconds[1]:.0f} s over the network", flush=True)
    for key in (key for key in same if not same[key]):
        print(f"  {key}: {found[0][key]}\n  {key}: {found[1][key]}")
    return all(same.values())


def main() -> int:
    """Compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fidelity", choices=("kinematic", "physics"), default="physics")
    parser.add_argument("--path", nargs=2, default=["E3-2", "E1-1"])
    parser.add_argument("--recipe", action="store_true")
    parser.add_argument("--tilts", default="[0, 15, 30]")
    options = parser.parse_args()
    for name, value in (("NAME", "A Physicist"), ("EMAIL", "physicist@localhost")):
        os.environ[f"GIT_AUTHOR_{name}"] = os.environ[f"GIT_COMMITTER_{name}"] = value
    fidelity = options.fidelity
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        os.environ["XDG_CONFIG_HOME"], os.environ["GIT_CONFIG_GLOBAL"] = str(folder / "config"), os.devnull
        said(folder, "init", "--example", "shel", "shel")
        beside, desk, alone = (Path(shutil.copytree(folder / "shel", folder / n / "shel")) for n in ("e", "d", "a"))
        with going(folder, "serve", "--port", "0", "--folder", str(folder / "books")) as serving:
            said(desk, "remote", "add", "lab", serving["url"])
            said(desk, "login", "lab", "--code", serving["code"])
            code = said(desk, "token", "enrol", "shel/bench1")[0]["enrolment"]["code"]
            said(beside, "edge", "enrol", serving["url"], "--code", code)
            with going(beside, "edge", "--fidelity", fidelity):
                said(desk, "bench", "use", "shel/bench1")
                start, end = options.path
                same = compared(f"{start} to {end}, {fidelity}", alone, desk,
                                lambda lab: restored(lab, options.path, fidelity))  # fmt: skip
                if options.recipe:
                    same &= compared(f"recipe shel, {fidelity}", alone, desk,
                                     lambda lab: run_recipe(lab, fidelity, options.tilts))  # fmt: skip
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
