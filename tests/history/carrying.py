"""A bench whose commits carry runs, for tests: the case study, moved by kinematics, and plain git around it."""

from __future__ import annotations

import subprocess
from pathlib import Path

from pico.bench.bench import Bench
from pico.history.lab.folder import LabFolder
from pico.history.repository.repository import Repository
from pico.history.runs import standing_of, unrecorded
from pico.history.runs.committed import places_in_history
from pico.history.runs.proof import Standings
from pico.model.trace.expectation import Standing
from pico.model.trace.report import Committed
from pico.model.trace.run import Run
from pico.places.bench import BenchPlace


def git(folder: Path, *arguments: str, code: int = 0) -> str:
    """Run git in a folder and return what it says."""
    done = subprocess.run(["git", *arguments], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout.strip()


def turn(folder: Path, component: str, angle: float) -> str:
    """Turn a polarizer in its mount, and return the id of the run."""
    with Bench.open(folder) as bench:
        return bench.apply(bench.single(component, "set", angle=angle)).run


def commit(folder: Path, message: str, mode: str = "capture") -> Committed:
    """Commit what stands on the bench."""
    with Bench.open(folder) as bench:
        return bench.commit(message, mode=mode)  # type: ignore[arg-type]


def turned(folder: Path, component: str, angle: float) -> tuple[str, str]:
    """Turn a polarizer and commit that; return the run and the commit."""
    run = turn(folder, component, angle)
    return run, commit(folder, f"{component} at {angle}").commit


def write(folder: Path, component: str, angle: float) -> None:
    """Change the angle of a polarizer in the manifest, with an editor."""
    from pico.manifest.edit import set_values

    path = folder / "state" / "table.yaml"
    path.write_text(set_values(path.read_text(), {component: {"angle": angle}}))


def apply(folder: Path, goal: str | None = None) -> str:
    """Apply a revision, or the manifest, and return the id of the run."""
    with Bench.open(folder) as bench:
        report = bench.apply(goal)
        assert report.outcome == "done"
        return report.run


def standing(folder: Path, revision: str = "HEAD") -> Standing:
    """Return the standing of a revision by what commits hold, without what the bench alone knows."""
    lab = LabFolder(folder, place=BenchPlace(folder, "sim"))
    return Standings(lab).of(lab.history().resolve(revision))


def standing_here(folder: Path, revision: str | None = None) -> Standing:
    """Return the standing as `pico verify` tells it, with what the bench alone knows."""
    found = standing_of(LabFolder(folder, place=BenchPlace(folder, "sim")), revision)
    assert found is not None
    return found


def carried(folder: Path) -> dict[str, str]:
    """Return the runs in the history of all refs, each with the oldest commit that has it."""
    repository = Repository.discover(folder)
    assert repository is not None
    return {name: place.commit for name, place in places_in_history(repository, folder).items()}


def own(folder: Path) -> list[Run]:
    """Return the runs that no commit has yet."""
    return [run.document for run in unrecorded(LabFolder(folder, place=BenchPlace(folder, "sim")))]


def files_of(folder: Path, run: str, revision: str = "HEAD") -> list[str]:
    """Return the files of a run at a revision."""
    listed = git(folder, "ls-tree", "-r", "--name-only", revision).splitlines()
    return [path for path in listed if run in path]
