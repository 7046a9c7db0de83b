"""A Git repository that holds a lab: read a state at any revision without checking it out; commit, check out, name."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import datetime, timedelta, timezone
from pathlib import Path
from typing import Any

from pico.base import clock
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.disk import disk_trouble
from pico.history.git import command as git
from pico.history.git.commit import Commit, Head
from pico.history.git.lanes import topological
from pico.history.git.partial import complete, open_handle
from pico.history.git.revisions import BRANCHES, TAGS, branch_for, find, names_at, spelled
from pico.history.git.trees import folder_id, subtree
from pico.history.git.unread import read_tree
from pico.history.writing.claim import GitFolders, Goal
from pico.history.writing.commit_object import NewCommit
from pico.history.writing.in_progress import refuse_begun
from pico.history.writing.landing import Landing, land
from pico.history.writing.lock import write_lock
from pico.history.writing.passage import Start, advance, go, shelve
from pico.history.writing.recovery import leave_word, recover
from pico.manifest.file_names import is_manifest
from pico.manifest.load import bare_repository
from pico.places.lab import git_folders

MINUTE = timedelta(minutes=1)
# How libgit2 names what it can't read, and what to tell the user.
_UNREADABLE: tuple[tuple[str, str, str], ...] = (
    ("unknown object format", "it uses SHA-256 object names", "make it with `git init --object-format=sha1`"),
    ("extensions.refstorage", "it stores refs as reftable", "convert it: `git refs migrate --ref-format=files`"),
    (
        "not owned by current user",
        "it belongs to another user, and a repository can run its owner's code",
        "if you trust it: `git config --global --add safe.directory FOLDER`",
    ),
)


class Repository:
    """A Git repository, opened by `Repository.discover` or made by `Repository.init`.

    Reading goes through libgit2; whatever changes it goes through the user's `git`, so that hooks run and commits
    are signed as configured. `root` is the top of the working tree; a lab may be any folder below it.
    """

    def __init__(self, handle: Any, root: Path) -> None:
        self._git = handle
        self.root = root
        self._writing = False
        self.noticed: tuple[Diagnostic, ...] = ()

    @classmethod
    def discover(cls, path: Path) -> Repository | None:
        """Return the repository that `path` lies in, None where there is none.

        GIT_DIR, GIT_WORK_TREE and GIT_CEILING_DIRECTORIES count as they do for git, if `path` lies in that working
        tree. Raises PicoError for a repository that can't be read or has no working tree.
        """
        import pygit2

        ceiling = os.environ.get("GIT_CEILING_DIRECTORIES", "")
        told = git.given(path)
        if not told:
            git_folders(path)  # which refuses one that is broken: libgit2 would pass over it, as if there were none
        found = told[0] if told else pygit2.discover_repository(str(path.absolute()), False, ceiling)
        if not found:
            return None
        if not told:
            _refuse_embedded(Path(found), path)
        try:
            handle = open_handle(found)
        except Exception as exc:  # GitError, or ValueError and KeyError of the same cause
            raise _unreadable(Path(found), str(exc)) from exc
        tree = told[1] if told else handle.workdir
        if tree is None:
            raise PicoError(bare_repository(Path(found)))
        if not path.resolve().is_relative_to(Path(tree).resolve()):
            hint = "look at `core.worktree` in its configuration: somebody set it"
            raise PicoError(error("git-elsewhere", f"{found} says that its files are in {tree}, not here", hint=hint))
        return cls(handle, Path(tree).resolve())

    @classmethod
    def init(cls, path: Path) -> Repository:
        """Make an empty repository with branch `main` in the folder `path` and return it; raises PicoError."""
        import pygit2

        try:
            pygit2.init_repository(str(path), initial_head="main")
        except (pygit2.GitError, OSError) as exc:
            raise PicoError(error("folder", f"can't make a repository in {path}", detail=str(exc))) from exc
        return cls(pygit2.Repository(str(path)), path.resolve())

    @property
    def handle(self) -> Any:
        """The repository as libgit2 holds it, for what reads in bulk."""
        return self._git

    @property
    def own(self) -> Path:
        """The folder of Git's own files that this working tree alone has: `.git` of the main one."""
        return Path(self._git.path)

    @property
    def common(self) -> Path:
        """The folder of Git's own files that all worktrees share: `.git` of the main one."""
        own = self.own
        shared = own / "commondir"
        return (
            (own / shared.read_text(encoding="utf-8", errors="surrogateescape").strip()).resolve()
            if shared.is_file()
            else own
        )

    def complete(self, *, documents: bool = False) -> None:
        """Fetch the folders that a partial clone lacks, and with `documents` their manifests, notes and documents of
        runs: for git commands that read history with the network off. Raises PicoError."""
        complete(self._git, documents=documents)

    def blob(self, name: str) -> bytes:
        """Return the content of the file that has an object id of its own."""
        return bytes(self._git[name].data)

    def head(self) -> Head:
        """Return what is checked out: labelled with a tag at the commit, else the branch, else the short id."""
        if self._git.head_is_unborn:
            branch = str(self._git.lookup_reference("HEAD").target).removeprefix("refs/heads/")
            return Head(commit=None, branch=branch, label=branch)
        attached = None if self._git.head_is_detached else str(self._git.head.shorthand)
        commit = str(self._git.head.target)
        tags = names_at(self._git, TAGS).get(commit, ())
        return Head(commit=commit, branch=attached, label=tags[0] if tags else attached or commit[:7])

    def resolve(self, revision: str) -> Commit:
        """Return the commit that `revision` names: a branch, tag, id or its beginning, `HEAD~2`, `e1@{1}`, ...

        A branch that only a remote has counts too, as in `git checkout`. Raises PicoError naming the revision.
        """
        return self._commit(find(self._git, self.root, revision), names_at(self._git))

    def commits(self, ids: Iterable[str]) -> dict[str, Commit]:
        """Return commits by their full ids, the names of all looked up at once; raises KeyError."""
        refs = names_at(self._git)
        return {name: self._commit(self._git[name], refs) for name in ids}

    def files(
        self, revision: str, folder: str | Path = "", diagnostics: list[Diagnostic] | None = None
    ) -> dict[str, bytes]:
        """Return every `*.yaml` below `folder` (relative to the root) at `revision`, by path relative to `folder`.

        Nothing is checked out. Dot-folders and `runs/` are left out. What may hide a manifest (a link, a submodule,
        another spelling) is told in `diagnostics`; without these, errors among it are raised. Raises PicoError where
        the revision or the folder in it does not exist.
        """
        top, inside = find(self._git, self.root, revision).tree, self.relative(folder)
        if subtree(top, inside) is None:
            hint = "the lab may have had another folder then"
            raise PicoError(error("revision", f"`{revision}` has no folder {inside}", hint=hint))
        return read_tree(self, top, inside, revision, diagnostics)

    def tree_at(self, revision: str, folder: str | Path) -> Any:
        """Return the tree of `folder` at a revision, None where it has none; raises PicoError for an unknown one."""
        return subtree(find(self._git, self.root, revision).tree, self.relative(folder))

    def holds(self, revision: str, folder: str | Path) -> bool:
        """Return whether a revision has the folder; raises PicoError for one that there is not."""
        inside = self.relative(folder)
        return not inside or folder_id(find(self._git, self.root, revision), inside) is not None

    def ignores(self, folder: str | Path) -> bool:
        """Return whether .gitignore and the like leave a folder out."""
        return bool(self._git.path_is_ignored(f"{self.relative(folder)}/"))

    def relative(self, folder: str | Path) -> str:
        """Return `folder` (absolute, or relative to the root) as a path in a commit; empty for the root.

        Raises PicoError for a folder outside the repository.
        """
        absolute = (self.root / folder).resolve()
        if not absolute.is_relative_to(self.root):
            raise PicoError(error("outside", f"{folder} lies outside the repository {self.root}"))
        inside = absolute.relative_to(self.root).as_posix()
        return "" if inside == "." else inside

    def changed(self, folder: str | Path = "", counts: Callable[[str], bool] = is_manifest) -> tuple[str, ...]:
        """Return the manifests below `folder` that differ from HEAD or are not committed, relative to the root.

        Other files where `counts` says so of their paths.
        """
        arguments = ["status", "--porcelain", "-z", "--untracked-files=all", "--no-renames", "--"]
        listed = git.run(self.root, [*arguments, self.relative(folder) or "."], doing="list what was edited")
        paths = (entry[3:] for entry in listed.split("\0") if entry)
        return tuple(sorted(p for p in paths if counts(p)))

    def log(
        self,
        revisions: Sequence[str] = ("HEAD",),
        *,
        folder: str | Path = "",
        limit: int | None = None,
    ) -> Iterator[Commit]:
        """Yield the commits that `revisions` reach, children before parents, lines of history kept together.

        With a `folder`, only commits that changed it, as if there were no others. `limit` bounds how many.
        """
        import pygit2

        if not revisions or (list(revisions) == ["HEAD"] and self._git.head_is_unborn):
            return
        refs = names_at(self._git)
        walker = self._git.walk(None, pygit2.enums.SortMode.TIME | pygit2.enums.SortMode.TOPOLOGICAL)
        for revision in revisions:
            walker.push(find(self._git, self.root, revision).id)
        inside = self.relative(folder)
        commits = [self._commit(c, refs) for c in walker] if not inside else self._touching(walker, inside, refs)
        ordered = topological(commits)
        yield from ordered[:limit] if limit is not None else ordered

    def _touching(self, walker: Iterable[Any], folder: str, refs: dict[str, tuple[str, ...]]) -> list[Commit]:
        """Return the commits that changed `folder`, each with the nearest such ancestors as parents."""
        from dataclasses import replace

        handles = list(walker)
        trees = {str(c.id): folder_id(c, folder) for c in handles}
        kept: dict[str, tuple[str, ...]] = {}  # commit -> itself, or what stands for it
        commits = []
        for handle in reversed(handles):
            name = str(handle.id)
            before = [str(p) for p in handle.parent_ids]
            parents = tuple(dict.fromkeys(k for p in before for k in kept.get(p, ())))
            same = [p for p in before if trees.get(p) == trees[name]]
            if same or (not before and trees[name] is None):
                kept[name] = kept.get(same[0], ()) if same else ()
            else:
                kept[name] = (name,)
                commits.append(replace(self._commit(handle, refs), parents=parents))
        return commits[::-1]

    def tips(self) -> tuple[str, ...]:
        """Return the full names of branches and tags, HEAD first if it exists: all that `log` may start from."""
        kinds = (TAGS, BRANCHES)
        names = {kind + name for kind in kinds for refs in names_at(self._git, kind).values() for name in refs}
        return (*(() if self._git.head_is_unborn else ("HEAD",)), *sorted(names))

    def spelled(self, revision: str) -> str:
        """Return `origin/e1` for `e1` where only a remote has such a branch, else the revision as it is."""
        return spelled(self._git, revision)

    def commit(
        self,
        paths: Iterable[str | Path],
        message: str,
        *,
        author: tuple[str, datetime] | None = None,
        ignored: Iterable[str | Path] = (),
        whole: bool = False,
        empty: bool = False,
    ) -> Commit:
        """Commit `paths` and nothing else that is staged, and return the commit; hooks run, signing as configured.

        Killed at any instant, the repository is as before or has the commit (`pico.history.writing.landing`). `author`:
        whose change it is, and when it was made, where that is not now by whoever commits. Files in `ignored` count
        though .gitignore may name them. `whole`: all that is staged, as a merge needs it. `empty`: also where nothing
        differs. Raises PicoError with git's words: no identity, a hook that refuses, a lock, nothing to commit.
        """
        if not message.strip():
            raise PicoError(error("message", "a commit needs a message", hint='say why: `pico commit -m "..."`'))
        forced = tuple(self.relative(p) for p in ignored)
        names = tuple(dict.fromkeys((*(self.relative(p) or "." for p in paths), *forced)))
        if not names and not whole and not empty:
            raise PicoError(error("nothing-to-commit", "there is nothing to commit", hint="nothing differs from HEAD"))
        with self.writing("pico commit"):
            what = Landing(
                message=message, paths=names, ignored=forced, head=self.head().commit, refs=self._moving(),
                partial=not whole, tidy=self._on("maintenance.auto"),
                options=(
                    *((f"--author={author[0]}", f"--date={author[1].isoformat()}") if author else ()),
                    *(("--allow-empty",) if empty else ()),
                ),
            )  # fmt: skip
            land(self._folders(), what)
        return self.resolve("HEAD")

    def advance(self, steps: Sequence[NewCommit], *, doing: str, reason: str) -> tuple[Commit, ...]:
        """Commit trees that were computed one on the other, with files and index, and return the commits.

        All of them are made, or none; killed at any instant, it is as before, or it is brought to its end by whoever
        comes next (`pico.history.writing.passage`). Hooks run, signing as configured; what else is staged stays
        staged. `doing`: the command; `reason`: for the reflog. Raises PicoError for files that would be lost and with
        git's words.
        """
        with self.writing(doing):
            made = advance(self._folders(), self._start(doing), steps, reason)
        return tuple(self.resolve(commit) for commit in made)

    def go(self, to: Goal, *, doing: str) -> None:
        """Let files, index and HEAD go to a commit, or the files alone to a tree; else as `advance`."""
        with self.writing(doing):
            go(self._folders(), self._start(doing), to)

    def shelve(self, paths: Sequence[str], message: str, *, doing: str) -> None:
        """Put files into git's stash and let them be as at HEAD again; else as `advance`."""
        with self.writing(doing):
            shelve(self._folders(), self._start(doing), paths, message)

    def _start(self, doing: str) -> Start:
        return Start(self.resolve("HEAD").id, self._moving(), doing)

    def _moving(self) -> tuple[Path, ...]:
        """Return the files of the refs that move with HEAD."""
        branch = self.head().branch
        named = [self.common / "refs" / "heads" / branch] if branch else []
        return (self.own / "HEAD", self.own / "ORIG_HEAD", self.common / "refs" / "stash", *named)

    def leave_word(self) -> None:
        """Bring to its end what a killed command left here, and leave what there is to say to the next command."""
        with write_lock(self.common / "pico" / "write.lock", "pico recover"):
            leave_word(self._folders())

    @contextmanager
    def writing(self, doing: str) -> Iterator[None]:
        """Be the only one who by PICO writes manifests and commits in this repository and its worktrees.

        What a killed one left is cleared away, and `noticed`. Who is inside may enter again. Raises PicoError, naming
        who is, where another one takes too long.
        """
        if self._writing:
            yield
            return
        with write_lock(self.common / "pico" / "write.lock", doing):
            self._writing = True
            try:
                with disk_trouble(self.common, f"{doing} did not come to its end"):
                    self.noticed += recover(self._folders())
                    yield
            except PicoError as exc:
                if not self._folders().claim.exists():
                    raise
                text = f"{doing} is begun and not ended; files or index may be on their way"
                left = warning("pending", text, hint="once the disk can be written, the next `pico` command ends it")
                raise PicoError((*exc.diagnostics, left), exc.exit_code) from exc
            finally:
                self._writing = False

    def _folders(self) -> GitFolders:
        own = self.own
        return GitFolders(root=self.root, own=own, common=self.common, index=git.index(self.root, own))

    def _on(self, name: str) -> bool:
        """Return a switch of git's configuration that is on unless it is turned off."""
        try:
            return bool(self._git.config.get_bool(name))
        except (KeyError, ValueError):
            return True

    def checkout(self, revision: str) -> Head:
        """Check `revision` out (a branch, else detached) and return the new HEAD. Moves nothing on a table.

        Killed at any instant, it is as before, or it is brought to its end by whoever comes next. Raises PicoError
        where edits would be overwritten, and where a merge or the like is under way.
        """
        with self.writing(f"pico checkout {revision}"):
            commit, before = str(find(self._git, self.root, revision).id), self.head()
            refuse_begun(self.own, "checkout")
            ref = branch_for(self._git, self.root, revision)
            commit = str(self._git.references[ref].target) if ref else commit
            came, goes = before.branch or before.commit, ref.removeprefix(BRANCHES) or commit
            goal = Goal(commit, f"checkout: moving from {came} to {goes}", head=ref)
            self.go(goal, doing=f"pico checkout {revision}")
        git.notify(self.root, "post-checkout", before.commit or "", commit, "1")
        return self.head()

    def branch(self, name: str, at: str = "HEAD") -> None:
        """Make the branch `name` at a revision; raises PicoError where it exists."""
        git.run(self.root, ["branch", "--", name, self.resolve(at).id], doing=f"make the branch {name}")

    def tag(self, name: str, at: str = "HEAD") -> None:
        """Make the tag `name` at a revision; raises PicoError where it exists."""
        git.run(self.root, ["tag", "--", name, self.resolve(at).id], doing=f"make the tag {name}")

    def write_commit(
        self,
        files: Mapping[str, bytes],
        message: str,
        parents: Sequence[str],
        *,
        author: tuple[str, str],
        time: datetime,
    ) -> str:
        """Write a commit that holds `files` by path, and nothing else, and return its id.

        `author` is (name, e-mail), `time` counts for author and committer: same arguments, same id. Moves no branch,
        touches no file, runs no hook.
        """
        import pygit2
        from pygit2.enums import FileMode

        index = pygit2.Index()
        for path, content in files.items():
            index.add(pygit2.IndexEntry(path, self._git.create_blob(content), FileMode.BLOB))
        signature = pygit2.Signature(*author, int(time.timestamp()), int((time.utcoffset() or timedelta()) / MINUTE))
        tree = index.write_tree(self._git)
        return str(self._git.create_commit(None, signature, signature, message + "\n", tree, list(parents)))

    def write_refs(self, refs: Mapping[str, str], *, head: str) -> None:
        """Point full ref names (`refs/heads/main`) at commits, and check branch `head` out, edits overwritten."""
        from pygit2.enums import CheckoutStrategy

        for name, commit in refs.items():
            self._git.references.create(name, commit, force=True)
        self._git.set_head(f"refs/heads/{head}")
        self._git.checkout_head(strategy=CheckoutStrategy.FORCE)

    def _commit(self, handle: Any, refs: dict[str, tuple[str, ...]]) -> Commit:
        name = str(handle.id)
        author, message = handle.author, handle.message.strip()
        zone = timezone(timedelta(minutes=author.offset))
        return Commit(
            id=name,
            parents=tuple(str(p) for p in handle.parent_ids),
            summary=message.partition("\n")[0],
            message=message,
            author=f"{author.name} <{author.email}>",
            time=clock.from_epoch(author.time).astimezone(zone),
            refs=refs.get(name, ()),
        )


def _refuse_embedded(found: Path, path: Path) -> None:
    """Raise PicoError for a repository that lies among the files of another one, where a clone may have brought it: its
    configuration is then somebody else's, and names programs."""
    own = found.resolve()
    if own.name != ".git" and own in (path.resolve(), *path.resolve().parents):
        raise PicoError(bare_repository(own))


def _unreadable(path: Path, words: str) -> PicoError:
    for pattern, reason, hint in _UNREADABLE:
        if pattern in words:
            folder = path.parent if path.name == ".git" else path
            hint = hint.replace("FOLDER", str(folder))
            return PicoError(error("git-unreadable", f"{folder} can't be read: {reason}", hint=hint))
    return PicoError(error("git-unreadable", f"{path} can't be read", detail=words))
