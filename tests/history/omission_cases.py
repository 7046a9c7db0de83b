"""Ways in which a manifest that was committed is not read, in the working tree and at a revision; and ways of working
that leave nothing out."""

from __future__ import annotations

import os
import pickle
import random
import shutil
import stat
import subprocess
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import pygit2

from pico.diagnostics import Diagnostic, PicoError
from pico.history.lab.folder import LabFolder
from pico.model.state import LabState

UNITS = ("top.yaml", "optics/lenses.yaml", "state/table.yaml", "deep/er/camera.yaml")
"""The files of the state, each with a part of its own, and each but the first in a folder of its own."""
NOBODY = 65534
_LAB = """apiVersion: pico/v1
kind: Lab
metadata: {name: small}
table: {size: [2000, 1000], beam_height: 70}
robots: {arm1: {model: gantry, mount: {x: 0, y: 0}}}
slots: {s0: {x: 100, y: 100}, s1: {x: 300, y: 100}, s2: {x: 500, y: 100}, s3: {x: 700, y: 100}, s4: {x: 900, y: 100}}
inventory:
  p0: {type: linear_polarizer, marker: 0, home: s0}
  p1: {type: linear_polarizer, marker: 1, home: s1}
  p2: {type: linear_polarizer, marker: 2, home: s2}
  p3: {type: linear_polarizer, marker: 3, home: s3}
  p4: {type: linear_polarizer, marker: 4, home: s4}
"""
_STATE = """apiVersion: pico/v1
kind: LabState
metadata: {{lab: small}}
components:
  p{0}:
    pose: {{x: {1}, y: 500, yaw: 0}}
"""


class Box:
    """A folder in which labs are made by plain git, `lab` always the last one."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.lab = folder, folder / "lab"
        self.env = os.environ | {f"GIT_CONFIG_{scope}": os.devnull for scope in ("GLOBAL", "SYSTEM")}
        self.env |= {f"GIT_{who}_NAME": "A Physicist" for who in ("AUTHOR", "COMMITTER")}
        self.env |= {f"GIT_{who}_EMAIL": "physicist@localhost" for who in ("AUTHOR", "COMMITTER")}
        self._make(folder / "plain")
        shutil.copytree(folder / "plain", folder / "with", symlinks=True)
        self._add_submodules(folder / "with")

    def git(self, *words: str, at: Path | None = None) -> str:
        command = ["git", "-c", "protocol.file.allow=always", *words]
        done = subprocess.run(command, cwd=at or self.lab, env=self.env, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    @property
    def binds(self) -> bool:
        """Whether permissions can be tried: they don't bind root, and nobody must be able to come here."""
        folders = (self.folder, *self.folder.parents)
        return os.geteuid() != 0 or all(folder.stat().st_mode & stat.S_IXOTH for folder in folders)

    def commit(self, at: Path | None = None) -> None:
        self.git("add", "-A", at=at)
        self.git("commit", "-qm", "another state", at=at)

    def begin(self, *, modules: bool) -> None:
        """Make the lab anew, its manifests in its own repository or (all but the first) in submodules."""
        for name in ("lab", "away"):
            shutil.rmtree(self.folder / name, ignore_errors=True)
        (self.folder / "away").mkdir()
        shutil.copytree(self.folder / ("with" if modules else "plain"), self.lab, symlinks=True)
        self.git("update-index", "-q", "--refresh")  # or sparse checkout takes the copies for edited

    def _make(self, root: Path) -> None:
        root.mkdir()
        self.git("init", "-qb", "main", at=root)
        (root / "lab.yaml").write_text(_LAB)
        for number, unit in enumerate(UNITS):
            (root / unit).parent.mkdir(parents=True, exist_ok=True)
            (root / unit).write_text(_STATE.format(number, 200 * number + 200))
        (root / ".gitignore").write_text(".pico/\n")
        self.commit(root)

    def _add_submodules(self, root: Path) -> None:
        for unit in UNITS[1:]:
            top = unit.partition("/")[0]
            source = self.folder / f"{top}.source"
            shutil.copytree(root / top, source)
            self.git("init", "-qb", "main", at=source)
            self.commit(source)
            self.git("rm", "-rq", top, at=root)
            self.git("commit", "-qm", f"without {top}", at=root)
            self.git("submodule", "--quiet", "add", str(source), top, at=root)
            self.commit(root)


Omit = Callable[[Box, str, random.Random], None]


