"""What an exception becomes: diagnostics and an exit code."""

from __future__ import annotations

import os
import re
import sys
import traceback
from pathlib import Path
from typing import Any

import typer

from pico.diagnostics import Diagnostic, ExitCode, PicoError, did_you_mean, error

from . import commands
from .names import instead, moves

ALIKE = 0.75
"""How much alike a command must be to be offered for a misspelt one, besides the first letter."""


def explain(exc: BaseException, words: list[str]) -> tuple[list[Diagnostic], int]:
    """Return an exception as diagnostics and an exit code."""
    if isinstance(exc, PicoError):
        return list(exc.diagnostics), exc.exit_code
    if isinstance(exc, KeyboardInterrupt):
        return [error("interrupted", "interrupted; nothing has moved")], ExitCode.INTERRUPTED
    if isinstance(exc, typer.Abort):
        return [error("declined", "nothing was done")], ExitCode.ERROR
    if hasattr(exc, "format_message"):  # a usage error, whichever click typer carries
        return [_usage(exc, words)], ExitCode.ERROR
    if (found := _refused(exc)) is not None:
        return [found], ExitCode.ERROR
    from pico.plug_ins.faults import blamed

    return [blamed(exc, {"pico.commands": commands.__name__}) or _internal(exc)], ExitCode.ERROR


def _refused(exc: BaseException) -> Diagnostic | None:
    """Return what is said where the system refused a file, or a disk is full, fails or is read-only, as SQLite and
    libgit2 say it, too; None for anything else."""
    from pico.disk import number_of, unwritable

    if not isinstance(exc, Exception):
        return None
    if isinstance(exc, OSError) and exc.filename:
        return unwritable(Path(os.fsdecode(exc.filename)), exc, what=os.fsdecode(exc.filename), code="file")
    if isinstance(exc, FileNotFoundError) and Path().stat().st_nlink == 0:
        return error("file", "the folder you are in is gone: removed or moved", hint="`cd` to one that is there")
    words = " ".join(str(exc).split())
    if number_of(exc) is not None:
        return error("file", words, hint="`df -h` shows which disk is full or read-only")
    if (git := sys.modules.get("pygit2")) and isinstance(exc, git.GitError):
        return _unread(words)
    return None


def _unread(words: str) -> Diagnostic:
    """Return what is said where libgit2 can't read something of git's that only git itself can, or that is broken."""
    if "mandatory extension" in words and "link" in words:
        hint = "`git config core.splitIndex false && git update-index --no-split-index` makes it one file again"
        return error("git-unreadable", "git keeps its index in two files here (core.splitIndex)", hint=hint)
    return error("git-unreadable", f"git's own files can't be read: {words}", hint="`git fsck` tells what is broken")


def _usage(exc: Any, words: list[str]) -> Diagnostic:
    context = getattr(exc, "ctx", None)
    path = context.command_path if context else "pico"
    if type(exc).__name__ == "NoArgsIsHelpError":
        known = ", ".join(context.command.list_commands(context)) if context else ""
        return error("usage", f"`{path}` needs one of: {known}", hint=f"`{path} --help` says what they do")
    message = exc.format_message().rstrip(".")
    if (allowed := re.search(r"'([^']*)' is not one of (.*)", message)) and getattr(exc, "param", None):
        near = did_you_mean(allowed[1], re.findall("'(.*?)'", allowed[2]))
        return error("usage", f"{exc.param.opts[0]} can't be `{allowed[1]}`", hint=near)
    hint = f"`{path} --help` shows how it is used"
    if " (Possible options: " in message:
        message, _, near = message.removesuffix(")").partition(" (Possible options: ")
        options = near.split(", ")
        meant = [o for o in options if o.endswith(str(getattr(exc, "option_name", "-")).lstrip("-"))] or options
        hint = f"did you mean {' or '.join(f'`{o}`' for o in meant)}? {hint}"
    if message.startswith("No such command"):
        unknown = message.split("'")[1] if "'" in message else next((w for w in words if not w.startswith("-")), "")
        if path == "pico" and (said := instead(unknown)):
            return error("usage", said)
        message = f"{path} has no command `{unknown}`"
        names = context.command.list_commands(context) if context else ()
        begun = [name for name in names if name[0] == unknown[:1] and not moves(f"{path} {name}")]
        near = did_you_mean(unknown, begun, ALIKE)
        lists = f"`{path} --help` lists the commands"
        if "show" in names and re.fullmatch(r"[\w.-]+", unknown):
            lists = f"`{path} show {unknown}` where that is a name; {lists}"
        hint = near if near.startswith("did") else lists
    return error("usage", message[:1].lower() + message[1:], hint=hint)


def _internal(exc: BaseException) -> Diagnostic:
    """Return what a user sees of a mistake in PICO itself: one line, and how to report it."""
    frames = traceback.extract_tb(exc.__traceback__)
    last = next((f for f in reversed(frames) if "pico" in f.filename), frames[-1] if frames else None)
    where = f" at {'/'.join(Path(last.filename).parts[-3:])}:{last.lineno}" if last else ""
    text = " ".join(str(exc).split())[:200]
    summary = f"PICO itself failed: {type(exc).__name__}{f': {text}' if text else ''}{where}"
    again = " ".join(["pico", *(word for word in sys.argv[1:] if word != "--debug"), "--debug"])
    return error("internal", summary, hint=f"this is a mistake in PICO; report it with the output of `{again}`")
