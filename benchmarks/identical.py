"""The same plans, byte for byte, on every Python that is installed: `python benchmarks/identical.py [PYTHON ...]`.

Plans every step of the packaged labs' histories, and random labs, with each interpreter and another seed of Python's
hashes, and compares the digest and all bytes of what `pico plan --out` would save with those of this interpreter.

Interpreters: those named, or else the first of each version from 3.11 on that has what PICO needs (with its `dev`
extra) among `.venv-*` beside this repository's `.venv` and `python3.N` on the path. `--install FOLDER` makes a virtual
environment there for each version that has not, with the versions of constraints.txt; it takes a few minutes once.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WORKER = ROOT / "tests" / "planning" / "varied_plans.py"
VERSIONS = tuple(f"3.{minor}" for minor in range(11, 16))
NEEDS = "numpy, mujoco, pygit2, pydantic, yaml, ruckig, fcl, highspy, shapely"
SPAWN_LIMIT = 60.0
"""What an interpreter may take to say which it is [s]."""


def version(python: str) -> str | None:
    """Return the version of an interpreter such as `3.12`; None where it does not run."""
    said = _said(python, "import sys; print('%d.%d' % sys.version_info[:2])")
    return said.strip() if said else None


def equipped(python: str) -> bool:
    """Whether an interpreter has the packages that PICO needs to plan."""
    return _said(python, f"import {NEEDS}; print('yes')") is not None


def _said(python: str, code: str) -> str | None:
    try:
        done = subprocess.run([python, "-c", code], capture_output=True, text=True, timeout=SPAWN_LIMIT, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout if done.returncode == 0 else None


def candidates(folders: Sequence[Path] = ()) -> Iterator[str]:
    """Yield interpreters that may be installed: this one, those in virtual environments, and what is on the path."""
    yield sys.executable
    for folder in folders:
        yield from sorted(map(str, folder.glob("*/bin/python")))
    yield from sorted(map(str, ROOT.glob(".venv-*/bin/python")))
    root = os.environ.get("PYENV_ROOT")
    for name in VERSIONS:
        found = shutil.which(f"python{name}")
        yield from [found] if found else []
        yield from sorted(map(str, Path(root).glob(f"versions/{name}.*/bin/python"))) if root else []


def installed(folders: Sequence[Path] = ()) -> tuple[dict[str, str], dict[str, str]]:
    """Return by version the interpreters that can plan, and those that lack packages."""
    ready, bare = dict[str, str](), dict[str, str]()
    for python in candidates(folders):
        name = version(python)
        if name is None or name in ready or name not in VERSIONS:
            continue
        if equipped(python):
            ready[name] = python
            bare.pop(name, None)
        else:
            bare.setdefault(name, python)
    return ready, bare


def install(folder: Path, name: str, python: str) -> str:
    """Make a virtual environment with what PICO needs, and return its interpreter."""
    print(f"Installing for Python {name} into {folder / name} ...", flush=True)
    subprocess.run([python, "-m", "venv", str(folder / name)], check=True)
    made = str(folder / name / "bin" / "python")
    pip = [made, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-c", "constraints.txt"]
    subprocess.run([*pip, "setuptools", "wheel"], cwd=ROOT, check=True)
    subprocess.run([*pip, "--no-build-isolation", "-e", ".[dev]"], cwd=ROOT, check=True)
    return made


def plans(python: str, hashes: int, kinds: Sequence[str] = ()) -> list[str]:
    """Return a line for each plan that an interpreter makes: name, digest, SHA-256 of its bytes. `kinds`: see the
    worker, `tests/planning/varied_plans.py`."""
    environment = os.environ | {"PYTHONHASHSEED": str(hashes), "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [python, str(WORKER), *kinds], capture_output=True, text=True, env=environment, cwd=ROOT, check=False
    )
    if done.returncode:
        raise RuntimeError(f"{python} could not plan:\n{done.stderr}")
    return done.stdout.splitlines()


def different(ours: Sequence[str], theirs: Sequence[str]) -> list[str]:
    """Return the names of the plans that are not the same in both."""
    a, b = ({line.split("\t")[0]: line for line in lines} for lines in (ours, theirs))
    return sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))


def main() -> int:
    """Print a line for each interpreter; the exit code is 1 where a plan differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pythons", nargs="*", help="interpreters to compare with this one")
    parser.add_argument("--install", type=Path, help="folder for virtual environments that are lacking")
    given = parser.parse_args()
    if given.pythons:
        ready, bare = {version(p) or p: p for p in given.pythons}, dict[str, str]()
    else:
        ready, bare = installed([given.install] if given.install else [])
    for name, python in bare.items():
        if given.install:
            ready[name] = install(given.install.resolve(), name, python)
        else:
            print(f"Python {name} skipped: it lacks {NEEDS}, or one of them; see --install")
    ours = plans(sys.executable, 1)
    print(f"{len(ours)} plans with Python {version(sys.executable)}")
    wrong = 0
    for hashes, (name, python) in enumerate(sorted({f"{version(sys.executable)}": sys.executable, **ready}.items()), 2):
        began = time.perf_counter()
        names = different(ours, plans(python, hashes))
        wrong += len(names)
        print(f"Python {name}, hash seed {hashes}: {len(ours) - len(names)} of {len(ours)} identical, "
              f"{time.perf_counter() - began:.0f} s", flush=True)  # fmt: skip
        for different_one in names:
            print(f"  differs: {different_one}")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