def _target(unit: str, rng: random.Random) -> str:
    """Return the file of a unit, or a folder above it."""
    path = Path(unit)
    return str(rng.choice([path, *(p for p in path.parents if p != Path())]))


def sparse(box: Box, unit: str, rng: random.Random) -> None:
    """Sparse checkout without this file: in patterns, or in a cone, whose index may be sparse, too."""
    tops = {u.partition("/")[0] for u in UNITS[1:]} - {unit.partition("/")[0]}
    if "/" in unit and rng.random() < 0.5 and not box.git("ls-files", "-t", *UNITS).count("S "):
        box.git("sparse-checkout", "set", "--cone", *rng.choice([[], ["--sparse-index"]]), *sorted(tops))
    else:
        box.git("update-index", "--skip-worktree", unit)
        (box.lab / unit).unlink()


def assumed(box: Box, unit: str, rng: random.Random) -> None:
    """A file that git takes for unchanged is deleted."""
    box.git("update-index", "--assume-unchanged", unit)
    (box.lab / unit).unlink()


def renamed(box: Box, unit: str, rng: random.Random) -> None:
    """Another extension, or the same in other letters."""
    path = box.lab / unit
    path.rename(path.with_suffix(rng.choice([".yml", ".YML", ".YAML", ".Yaml", ".yMl"])))


def aside(box: Box, unit: str, rng: random.Random) -> None:
    """A name that no manifest has, a hidden one, or a folder with a dot."""
    path = box.lab / unit
    names = [f"{path.name}{end}" for end in (".bak", "~", ".orig", " ", ".txt", ".json")]
    hidden = [f".{path.name}", f".x/{path.name}", f".x/.{path.stem}", f".x/{path.stem}.yml", path.stem]
    _rename(path, rng.choice([*names, *hidden, f"{path.stem}.bak", f"#{path.name}#"]))


def in_runs(box: Box, unit: str, rng: random.Random) -> None:
    """A folder that is left out, for it holds data, or a name that says nothing."""
    path = box.lab / unit
    _rename(path, rng.choice([f"runs/{path.name}", f"runs/.{path.stem}", f"{path.stem}.json", f"{path.stem}.txt"]))


def _rename(path: Path, name: str) -> None:
    goal = path.parent / name
    goal.parent.mkdir(exist_ok=True)
    path.rename(goal)


def linked(box: Box, unit: str, rng: random.Random) -> None:
    """A link in place of the file or its folder: to outside, to a folder that is left out, by another link; or the
    folder that it led to is gone."""
    path = box.lab / _target(unit, rng)
    home = box.folder / "away" if rng.random() < 0.7 else box.lab / f".{unit.partition('/')[0]}"
    home.mkdir(exist_ok=True)
    goal = home / f"{path.name}-{unit.replace('/', '-')}"
    if path.suffix:
        goal = goal.with_suffix(rng.choice([".yaml", ".yml", ".txt"]))
    path.rename(goal)
    if rng.random() < 0.3:
        (home / f"to-{goal.name}").symlink_to(goal)
        path.symlink_to(home / f"to-{goal.name}")
    else:
        path.symlink_to(goal if rng.random() < 0.5 else os.path.relpath(goal, path.parent))
    if rng.random() < 0.3:
        shutil.rmtree(goal) if goal.is_dir() else goal.unlink()


def elsewhere(box: Box, unit: str, rng: random.Random) -> None:
    """What stands in the file is a pointer of Git LFS, or what git-crypt made of it."""
    pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:%s\nsize 120\n" % (b"0" * 64)
    (box.lab / unit).write_bytes(rng.choice([pointer, b"\0GITCRYPT\0" + rng.randbytes(80)]))


def shut(box: Box, unit: str, rng: random.Random) -> None:
    """Nobody may read the file, or a folder above it; or list the folder, or enter it."""
    path = box.lab / _target(unit, rng)
    path.chmod(rng.choice([0o000, 0o111, 0o444]) if path.is_dir() else 0)


def unfetched(box: Box, unit: str, rng: random.Random) -> None:
    """A submodule that is not checked out; in a fresh clone its content was never fetched."""
    top = unit.partition("/")[0]
    box.git("submodule", "--quiet", "deinit", "--force", top)
    if rng.random() < 0.5:
        shutil.rmtree(box.lab / ".git" / "modules" / top)
    if rng.random() < 0.3:
        (box.lab / top).rmdir()


def never_fetched(box: Box, unit: str, rng: random.Random) -> None:
    """A submodule of which nothing is in this clone, as at a revision only that counts."""
    unfetched(box, unit, rng)
    shutil.rmtree(box.lab / ".git" / "modules" / unit.partition("/")[0], ignore_errors=True)


