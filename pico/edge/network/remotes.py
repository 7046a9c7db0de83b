"""The coordinators that a checkout knows by name, as git knows its remotes, and which bench of theirs is meant.

They stand in `pico/remotes.json` of Git's own folder, which all worktrees share and no commit brings along; outside Git
in `.pico`. A bench is called LAB/BENCH, as its coordinator calls it, with the remote's name before it where the
checkout knows several. Which one a command means: `meant.py`.
"""

from __future__ import annotations

import fcntl
import os
import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from pico.base.plain_files import open_lock
from pico.base.state_files import REMOTES
from pico.diagnostics import PicoError, did_you_mean, error
from pico.places.bench import BenchPlace, local_benches
from pico.places.lab import BENCHES, FOLDER, lab_place, own_folder

PAGE = "gui"
"""What the coordinator of `pico gui` is called while it serves."""
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")
_LOOPBACK = ("127.0.0.1", "localhost", "[::1]", "::1")


@dataclass(frozen=True)
class Remote:
    """A coordinator: its address, and the certificate (PEM) by which it is known where no authority signed that."""

    url: str
    certificate: str = ""


@dataclass(frozen=True)
class Remotes:
    """The coordinators of a checkout by name."""

    named: Mapping[str, Remote] = field(default_factory=dict)
    page: tuple[str, str] | None = None
    """The bench of this machine that `pico gui` serves (`sim`), and its name there (`shel/bench1`)."""
    default: str = ""
    """The bench that an earlier PICO meant if none was named, as REMOTE/LAB/BENCH; each worktree chooses now."""


@dataclass(frozen=True)
class Far:
    """A bench at a coordinator, for the checkout of the lab in `root`."""

    remote: Remote
    lab: str
    bench: str
    root: Path
    local: str = ""
    """The bench of this machine that it is, while `pico gui` serves that; empty for any other."""

    @property
    def folder(self) -> Path:
        """Where the checkout keeps what is its own of this bench."""
        place = re.sub(r"[^A-Za-z0-9.-]", "_", self.remote.url.partition("://")[2])
        folder = own_folder(self.root) / BENCHES / place / self.lab / self.bench
        if (folder / FOLDER).is_dir():
            _bring_up(folder)
        return folder

    @property
    def name(self) -> str:
        """`shel/bench1`."""
        return f"{self.lab}/{self.bench}"

    @property
    def title(self) -> str:
        """What runs and commits call the bench."""
        return self.local or self.name

    @property
    def said(self) -> str:
        """`shel/bench1 at https://lab.example`."""
        return f"{self.name} at {self.remote.url}"


Place = BenchPlace | Far
"""A bench: one of this machine, or one of a coordinator."""


def _bring_up(folder: Path) -> None:
    """Move what an earlier PICO kept in a folder `.pico` of its own to where it belongs."""
    with suppress(OSError):  # on a read-only disk it is not read
        for path in (folder / FOLDER).iterdir():
            if not (folder / path.name).exists():
                path.rename(folder / path.name)
        (folder / FOLDER).rmdir()


def address(url: str) -> str:
    """Return the address of a coordinator as it is kept; raises PicoError for what is none."""
    found = urlsplit(url.strip().rstrip("/"))
    if found.scheme not in ("http", "https") or not found.hostname or found.path or found.username:
        text = f"`{url[:80]}` is no address of a coordinator"
        raise PicoError(error("remote", text, hint="such as https://lab.example or http://127.0.0.1:8700"))
    return f"{found.scheme}://{found.netloc}"


def known(root: Path) -> Remotes:
    """Return the coordinators that the checkout of the lab in `root` knows; what a killed `pico gui` left is put back
    first. Raises PicoError for a file that can't be read."""
    found = _read(root)
    return _healed(root, found) if PAGE in found.named else found


def _read(root: Path) -> Remotes:
    return REMOTES.read(_path(root), _remotes) or Remotes()


def _remotes(document: Mapping[str, Any]) -> Remotes:
    named = {str(k): Remote(str(v["url"]), str(v.get("certificate", ""))) for k, v in document["remotes"].items()}
    default, page = str(document.get("default", "")), document.get("page")
    if default.startswith(f"{PAGE}/"):  # of an earlier PICO, with what was meant before its page was opened
        default = str(document.get("before") or "")
    return Remotes(named, (str(page["bench"]), str(page["as"])) if page else None, default)


def keep(root: Path, remotes: Remotes) -> None:
    """Let the checkout of the lab in `root` know these coordinators; raises PicoError."""
    named = {name: {"url": one.url, "certificate": one.certificate} for name, one in sorted(remotes.named.items())}
    default = {"default": remotes.default} if remotes.default else {}
    page = {"page": {"bench": remotes.page[0], "as": remotes.page[1]}} if remotes.page else {}
    REMOTES.write(_path(root), {"remotes": named, **default, **page}, indent=1)


