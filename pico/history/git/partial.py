"""Partial clones (`git clone --filter=...`): what libgit2 misses is fetched through `git`, many objects at once."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pico.diagnostics import PicoError, error
from pico.history.git import command as git
from pico.manifest.file_names import is_manifest
from pico.manifest.files import MAX_LEVELS

CODE = "partial-clone"
_EXTENSION = "partialclone"
_RUN = re.compile(r"(?:.*/)?runs/\d{4}/\d{2}/[^/]+/run\.json")
_NOTE = re.compile(r"(?:.*/)?notes/[^/]+\.md")
# What a fetch would run, or let run: by the repository's own configuration that is the user's to allow.
_PROGRAMS = (
    r"^(core\.(sshcommand|gitproxy|askpass|alternaterefscommand)|credential\..*|protocol\..*"
    r"|remote\..*\.(uploadpack|vcs))$"
)
_FETCHING = {"GIT_ALLOW_PROTOCOL": "file:git:http:https:ssh"}


def open_handle(path: Path | str) -> Any:
    """Return the repository at `path` as libgit2 holds it, which fetches what a partial clone lacks when it is read.

    Raises pygit2.GitError, KeyError or ValueError for what libgit2 can't open.
    """
    import pygit2

    try:
        handle = pygit2.Repository(str(path))
    except pygit2.GitError as exc:
        if f"extensions.{_EXTENSION}" not in str(exc):
            raise
        pygit2.settings.set_extensions([_EXTENSION])  # it only says that objects may be missing
        handle = pygit2.Repository(str(path))
    if remote := promisor(handle):
        _attach(handle, remote)
    return handle


def promisor(handle: Any) -> str:
    """Return the remote that has what a partial clone lacks; empty for a clone that is not partial."""
    found = ""
    for entry in handle.config:
        name = entry.name.lower()
        if name.startswith("remote.") and name.endswith(".promisor") and entry.value.lower() in ("true", "1", "yes"):
            found = found or entry.name[len("remote.") : -len(".promisor")]
        elif name == f"extensions.{_EXTENSION}":
            found = entry.value
    return found


def complete(handle: Any, *, documents: bool = False) -> None:
    """Fetch the folders that a partial clone lacks of the commits of every ref, and with `documents` their manifests,
    notes and documents of runs: for git commands that read these with the network off. Raises PicoError."""
    if remote := promisor(handle):
        objects = Objects(handle, remote)
        objects.fetch_trees()
        if documents:
            objects.fetch_documents()


@dataclass
class Lacking:
    """What a partial clone lacks, by ids."""

    # Folders of commits; what lies in them is not known.
    trees: list[str] = field(default_factory=list)
    # Files, each with those beside it in its folder that are lacking, too.
    files: dict[str, Collection[str]] = field(default_factory=dict)
    # Those of the files that are manifests, notes and documents of runs.
    documents: set[str] = field(default_factory=set)


def require_fetched(cause: PicoError) -> None:
    """Raise a PicoError again that says that a partial clone lacks something: nothing is known of what it lacks."""
    if any(d.code == CODE for d in cause.diagnostics):
        raise cause


class Objects:
    """Objects of a partial clone by their ids, fetched from its remote if they are not here."""

    def __init__(self, handle: Any, remote: str) -> None:
        self.remote = remote
        self.root = Path(handle.workdir or handle.path)
        self._path = handle.path
        self._refused: PicoError | None = None
        self._here: Any = None
        self._lacking: Lacking | None = None

    @property
    def here(self) -> Any:
        """The clone as it is, without what could be fetched."""
        import pygit2

        if self._here is None:
            self._here = pygit2.Repository(self._path)
        return self._here

    def read(self, name: Any) -> tuple[int, bytes]:
        """Return type and content of an object; raises PicoError if it can't be fetched, KeyError for one that no
        commit here holds."""
        if name not in self.here:
            self.fetch_trees()
        if name not in self.here:
            self.fetch_documents(str(name))
        found: tuple[int, bytes] = self.here.read(name)
        return found

    def fetch_trees(self) -> None:
        """Fetch the folders of all commits that refs reach, with those below; raises PicoError."""
        while self.lacking.trees:
            self._fetch(self.lacking.trees)
            self._lacking = None

    def fetch_documents(self, also: str = "") -> None:
        """Fetch the manifests, notes and documents of runs of all commits that refs reach, and of an object `also`
        what lies beside it in its folder; raises PicoError, KeyError if no commit here holds it."""
        beside = self.lacking.files[also] if also else ()
        wanted = self.lacking.documents | set(beside)
        self._fetch(sorted(name for name in wanted if name not in self.here))

    @property
    def lacking(self) -> Lacking:
        """What commits hold and this clone did not have when it was looked for."""
        if self._lacking is None:
            found = Lacking()
            seen: set[str] = set()
            for commit in self._commits():
                self._look(str(commit.tree_id), "", found, seen)
            self._lacking = found
        return self._lacking

    def _commits(self) -> Iterator[Any]:
        """Yield the commits that HEAD and the refs reach; of a shallow clone those that are here."""
        import pygit2

        walker = self.here.walk(None)
        tips = [name for name in self.here.references if not name.endswith("/HEAD")]
        for name in (*tips, *(() if self.here.head_is_unborn else ("HEAD",))):
            with suppress(KeyError, ValueError, pygit2.GitError):
                walker.push(self.here.references[name].peel(pygit2.Commit).id)
        return iter(walker)

    def _look(self, tree: str, at: str, found: Lacking, seen: set[str], level: int = 0) -> None:
        """Add to `found` what this clone lacks of a folder, and of those below it."""
        from pygit2.enums import FileMode

        if tree in seen or level > MAX_LEVELS:
            return
        seen.add(tree)
        if tree not in self.here:
            found.trees.append(tree)
            return
        files: dict[str, str] = {}
        for entry in self.here[tree]:
            if entry.filemode == FileMode.TREE:
                self._look(str(entry.id), f"{at}{entry.name}/", found, seen, level + 1)
            elif entry.filemode != FileMode.COMMIT and entry.id not in self.here:
                files[str(entry.id)] = f"{at}{entry.name}"
        for name, path in files.items():
            found.files[name] = files.keys()
            if is_manifest(path) or _NOTE.fullmatch(path) or _RUN.fullmatch(path):
                found.documents.add(name)

    def _fetch(self, names: Iterable[str]) -> None:
        """Fetch objects as git itself does for a partial clone, all in one go; raises PicoError."""
        wanted = list(names)
        if not wanted:
            return
        if self._refused is None:
            try:
                self._require_plain()
                arguments = [
                    "-c", "fetch.negotiationAlgorithm=noop", "fetch", self.remote, "--no-tags", "--no-write-fetch-head",
                    "--no-recurse-submodules", "--no-auto-maintenance", "--quiet", "--filter=blob:none", "--stdin",
                ]  # fmt: skip
                stdin = "".join(f"{name}\n" for name in wanted)
                git.run(self.root, arguments, doing="fetch them", stdin=stdin, extra=_FETCHING)
                self._here = None
                return
            except PicoError as exc:
                self._refused = self._partial(len(wanted), exc)
        raise self._refused

    def _require_plain(self) -> None:
        """Raise PicoError if the repository's own configuration names programs that a fetch would run."""
        asked = ["config", "--show-scope", "--name-only", "-z", "--get-regexp", _PROGRAMS]
        words = git.run(self.root, asked, doing="read its configuration", ends=(0, 1)).split("\0")
        own = [name for scope, name in zip(words[::2], words[1::2], strict=False) if scope in ("local", "worktree")]
        if own:
            text = f"its own configuration says what a fetch runs ({own[0]})"
            raise PicoError(error("git", text))

    def _partial(self, count: int, cause: PicoError) -> PicoError:
        """Return that the clone is partial, and how to complete it."""
        first = cause.diagnostics[0]
        what = "1 object of its history is" if count == 1 else f"{count} objects of its history are"
        text = f"this clone is partial: {what} not here, and PICO could not fetch them from {self.remote}"
        hint = f"once {self.remote} can be reached, `{_completing(self.root, self.remote)}` completes the clone"
        return PicoError(error(CODE, text, detail=first.detail or first.summary, hint=hint))


