"""CPU seconds of commits that carry a run, and of asking for runs after a long history of them.

    python benchmarks/carrying.py [--components 1000] [--commits 1000] [--repeat 5]

The lab has so many polarizers, 25 a file. Each time one of them is turned on the simulated bench, and `pico commit
--capture` takes that into the manifest and the run into the commit. Then the same on a history of so many commits that
carry a run each, all in one month, and the commands that look at runs: `first` before anything was remembered. Each
other figure is the least of several whole processes, git included (user + system); `validate` reads the same lab and
does nothing else. Exit code 3 where a commit takes 1 s or more.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

from startup import measure, write_lab

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from pico.runs.files import read_runs, run_files  # noqa: E402

BAR = 1.0
PICO = str(Path(sysconfig.get_path("scripts")) / "pico")
WHO = ["-c", "user.name=A Physicist", "-c", "user.email=a@localhost"]


LONG_AGO = 1_600_000_000


def git(folder: Path, *arguments: str, feed: bytes = b"") -> str:
    """Run git long ago, and return what it says."""
    then = os.environ | {"GIT_COMMITTER_DATE": f"{LONG_AGO} +0000"}
    done = subprocess.run(["git", *WHO, *arguments], cwd=folder, input=feed, capture_output=True, check=True, env=then)
    return done.stdout.decode().strip()


def prepare(folder: Path, components: int) -> None:
    """Write the lab and commit it."""
    folder.mkdir()
    write_lab(folder, components)
    (folder / ".gitignore").write_text(".pico/\n")
    git(folder, "init", "-q", "-b", "main")
    for item in WHO[1::2]:
        git(folder, "config", *item.split("=", 1))
    git(folder, "add", ".")
    git(folder, "commit", "-qm", "the lab")


def commits_with_a_run(folder: Path, repeat: int) -> list[float]:
    """Turn a part and commit that, several times; return the seconds of each commit."""
    seconds = []
    for i in range(repeat):
        subprocess.run([PICO, "set", "c00005", f"angle={10 + i}", "--yes"], cwd=folder, check=True, capture_output=True)
        seconds.append(measure([PICO, "commit", "--capture", "-m", f"turned {i}"], folder)[0])
    return seconds


def lengthen(folder: Path, commits: int) -> None:
    """Let commits that carry a run each follow the first one: copies of the last run under names of their own."""
    root = git(folder, "rev-list", "--max-parents=0", "HEAD")
    (path,) = [p for p in git(folder, "ls-tree", "-r", "--name-only", "HEAD").splitlines() if p.endswith("run.json")][
        :1
    ]
    (document,) = read_runs({path: (folder / path).read_bytes()})
    lines = []
    for i in range(commits):
        content = json.loads((folder / path).read_text()) | {"id": f"{document.id}-{i:06}"}
        (again,) = read_runs({f"runs/2026/01/{content['id']}/run.json": json.dumps(content).encode()})
        text = f"commit refs/heads/main\ncommitter A <a@localhost> {LONG_AGO + 60 * i} +0000\ndata 3\nrun\n"
        text += f"from {root}\n" if i == 0 else ""
        files = run_files(again)
        text += "".join(f"M 100644 inline {p}\ndata {len(d)}\n{d.decode()}\n" for p, d in files.items())
        lines.append(text)
    git(folder, "fast-import", "--quiet", "--force", feed="".join(lines).encode())
    git(folder, "reset", "-q", "--hard")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--components", type=int, default=1000)
    parser.add_argument("--commits", type=int, default=1000)
    parser.add_argument("--repeat", type=int, default=5)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "lab"
        prepare(folder, options.components)
        first = min(commits_with_a_run(folder, options.repeat))
        lengthen(folder, options.commits)
        cold = measure([PICO, "runs", "list"], folder)[0]
        late = min(commits_with_a_run(folder, options.repeat))
        print(f"{options.components} components, {options.commits} commits with a run each; CPU s, least of several")
        for words in (["validate"], ["runs", "list"], ["runs", "show"], ["verify"]):
            took = min(measure([PICO, *words], folder)[0] for _ in range(options.repeat))
            print(f"  {' '.join(words):<24} {took:5.2f}")
        print(f"  runs list, first         {cold:5.2f}")
        print(f"  commit with a run        {first:5.2f}\n  after the long history   {late:5.2f}   bar {BAR}")
    sys.exit(3 if max(first, late) >= BAR else 0)


if __name__ == "__main__":
    main()
