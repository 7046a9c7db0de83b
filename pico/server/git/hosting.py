"""Bare repositories, one a lab, as git itself serves them (`git http-backend`): nothing in them is ever run here."""

from __future__ import annotations

import asyncio
import os
import subprocess
import tempfile
from collections.abc import AsyncIterator, Mapping
from contextlib import suppress
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


def repository(folder: Path, lab: str) -> Path:
    """Return the bare repository of a lab, made where there is none; raises PicoError."""
    path = folder / "git" / f"{require_name(lab, 'a lab')}.git"
    if not path.exists():
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=".new-") as new:
            git("init", "--quiet", "--bare", "--initial-branch=main", f"{new}/made")
            with Path(new, "made", "config").open("a") as config:
                config.write(_SETTINGS)
            Path(new, "made").rename(path)
    return path


def git(*words: str) -> str:
    """Return what git prints; raises PicoError where it fails."""
    done = subprocess.run(["git", *words], env=environment(), capture_output=True, text=True, check=False)
    if done.returncode:
        raise PicoError(error("git", f"git {words[0]} failed: {done.stderr.strip()[:500]}"))
    return done.stdout.strip()


def environment() -> dict[str, str]:
    """Return what git is started with: nobody's settings but the repository's own."""
    own = {"GIT_CONFIG_NOSYSTEM": "1", "GIT_CONFIG_GLOBAL": os.devnull, "GIT_TERMINAL_PROMPT": "0", "LC_ALL": "C"}
    return {"PATH": os.environ.get("PATH", os.defpath), "HOME": os.devnull, **own}


async def answered(
    path: Path, request: Mapping[str, str], body: AsyncIterator[bytes]
) -> tuple[int, dict[str, str], AsyncIterator[bytes]]:
    """Return status, headers and body of what git answers to a request, as CGI describes it, to the bare repository at
    `path`; git ends with the body."""
    found = environment() | {
        "GIT_PROJECT_ROOT": str(path.parent), "GIT_HTTP_EXPORT_ALL": "1", "GATEWAY_INTERFACE": "CGI/1.1",
        "PATH_INFO": f"/{path.name}/{request['service']}", **{k: v for k, v in request.items() if k != "service"},
        **_own_branches(request["REMOTE_USER"]),
    }  # fmt: skip
    pipe = asyncio.subprocess.PIPE
    process = await asyncio.create_subprocess_exec(
        "git", "http-backend", env=found, stdin=pipe, stdout=pipe, stderr=asyncio.subprocess.DEVNULL
    )
    assert process.stdin is not None and process.stdout is not None
    feeding = asyncio.create_task(_feed(process.stdin, body))
    headers: dict[str, str] = {}
    try:
        while line := (await process.stdout.readline()).decode("latin-1").rstrip("\r\n"):
            name, _, value = line.partition(":")
            headers[name.strip().lower()] = value.strip()
    except BaseException:
        await _ended(process, feeding)
        raise
    status = int(headers.pop("status", "200" if headers else "500").split()[0])
    return status, headers, _pieces(process, feeding)


def _own_branches(who: str) -> dict[str, str]:
    """Return settings by which nobody pushes to `web/NAME` of somebody else."""
    values = ("refs/heads/web/", f"!refs/heads/web/{who}")
    pairs = {f"GIT_CONFIG_{what}_{n}": text for n, value in enumerate(values)
             for what, text in (("KEY", "receive.hideRefs"), ("VALUE", value))}  # fmt: skip
    return {"GIT_CONFIG_COUNT": str(len(values)), **pairs}


async def _pieces(process: asyncio.subprocess.Process, feeding: asyncio.Task[None]) -> AsyncIterator[bytes]:
    assert process.stdout is not None
    try:
        while piece := await process.stdout.read(PIECE):
            yield piece
    finally:
        await _ended(process, feeding)


async def _feed(pipe: asyncio.StreamWriter, body: AsyncIterator[bytes]) -> None:
    with suppress(ConnectionError):
        async for piece in body:
            pipe.write(piece)
            await pipe.drain()
    pipe.close()


async def _ended(process: asyncio.subprocess.Process, feeding: asyncio.Task[None]) -> None:
    feeding.cancel()
    await asyncio.gather(feeding, return_exceptions=True)
    if process.returncode is None:
        with suppress(TimeoutError):
            async with asyncio.timeout(5):
                await process.wait()
    if process.returncode is None:
        process.kill()
        await process.wait()