def _completing(root: Path, remote: str) -> str:
    """Return the command that fetches all that a partial clone lacks, for the git that is installed."""
    found = re.search(r"(\d+)\.(\d+)", git.answer(root, ["version"]))
    if found and (int(found[1]), int(found[2])) < (2, 36):
        return f"git clone --no-filter $(git remote get-url {remote}) DIR"
    return f"git fetch --refetch --no-filter {remote}"


def _attach(handle: Any, remote: str) -> None:
    """Let a handle of a partial clone ask its remote for objects that it does not have."""
    import pygit2

    objects = Objects(handle, remote)

    def header(backend: Any, name: Any) -> tuple[int, int]:
        kind, data = objects.read(name)
        return kind, len(data)

    def whole(backend: Any, name: str) -> tuple[int, bytes, Any]:
        if len(name) < 40:  # all commits are here, and nothing else is asked for by the beginning of its id
            raise KeyError(name)
        return *objects.read(name), pygit2.Oid(hex=name)

    def unknown(backend: Any, name: str) -> Any:
        raise KeyError(name)

    answers = {
        "read_cb": lambda backend, name: objects.read(name),
        "read_header_cb": header,
        "read_prefix_cb": whole,
        "exists_cb": lambda backend, name: False,  # who asks whether an object is here does not want it fetched
        "exists_prefix_cb": unknown,
        "refresh_cb": lambda backend: None,  # what is fetched is read at once
    }
    promised = type("Promised", (pygit2.OdbBackend,), answers)()
    handle.odb.add_backend(promised, 1)
    handle.promised = promised  # libgit2 holds no reference to it