def added(remotes: Remotes, name: str, remote: Remote) -> Remotes:
    """Return the coordinators with one more; raises PicoError for a name that is none, or is taken."""
    if not _NAME.fullmatch(name) or name == PAGE:
        text = f"`{name[:40]}` is no name for a remote"
        raise PicoError(error("remote", text, hint="letters, digits, `-` and `_`, such as `lab`"))
    if name in remotes.named:
        text = f"there is a remote {name} already: {remotes.named[name].url}"
        raise PicoError(error("remote", text, hint=f"`pico remote remove {name}` first, or take another name"))
    return replace(remotes, named={**remotes.named, name: remote})


def removed(remotes: Remotes, name: str) -> Remotes:
    """Return the coordinators without one; raises PicoError if there is none of that name."""
    _require(remotes, name)
    rest = {k: v for k, v in remotes.named.items() if k != name}
    default = "" if remotes.default.startswith(f"{name}/") else remotes.default
    return Remotes(rest, None if name == PAGE else remotes.page, default)


def named(remotes: Remotes, word: str) -> tuple[str, str, str]:
    """Return remote, lab and bench that a word names: `shel/bench1`, `lab/shel/bench1`; raises PicoError."""
    parts = word.split("/")
    others = [name for name in remotes.named if name != PAGE] or list(remotes.named)
    if not remotes.named:
        hint = "`pico remote add NAME URL` says where its coordinator is"
        raise PicoError(error("remote", f"{word[:80]}: this checkout knows no coordinator", hint=hint))
    if len(parts) == 2 and len(others) > 1:
        names = ", ".join(f"`{name}/{word}`" for name in sorted(others))
        raise PicoError(error("remote", f"{word[:80]} of which coordinator?", hint=names))
    if len(parts) == 2:
        parts = [*others, *parts]
    if len(parts) != 3 or not all(_NAME.fullmatch(part) for part in parts):
        hint = "LAB/BENCH, `sim`, `emulated` or `hardware`: `pico bench list` shows them"
        raise PicoError(error("remote", f"`{word[:80]}` names no bench", hint=hint))
    _require(remotes, parts[0])
    return parts[0], parts[1], parts[2]


def _require(remotes: Remotes, name: str) -> None:
    if name not in remotes.named:
        hint = did_you_mean(name[:40], remotes.named) or "`pico remote list` shows those that there are"
        raise PicoError(error("remote", f"there is no remote `{name[:40]}`", hint=hint))


def at_url(root: Path, word: str) -> Far:
    """Return the bench of `pico://host/lab/bench`; a coordinator beyond this machine is asked by TLS only."""
    found = urlsplit(word)
    parts = found.path.strip("/").split("/")
    if found.scheme not in ("pico", "http", "https") or len(parts) != 2 or not all(map(_NAME.fullmatch, parts)):
        hint = "such as pico://lab.example/shel/bench1"
        raise PicoError(error("remote", f"`{word[:80]}` names no bench", hint=hint))
    scheme = found.scheme
    if scheme == "pico":
        scheme = "http" if found.hostname in _LOOPBACK else "https"
    url = address(f"{scheme}://{found.netloc}")
    same = [one for one in known(root).named.values() if one.url == url]
    return Far(same[0] if same else Remote(url), parts[0], parts[1], root)


def _healed(root: Path, found: Remotes) -> Remotes:
    try:
        lock = open_lock(lock_of_page(root))
    except OSError:
        return found
    try:
        fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
        return left_over_put_back(root)
    except BlockingIOError:
        return found
    finally:
        os.close(lock)


def left_over_put_back(root: Path) -> Remotes:
    """Put back what a `pico gui` has left whose process is gone, and return the coordinators; raises PicoError."""
    known = _read(root)
    left = known.named.get(PAGE)
    return known if left is None else put_back(root, left.url)


def put_back(root: Path, url: str) -> Remotes:
    """Let the coordinator of `pico gui` at `url` be none of the checkout's any more, and the bench be its folder's own;
    raises PicoError."""
    from pico.edge.network.enrolment import read_enrolment, withdraw
    from pico.edge.network.tokens import forget_token

    for place in local_benches(root):
        enrolment = read_enrolment(place)
        if enrolment is not None and enrolment.url == url:
            withdraw(place)
    forget_token(url)
    known = _read(root)
    if PAGE in known.named:
        known = removed(known, PAGE)
        keep(root, known)
    return known


def lock_of_page(root: Path) -> Path:
    """Return the file that the process of `pico gui` has locked while it lives."""
    return _path(root).with_name("gui.lock")


def _path(root: Path) -> Path:
    place = lab_place(root)
    if place is None:
        return REMOTES.path(own_folder(root))
    return REMOTES.path(place.common / "pico" / (f"{place.inside.replace('/', '%')}-" if place.inside != "." else ""))
