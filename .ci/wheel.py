"""Build the wheel, install it into an empty environment and use it in an empty folder, outside the repository; the page
in the browser, too, with no Node to be found."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import urllib.request
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


def page(pico: Path, lab: Path) -> None:
    """Open the page as somebody does who has no Node, and stop where one of its files is not served."""
    env = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
    own = {"XDG_CONFIG_HOME": str(lab / "../config"), "XDG_STATE_HOME": str(lab / "../state"), "PATH": _without_node()}
    serving = subprocess.Popen(
        [pico, "--json", "gui", "--no-open"], cwd=lab, env=env | own, text=True, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, start_new_session=True,
    )  # fmt: skip
    assert serving.stdout is not None and serving.stderr is not None
    try:
        line = serving.stdout.readline()
        if not line:
            sys.exit(f"pico gui told no address\n{serving.stderr.read()}")
        origin = json.loads(line)["address"].partition("/#")[0]
        names = re.findall(r'(?:src|href)="(/[^"]+)"', _read(f"{origin}/").decode())
        sizes = {name: len(_read(f"{origin}{name}")) for name in names}
    finally:
        serving.send_signal(signal.SIGTERM)
        serving.communicate(timeout=60)
    if serving.returncode or not {".js", ".css"} <= {Path(name).suffix for name in names} or not all(sizes.values()):
        sys.exit(f"pico gui ended with {serving.returncode}, and served {sizes}")
    print(f"  pico gui: served {len(names)} files of the page, without Node")


def _read(address: str) -> bytes:
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    with opener.open(address, timeout=30) as answer:
        found: bytes = answer.read()
    return found


def _without_node() -> str:
    """Return the folders of programs in which there is no Node, with one that has git alone."""
    folders = [one for one in os.environ["PATH"].split(os.pathsep) if not (Path(one) / "node").exists()]
    if not shutil.which("git", path=os.pathsep.join(folders)):
        beside = Path(tempfile.mkdtemp())
        (beside / "git").symlink_to(str(shutil.which("git")))
        folders.append(str(beside))
    return os.pathsep.join(folders)


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
        run(python, "-m", "pip", "install", "--quiet", "-c", ROOT / "constraints.txt", f"{wheel}[gui]", cwd=folder)
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
        page(pico, lab)
    clean()
    print("The wheel works outside the repository.")


if __name__ == "__main__":
    main()