def changed(box: Box, unit: str, rng: random.Random) -> None:
    """Text alone: the file is another object than before."""
    (box.lab / unit).write_text((box.lab / unit).read_text() + f"# {rng.random()}\n")


@dataclass(frozen=True)
class Kind:
    """A way to leave a manifest out. `edit`: it can be committed; `bound`: only who is not root is kept out. `lost`:
    its object is missing from the repository."""

    omit: Omit
    edit: bool = False
    modules: bool = False
    bound: bool = False
    lost: bool = False


IN_FOLDER = {
    "sparse": Kind(sparse), "assumed": Kind(assumed), "extension": Kind(renamed, edit=True),
    "aside": Kind(aside, edit=True), "in runs": Kind(in_runs), "link": Kind(linked, edit=True),
    "elsewhere": Kind(elsewhere, edit=True),
    "permission": Kind(shut, bound=True),
    "submodule": Kind(unfetched, modules=True),
}  # fmt: skip
AT_REVISION = {
    "extension": Kind(renamed), "aside": Kind(aside), "link": Kind(linked),
    "elsewhere": Kind(elsewhere), "damaged": Kind(changed, lost=True),
    "submodule": Kind(never_fetched, modules=True),
}  # fmt: skip


@dataclass(frozen=True)
class Outcome:
    """What came of a case: which units were left out of `kinds`, what was read and what was said."""

    what: str
    units: tuple[str, ...]
    state: frozenset[str] | None
    said: tuple[Diagnostic, ...]

    @property
    def silent(self) -> tuple[str, ...]:
        """The units that were left out, without an error that names the file, a folder above it, or its part."""
        if self.state is not None:
            return tuple(u for u in self.units if f"p{UNITS.index(u)}" not in self.state)
        errors = " ".join(d.summary for d in self.said if d.severity == "error")
        return tuple(u for u in self.units if not any(name in errors for name in _names(u)))


def _names(unit: str) -> tuple[str, ...]:
    path = Path(unit)
    part = f"a state with p{UNITS.index(unit)} that is not read"
    return (part, str(path.with_suffix("")), *(f"{p}:" for p in map(str, path.parents) if p != "."))


def in_folder(box: Box, seed: int, kinds: tuple[str, ...]) -> Outcome:
    """Leave a unit out of the working tree in each of some ways that go together, and read the lab."""
    rng = random.Random(seed)
    chosen = [IN_FOLDER[name] for name in kinds]
    units = _left_out(box, rng, chosen)
    if all(kind.edit for kind in chosen) and rng.random() < 0.5:
        box.commit()
    read = _read_bound if any(k.bound for k in chosen) else read_lab
    return replace(read(box.lab), what=" and ".join(kinds), units=units)


def at_revision(box: Box, seed: int, kinds: tuple[str, ...]) -> Outcome:
    """Commit a state in which units are left out, go back to the whole one, and read the commit."""
    chosen = [AT_REVISION[name] for name in kinds]
    units = _left_out(box, random.Random(seed), chosen)
    if not any(k.modules for k in chosen):
        (box.lab / "README").write_text("another state\n")
        box.commit()
    for unit in (unit for kind, unit in zip(chosen, units, strict=True) if kind.lost):
        name = box.git("rev-parse", f"HEAD:{unit}").strip()
        (box.lab / ".git" / "objects" / name[:2] / name[2:]).unlink()
    box.git("tag", "there")
    if not any(k.modules for k in chosen):
        box.git("checkout", "-qf", "HEAD~1")
    return replace(read_lab(box.lab, "there"), what=" and ".join(kinds), units=units)


def _left_out(box: Box, rng: random.Random, kinds: list[Kind]) -> tuple[str, ...]:
    """Make the lab anew, leave out a unit in each of some ways, and return the units."""
    modules = any(kind.modules for kind in kinds)
    box.begin(modules=modules)
    units = tuple(rng.sample(UNITS[1:] if modules else UNITS, len(kinds)))
    for kind, unit in zip(kinds, units, strict=True):
        kind.omit(box, unit, rng)
    return units


def read_lab(root: Path, revision: str | None = None) -> Outcome:
    """Return the parts that the lab's state names, None where reading it is refused, and what is said."""
    try:
        if revision:
            bench = LabFolder(root, history=True)
            manifests = bench.manifests_at(revision)
        else:
            manifests = LabFolder(root).manifests
        state: LabState = manifests.require()[1]
    except PicoError as exc:
        return Outcome("", (), None, tuple(exc.diagnostics))
    return Outcome("", (), frozenset(state.components), manifests.diagnostics)


