"""Which files are manifests, by their names; and which look like it, and are not read: a part may stand in them."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import PurePosixPath

from pico.diagnostics import Diagnostic, error
from pico.manifest.text.source import Source

MAX_BYTES = 2 * 1024 * 1024
SUFFIX = ".yaml"
_LIKE = (SUFFIX, ".yml")
# At the start of a line: a script in YAML for others may write a manifest, indented.
_DECLARED = re.compile(
    rb"""^(?:(?:\{[ \t]*)?['"]?apiVersion['"]?|[ \t{]*"apiVersion")[ \t]*:[ \t]*['"]?pico/""", re.MULTILINE
)
_KIND = re.compile(rb"""^[ \t{]*["']?kind["']?[ \t]*:[ \t]*["']?(\w+)""", re.MULTILINE)
_MARKS = b"\xef\xbb\xbf\xff\xfe"
# With `.yaml` somewhere in it; or without an extension, or with one for what is set aside.
_ASIDE = re.compile(r"[.#]*(.+?)\.ya?ml(?![a-z]).*|[.#]*([^.]+?)(?:\.(?:bak|old|orig|save|off|disabled))?[~# ]*", re.I)
UNSEEN, GONE = "unseen", "gone"
AWAY = "delete it, or move it out of the lab's folder"
BENCH_LAB, LAB_DIFFERS, RENAMED, EXCLUDED = "bench-lab", "lab-differs", "renamed", "excluded"
TOLD = (UNSEEN, GONE, "symlink", BENCH_LAB, LAB_DIFFERS, RENAMED, EXCLUDED)
"""Codes of what a plan tells though nothing is wrong: of a file that is not read (one that nobody can look at, one
deleted, a link), and of files that describe another bench than there is."""


@lru_cache(10_000)
def is_manifest(path: str) -> bool:
    """Return whether a file of this path may be a manifest: `*.yaml`, not hidden, not in a folder that is left out."""
    return path.endswith(SUFFIX) and not PurePosixPath(path).name.startswith(".") and not left_out(path)


def left_out(path: str) -> bool:
    """Return whether a path lies in a dot-folder or in a folder called `runs`."""
    return any(part.startswith(".") or part == "runs" for part in PurePosixPath(path).parts[:-1])


def hidden(path: str) -> bool:
    """Return whether a file or folder of this path is left out, with all that lies in it."""
    return left_out(f"{path}/*")


def named_as_manifest(path: str) -> bool:
    """Return whether a file's name is that of a manifest, or of one in another spelling: `.yml`, `.YAML`."""
    return PurePosixPath(path).suffix.lower() in _LIKE


@lru_cache(10_000)
def set_aside_from(path: str) -> str:
    """Return the name that a manifest had before it was set aside as `path`: `p1.yaml` of `p1.yaml~`, `.p1.yaml`, `p1`.

    Empty for a name that no such file has, and for one that is read or told by itself (`p1.yml`).
    """
    match = _ASIDE.fullmatch(path.rpartition("/")[2])
    told = match and match[1] and named_as_manifest(path) and not hidden(path)
    return f"{match[1] or match[2]}{SUFFIX}" if match and not told else ""


def declares_api(data: bytes) -> bool:
    """Return whether a file declares PICO's apiVersion, whatever its name and its encoding are."""
    return bool(_DECLARED.search(data.replace(b"\0", b"").lstrip(_MARKS)))


def is_recipe(data: bytes) -> bool:
    """Return whether a file holds recipes and nothing else: no part of a state stands in it."""
    kinds = _KIND.findall(data)
    return bool(kinds) and set(kinds) == {b"Recipe"}


def about(path: str, code: str, summary: str, hint: str) -> Diagnostic:
    """Return what is wrong with a file or folder as a whole."""
    return error(code, f"{path}: {summary}", hint=hint, source=Source(path, "").range(0))


def misnamed_manifest(path: str) -> Diagnostic:
    """Return what to say of a manifest under a name that is not read."""
    better = PurePosixPath(path).with_suffix(SUFFIX).name
    return about(
        path, "name", "a manifest that is not read: its name does not end in `.yaml`", f"rename it: `{better}`"
    )


def linked(path: str, target: str, holds: str) -> Diagnostic:
    """Return what to say of a link that leads to manifests, one of them `holds`."""
    summary = f"a link, and links are not followed: {holds} behind it is not read"
    return about(path, "symlink", summary, f"put the files themselves here, in place of the link to {target}")


def unseen(path: str, why: str, hint: str) -> Diagnostic:
    """Return what to say of something behind which manifests may lie, and nobody can look (`weighed`)."""
    return replace(about(path, UNSEEN, f"{why}: PICO can't tell whether manifests lie there", hint), severity="warning")


@dataclass(frozen=True, slots=True)
class SetAside(Diagnostic):
    """A manifest at `path` that is not read, and its `data`: what it names counts once the state is known."""

    path: str = ""
    data: bytes = b""


def set_aside(path: str, data: bytes) -> list[Diagnostic]:
    """Return what to weigh of a file whose name is that of one set aside; nothing where it is no manifest."""
    summary, at = f"{path}: a manifest that is not read", Source(path, "").range(0)
    return [SetAside("note", "name", summary, source=at, path=path, data=data)] if declares_api(data) else []
