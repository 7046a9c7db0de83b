"""New laboratories: an example with its history, the same commits everywhere, or a skeleton to edit."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error, warning
from pico.disk import disk_trouble, write_whole, writing
from pico.history.examples.replay import replay
from pico.history.examples.skeleton import SKELETON
from pico.history.git.attributes import GITATTRIBUTES
from pico.history.repository.repository import Repository
from pico.resources import labs_dir

GITIGNORE = "# what PICO keeps beside the manifests: the simulated table, the journal, locks\n.pico/\n"
_HISTORY = "history.yaml"
_AUTHOR = ("PICO example", "example@localhost")
_BEGIN = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)


def example_names() -> tuple[str, ...]:
    """Return the names of the packaged example labs, sorted."""
    return tuple(sorted(path.parent.name for path in labs_dir().glob(f"*/{_HISTORY}")))


def require_example(name: str) -> None:
    """Raise PicoError where there is no example of that name."""
    if name not in example_names():
        hint = did_you_mean(name, example_names())
        raise PicoError(error("unknown-example", f"there is no example `{name}`", hint=hint))


def make_example(name: str, folder: Path) -> Repository:
    """Make a Git repository in `folder` with the history of an example lab, checked out, and return it.

    Author, dates and therefore commit ids are the same everywhere; nobody's identity is needed. Raises PicoError for
    an unknown name, and where `folder` exists and is not empty.
    """
    import yaml

    require_example(name)
    if _make_folder(folder):
        raise PicoError(error("exists", f"{folder} is not empty", hint="name a new folder, or an empty one"))
    source = labs_dir() / name
    history = yaml.safe_load((source / _HISTORY).read_text(encoding="utf-8"))
    with _all_or_nothing(folder):
        repository = Repository.init(folder)
        ids: dict[str, str] = {}
        refs: dict[str, str] = {}
        for number, step in enumerate(replay(history["commits"], _files(source))):
            parents = [ids[step.follows]] if step.follows else []
            time = _BEGIN + timedelta(hours=number)
            ids[step.tag] = repository.write_commit(step.files, step.message, parents, author=_AUTHOR, time=time)
            refs |= {f"refs/tags/{step.tag}": ids[step.tag], f"refs/heads/{step.branch}": ids[step.tag]}
        repository.write_refs(refs, head=history["head"])
    return repository


def nested(folder: Path) -> tuple[Diagnostic, ...]:
    """Return a warning where a new repository in `folder` would lie inside another one, which does not ignore it."""
    above = next((p for p in folder.absolute().parents if p.is_dir()), None)
    around = Repository.discover(above) if above else None
    if around is None or around.ignores(folder.resolve()):
        return ()
    text = f"{folder} is its own repository inside {around.root}, which would keep a link to it and not its files"
    hint = f"make it outside of that folder, or leave it out there: add `{folder.resolve().name}/` to .gitignore"
    return (warning("nested", text, hint=hint),)


def init_empty(folder: Path) -> Repository:
    """Write the skeleton of a lab into `folder`, inside a new Git repository unless it lies in one, and return that.

    Nothing is committed. Raises PicoError where a file would be overwritten.
    """
    name = re.sub(r"[^a-z0-9_]+", "_", folder.resolve().name.lower()).strip("_0123456789") or "lab"
    for path in SKELETON:
        if (folder / path).exists():
            hint = "choose another folder, or edit what is there"
            raise PicoError(error("exists", f"{folder / path} exists already", hint=hint))
    _make_folder(folder)
    beside = {".gitignore": GITIGNORE, ".gitattributes": GITATTRIBUTES}
    missing = {path: text for path, text in beside.items() if not (folder / path).exists()}
    with _all_or_nothing(folder):
        repository = Repository.discover(folder) or Repository.init(folder)
        for path, text in (SKELETON | missing).items():
            write_whole(folder / path, text.replace("NAME", name).encode(), folders=True)
    return repository


@contextmanager
def _all_or_nothing(folder: Path) -> Iterator[None]:
    """Take away what was made in a folder where not all of it could be, as on a full disk; the same call then works."""
    before = set(folder.iterdir())
    try:
        with disk_trouble(folder, "no lab was made"):
            yield
    except BaseException:
        for path in set(folder.iterdir()) - before:
            with suppress(OSError):
                shutil.rmtree(path) if path.is_dir() else path.unlink()
        raise


def _make_folder(folder: Path) -> list[Path]:
    """Make a folder where there is none, and return what it holds."""
    with writing(folder, what=f"can't make the folder {folder}", code="folder"):
        folder.mkdir(parents=True, exist_ok=True)
        return list(folder.iterdir())


def _files(source: Path) -> dict[str, bytes]:
    """Return the files of an example lab by path, as they are at HEAD of its repository."""
    found = {p.relative_to(source).as_posix(): p.read_bytes() for p in sorted(source.rglob("*")) if p.is_file()}
    del found[_HISTORY]
    return found | {".gitignore": GITIGNORE.encode(), ".gitattributes": GITATTRIBUTES.encode()}
