"""The coordinators that a checkout knows by name, as git knows its remotes, and which bench of theirs is meant.

They stand in `pico/remotes.json` of Git's own folder, which all worktrees share and no commit brings along; outside Git
in `.pico`. A bench is called LAB/BENCH, as its coordinator calls it, with the remote's name before it where the
checkout knows several; `local` is the bench of the checkout itself.
"""

from __future__ import annotations

import fcntl
import json
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from urllib.parse import urlsplit

from pico.attachment import lab_place, own_folder
from pico.diagnostics import PicoError, did_you_mean, error
from pico.disk import write_whole

LOCAL = "local"
"""What the bench of the checkout itself is called."""
PAGE = "gui"
"""What the coordinator of `pico gui` is called while it serves."""
FILE = "remotes.json"
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")
_LOOPBACK = ("127.0.0.1", "localhost", "[::1]", "::1")


@dataclass(frozen=True)
class Remote:
    """A coordinator: its address, and the certificate (PEM) by which it is known where no authority signed that."""

    url: str
    certificate: str = ""


@dataclass(frozen=True)
class Remotes:
    """The coordinators of a checkout by name, and the bench that is meant where none is said (empty: its own).
    `before`: which one was, before that of `pico gui` was added; None without that."""

    named: Mapping[str, Remote] = field(default_factory=dict)
    default: str = ""
    before: str | None = None


@dataclass(frozen=True)
class Far:
    """A bench at a coordinator, for the checkout of the lab in `root`."""

    remote: Remote
    lab: str
    bench: str
    root: Path

    @property
    def folder(self) -> Path:
        """Where the checkout keeps what is its own of this bench."""
        place = re.sub(r"[^A-Za-z0-9.-]", "_", self.remote.url.partition("://")[2])
        return own_folder(self.root) / "benches" / place / self.lab / self.bench

    @property
    def name(self) -> str:
        """`shel/bench1`."""
        return f"{self.lab}/{self.bench}"

    @property
    def said(self) -> str:
        """`shel/bench1 at https://lab.example`."""
        return f"{self.name} at {self.remote.url}"


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
    return found if found.before is None else _healed(root, found)


def _read(root: Path) -> Remotes:
    path = _path(root)
    try:
        document = json.loads(path.read_bytes())
        named = {str(k): Remote(str(v["url"]), str(v.get("certificate", ""))) for k, v in document["remotes"].items()}
        before = document.get("before")
        return Remotes(named, str(document.get("default", "")), None if before is None else str(before))
    except FileNotFoundError:
        return Remotes()
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as exc:
        hint = "delete it, then `pico remote add NAME URL`"
        raise PicoError(error("remote", f"{path} can't be read: {exc}", hint=hint)) from exc


def keep(root: Path, remotes: Remotes) -> None:
    """Let the checkout of the lab in `root` know these coordinators; raises PicoError."""
    named = {name: {"url": one.url, "certificate": one.certificate} for name, one in sorted(remotes.named.items())}
    before = {} if remotes.before is None else {"before": remotes.before}
    data = json.dumps({"remotes": named, "default": remotes.default, **before}, indent=1) + "\n"
    write_whole(_path(root), data.encode(), folders=True)


def added(remotes: Remotes, name: str, remote: Remote) -> Remotes:
    """Return the coordinators with one more; raises PicoError for a name that is none, or is taken."""
    if not _NAME.fullmatch(name) or name in (LOCAL, PAGE):
        text = f"`{name[:40]}` is no name for a remote"
        raise PicoError(error("remote", text, hint="letters, digits, `-` and `_`, such as `lab`"))
    if name in remotes.named:
        text = f"there is a remote {name} already: {remotes.named[name].url}"
        raise PicoError(error("remote", text, hint=f"`pico remote remove {name}` first, or take another name"))
    return replace(remotes, named={**remotes.named, name: remote})


def removed(remotes: Remotes, name: str) -> Remotes:
    """Return the coordinators without one, where that of `pico gui` goes with the bench meant that was before it;
    raises PicoError where there is none of that name."""
    _require(remotes, name)
    rest = {k: v for k, v in remotes.named.items() if k != name}
    default, before = remotes.default, remotes.before
    if name == PAGE:
        default, before = (before or "") if default.startswith(f"{PAGE}/") else default, None
    if before is not None and before.startswith(f"{name}/"):
        before = ""
    return Remotes(rest, "" if default.startswith(f"{name}/") else default, before)


def chosen(root: Path, said: str | None = None) -> Far | None:
    """Return which bench is meant by a word, without one by the checkout's default; None for the checkout's own. Raises
    PicoError for a word that means none."""
    word = said or ""
    if "://" in word:
        return _by_url(root, word)
    remotes = known(root)
    if word == LOCAL:
        return None
    if not (word := word or remotes.default):
        return None
    remote, lab, bench = named(remotes, word)
    return Far(remotes.named[remote], lab, bench, root)


def named(remotes: Remotes, word: str) -> tuple[str, str, str]:
    """Return remote, lab and bench that a word names: `shel/bench1`, `lab/shel/bench1`; raises PicoError."""
    parts = word.split("/")
    if not remotes.named:
        hint = "`pico remote add NAME URL` says where its coordinator is"
        raise PicoError(error("remote", f"{word[:80]}: this checkout knows no coordinator", hint=hint))
    if len(parts) == 2 and len(remotes.named) > 1:
        names = ", ".join(f"`{name}/{word}`" for name in sorted(remotes.named))
        raise PicoError(error("remote", f"{word[:80]} of which coordinator?", hint=names))
    if len(parts) == 2:
        parts = [*remotes.named, *parts]
    if len(parts) != 3 or not all(_NAME.fullmatch(part) for part in parts):
        hint = "LAB/BENCH, as `pico bench list` shows them, or `local` for the bench of this checkout"
        raise PicoError(error("remote", f"`{word[:80]}` names no bench", hint=hint))
    _require(remotes, parts[0])
    return parts[0], parts[1], parts[2]


def _require(remotes: Remotes, name: str) -> None:
    if name not in remotes.named:
        hint = did_you_mean(name[:40], remotes.named) or "`pico remote list` shows those that there are"
        raise PicoError(error("remote", f"there is no remote `{name[:40]}`", hint=hint))


def _by_url(root: Path, word: str) -> Far:
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
        lock = os.open(lock_of_page(root), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o666)
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
    return known if left is None or known.before is None else put_back(root, left.url)


def put_back(root: Path, url: str) -> Remotes:
    """Let the coordinator of `pico gui` at `url` be none of the checkout's any more, and the bench be its folder's own;
    raises PicoError."""
    from pico.edge.network.enrolment import read_enrolment, withdraw
    from pico.edge.network.tokens import forget_token

    enrolment = read_enrolment(root)
    if enrolment is not None and enrolment.url == url:
        withdraw(root)
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
        return own_folder(root) / FILE
    return place.common / "pico" / (f"{place.inside.replace('/', '%')}-" if place.inside != "." else "") / FILE
