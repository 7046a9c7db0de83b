"""Build the wheel, install it into an empty environment and use it in an empty folder, outside the repository."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def run(*command: str | Path, cwd: Path, expect: int = 0) -> None:
    """Run a command and stop with its output where it ends with anything but `expect`."""
    env = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
    words = [str(c) for c in command]
    done = subprocess.run(words, cwd=cwd, env=env, text=True, capture_output=True, check=False)
    shown = " ".join(Path(str(c)).name if i == 0 else str(c) for i, c in enumerate(command))
    print(f"  {shown}: exit {done.returncode}", flush=True)
    if done.returncode != expect:
        sys.exit(f"{shown} ended with {done.returncode}, expected {expect}\n{done.stdout}{done.stderr}")


def clean() -> None:
    """Remove what a build leaves in the tree: metadata there is found before that of what is installed."""
    for left in (ROOT / "build", *ROOT.glob("*.egg-info")):
        shutil.rmtree(left, ignore_errors=True)


def main() -> None:
    clean()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        build = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", folder / "dist", ROOT]
        run(*build, cwd=folder)
        venv.create(folder / "env", with_pip=True)
        python, pico = folder / "env/bin/python", folder / "env/bin/pico"
        (wheel,) = (folder / "dist").glob("*.whl")
        run(python, "-m", "pip", "install", "--quiet", "-c", ROOT / "constraints.txt", wheel, cwd=folder)
        work = folder / "work"
        work.mkdir()
        run(pico, "init", "--example", "shel", "d", cwd=work)
        lab = work / "d"
        run(pico, "plan", "e1", "--detailed-exitcode", cwd=lab, expect=2)
        run(pico, "apply", "e1", "--auto-approve", cwd=lab)
        run(pico, "plan", "e1", "--detailed-exitcode", cwd=lab)
        run(pico, "sim", "nudge", "p2", "--dx", "5", cwd=lab)
        run(pico, "plan", "e1", "--detailed-exitcode", cwd=lab, expect=2)
        run(pico, "validate", cwd=lab)
        run(pico, "render", "--out", "bench.png", cwd=lab)
        for example in ("minimal", "crowded"):
            run(pico, "init", "--example", example, example, cwd=work)
            run(pico, "validate", cwd=work / example)
    clean()
    print("The wheel works outside the repository.")


if __name__ == "__main__":
    main()
