"""Bare repositories, one a lab, as git itself serves them (`git http-backend`): nothing in them is ever run here."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import tempfile
from collections import Counter
from collections.abc import AsyncIterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from pico.diagnostics import PicoError, error
from pico.server.access.principal import require_name

LARGEST = 64 << 20
"""Bytes of a push."""
_SETTINGS = f"""
[http]
  receivepack = true
[receive]
  denyNonFastForwards = true
  denyDeletes = true
  denyCurrentBranch = updateInstead
  maxInputSize = {4 * LARGEST}
[transfer]
  fsckObjects = true
[core]
  hooksPath = /dev/null
  symlinks = false
[gc]
  auto = 0
"""
PIECE = 1 << 16
AT_ONCE, AT_ONCE_EACH = 24, 6
"""Requests that git works on at once, of all and of one person."""
_SLOW = 300.0
"""Seconds in which the body of a request comes."""
_UPDATE = """#!/bin/sh
name="${1#refs/*/}"
case "$1" in
refs/tags/*)
  other="refs/heads/$name"
  if [ -n "$(echo "$2" | tr -d 0)" ]; then
    echo "the tag $name is there, and a tag stays what it is: choose another name" >&2
    exit 1
  fi ;;
refs/pico/sent/*)
  [ "${1##*/}" = "$3" ] || { echo "a commit is sent under its own id" >&2; exit 1; }
  exit 0 ;;
*) other="refs/tags/$name" ;;
esac
if git show-ref --verify --quiet "$other"; then
  echo "there is $other: choose another name, for a branch and a tag of one can't be told apart" >&2
  exit 1
fi
"""
"""The hook that a push passes, by reference."""


def repository(folder: Path, lab: str) -> Path:
    """Return the bare repository of a lab, made where there is none; raises PicoError."""
    path = folder / "git" / f"{require_name(lab, 'a lab')}.git"
    hook = folder / "git" / ".hooks" / "update"
    if not hook.exists() or hook.read_text(encoding="utf-8") != _UPDATE:
        hook.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        hook.write_text(_UPDATE, encoding="utf-8")
        hook.chmod(0o700)
    if not path.exists():
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=".new-") as new:
            git("init", "--quiet", "--bare", "--initial-branch=main", f"{new}/made")
            with Path(new, "made", "config").open("a", encoding="utf-8") as config:
                config.write(_SETTINGS)
            Path(new, "made").rename(path)
    return path


def git(*words: str) -> str:
    """Return what git prints; raises PicoError where it fails."""
    done = subprocess.run(
        ["git", *words],
        env=environment(),
        capture_output=True,
        text=True,
        check=False,
        encoding="utf-8",
        errors="replace",
    )
    if done.returncode:
        raise PicoError(error("git", f"git {words[0]} failed: {done.stderr.strip()[:500]}"))
    return done.stdout.strip()


def environment() -> dict[str, str]:
    """Return what git is started with: nobody's settings but the repository's own."""
    own = {"GIT_CONFIG_NOSYSTEM": "1", "GIT_CONFIG_GLOBAL": os.devnull, "GIT_TERMINAL_PROMPT": "0", "LC_ALL": "C"}
    plain = {"GIT_NO_REPLACE_OBJECTS": "1"}  # a commit is what its id says
    return {"PATH": os.environ.get("PATH", os.defpath), "HOME": os.devnull, **own, **plain}


@dataclass
class Answer:
    """What git answers; `end` is to be called, however it ends."""

    status: int
    headers: Mapping[str, str]
    _process: asyncio.subprocess.Process
    _who: str
    _busy: Counter[str]

    async def pieces(self) -> AsyncIterator[bytes]:
        """Yield the body."""
        assert self._process.stdout is not None
        while piece := await self._process.stdout.read(PIECE):
            yield piece
        await self._process.wait()

    def end(self) -> None:
        """End git where it goes on."""
        self._busy[self._who] -= 1
        _end(self._process)


async def answered(path: Path, request: Mapping[str, str], body: AsyncIterator[bytes], busy: Counter[str]) -> Answer:
    """Return what git answers to a request, as CGI describes it, to the bare repository at `path`. `busy` counts who
    asks how much at once.

    The whole request is there before git begins: what reads a socket for the sake of its end would else take pieces of
    it. Raises PicoError where too many ask, or the request is too slow.
    """
    who = request["REMOTE_USER"]
    if busy[who] >= AT_ONCE_EACH or busy.total() >= AT_ONCE:
        raise PicoError(error("limit", "git works on as much as it may at once", hint="again in a moment"))
    busy[who] += 1
    process: asyncio.subprocess.Process | None = None
    try:
        with tempfile.TemporaryFile() as whole:
            async with asyncio.timeout(_SLOW):
                async for piece in body:
                    whole.write(piece)
            found = environment() | {
                "GIT_PROJECT_ROOT": str(path.parent), "GIT_HTTP_EXPORT_ALL": "1", "GATEWAY_INTERFACE": "CGI/1.1",
                "PATH_INFO": f"/{path.name}/{request['service']}", "CONTENT_LENGTH": str(whole.tell()),
                **{k: v for k, v in request.items() if k != "service"}, **_limits(path, who),
            }  # fmt: skip
            whole.seek(0)
            process = await asyncio.create_subprocess_exec(
                "git", "http-backend", env=found, stdin=whole, stdout=asyncio.subprocess.PIPE,
                stderr=asyncio.subprocess.DEVNULL, start_new_session=True,
            )  # fmt: skip
        assert process.stdout is not None
        headers: dict[str, str] = {}
        while line := (await process.stdout.readline()).decode("latin-1").rstrip("\r\n"):
            name, _, value = line.partition(":")
            headers[name.strip().lower()] = value.strip()
    except BaseException as exc:
        busy[who] -= 1
        _end(process)
        if isinstance(exc, TimeoutError):
            raise PicoError(error("limit", f"a request to git comes whole within {_SLOW:.0f} s")) from exc
        raise
    status = int(headers.pop("status", "200" if headers else "500").split()[0])
    return Answer(status, headers, process, who, busy)


def _limits(path: Path, who: str) -> dict[str, str]:
    """Return settings by which branches, tags and sent commits alone are pushed, and no branch of somebody else."""
    own = ("refs/heads/HEAD", *(f"{sign}refs/heads/{space}/{of}" for space in ("web", "run")
                                for sign, of in (("", ""), ("!", who))))  # fmt: skip
    hidden = ("refs", "!refs/heads", "!refs/tags", "!refs/pico/sent", *own)
    settings = [*(("receive.hideRefs", ref) for ref in hidden), ("core.hooksPath", str(path.parent / ".hooks"))]
    pairs = {f"GIT_CONFIG_{what}_{n}": text for n, setting in enumerate(settings)
             for what, text in zip(("KEY", "VALUE"), setting, strict=True)}  # fmt: skip
    return {"GIT_CONFIG_COUNT": str(len(settings)), **pairs}


def _end(process: asyncio.subprocess.Process | None) -> None:
    """End git with all that it started, whoever is being cancelled; the loop reaps it."""
    if process is not None and process.returncode is None:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