def _read_bound(root: Path) -> Outcome:
    """Read the lab as somebody whom permissions bind: for root, in a process that is nobody's."""
    if os.geteuid() != 0:
        return read_lab(root)
    read_lab(root)  # imports what nobody may not be allowed to
    for folder, _, names in os.walk(root):
        for path in (Path(folder), *(Path(folder) / n for n in names)):
            os.chown(path, NOBODY, NOBODY, follow_symlinks=False)
    there, here = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            pygit2.settings.search_path[pygit2.enums.ConfigLevel.GLOBAL] = str(
                root.parent
            )  # root's own is not nobody's
            os.setgroups([])
            os.setgid(NOBODY)
            os.setuid(NOBODY)
            os.write(here, pickle.dumps(read_lab(root)))
        finally:
            os._exit(0)
    os.close(here)
    with os.fdopen(there, "rb") as told:
        data = told.read()
    os.waitpid(child, 0)
    found: Outcome = pickle.loads(data)
    return found


def _compose(box: Box) -> None:
    (box.lab / "docker-compose.yml").write_text("services: {db: {image: postgres}}\n")
    (box.lab / "pipeline.yml").write_text("script: |\n  cat > lab.yaml <<END\n  apiVersion: pico/v1\n  END\n")


def _data(box: Box) -> None:
    (box.folder / "away" / "2026").mkdir()
    (box.folder / "away" / "2026" / "settings.yaml").write_text("gain: 3\n")
    (box.lab / "data").symlink_to(box.folder / "away")


def _copies(box: Box) -> None:
    shutil.copytree(box.lab / "state", box.lab / ".backup", symlinks=True, dirs_exist_ok=True)
    shutil.copytree(box.lab / "state", box.lab / "runs" / "2026", symlinks=True)
    (box.lab / "optics" / ".#lenses.yaml").symlink_to("somebody@host.123")


def _aliases(box: Box) -> None:
    (box.lab / "latest").symlink_to("state")
    (box.lab / "state" / "up").symlink_to("..")
    (box.lab / "image.tiff").symlink_to("/nowhere/image.tiff")


def _moved(box: Box) -> None:
    box.git("mv", "optics/lenses.yaml", "state/lenses.yaml")


def _backups(box: Box) -> None:
    """States with p4, which is at home: copies of manifests that are read, states of another lab, and no manifests."""
    state = _STATE.format(4, 1000)
    for name in ("top.yaml~", ".top.yaml.swp", ".backup/top.yaml", ".other/lab.yaml", ".other/top.yaml.bak"):
        (box.lab / name).parent.mkdir(exist_ok=True)
        (box.lab / name).write_text(state)
    (box.lab / "README").write_text(f"# The lab\n\n```yaml\n{state}```\n")
    (box.lab / "template").write_text(state.replace("lab: small", "lab: large"))


def _deleted(box: Box) -> None:
    (box.lab / UNITS[1]).unlink()


def _removed(box: Box) -> None:
    box.git("rm", "-q", UNITS[1])


def _emptied(box: Box) -> None:
    """Cut off behind `components:`."""
    path = box.lab / UNITS[1]
    path.write_text(path.read_text().partition("  p1")[0])


def _emptied_json(box: Box) -> None:
    (box.lab / UNITS[1]).write_text(
        '{"apiVersion": "pico/v1", "kind": "LabState", "metadata": {"lab": "small"}, "components": {}}\n'
    )


def _unwanted(box: Box) -> None:
    box.git("update-index", "--skip-worktree", UNITS[1])
    (box.lab / UNITS[1]).unlink()
    box.git("rm", "-q", "--cached", "--sparse", UNITS[1])


def _with_another_lab(box: Box) -> None:
    box.git("worktree", "add", "-q", "--detach", ".trees/other")
    other, kept = box.lab / ".trees" / "other", box.lab / ".backup"
    shutil.copytree(other, kept, ignore=shutil.ignore_patterns(".git"), dirs_exist_ok=True)
    (box.lab / UNITS[1]).unlink()


WORKING = (_compose, _data, _copies, _aliases, _moved, _backups)
"""Ways of working that leave nothing out."""
DELETING = (_deleted, _removed, _emptied, _emptied_json, _unwanted, _with_another_lab)
"""Ways to say that the parts of a file are not wanted on the table."""
