"""All commands together, the options that each of them takes, and what becomes of errors."""

from __future__ import annotations

import copy
import os
import re
import sys
import traceback
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from pico.diagnostics import Diagnostic, ExitCode, PicoError, did_you_mean, error

from . import commands
from .arguments import PREFIX, remember
from .commands import files, stem
from .help import help_text
from .output import unsaid, write
from .session import Session, standing

PLAIN: dict[str, Any] = {"rich_markup_mode": None, "pretty_exceptions_enable": False, "add_completion": False}


def _version(value: bool) -> None:
    if value:
        from pico import __version__

        typer.echo(f"pico {__version__}")
        raise typer.Exit


def root(
    session_folder: Annotated[
        Path | None, typer.Option("-C", metavar="DIR", help="Work as if started in DIR.", callback=remember)
    ] = None,
    session_json: Annotated[bool, typer.Option("--json", help="Answer with JSON.", callback=remember)] = False,
    session_debug: Annotated[
        bool, typer.Option("--debug", help="Show the traceback of an internal error.", callback=remember)
    ] = False,
    session_backend: Annotated[
        str | None,
        typer.Option("--backend", metavar="NAME", help="What executes: sim (default) or hardware.", callback=remember),
    ] = None,
    session_lock_timeout: Annotated[
        float | None,
        typer.Option(
            "--lock-timeout",
            metavar="SECONDS",
            help="Wait so long for who has the bench.",
            min=0,
            hidden=True,
            callback=remember,
        ),
    ] = None,
    version: Annotated[bool, typer.Option("--version", help="Show the version.", callback=_version)] = False,
) -> None:
    """Version control for the optical table."""


class Commands(TyperGroup):
    """The commands, each imported and made once it is asked for: it brings its views along, and they the model."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of all commands."""
        return list(files())

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command with the options that all commands take; None where there is no such file."""
        if cmd_name not in files():
            return None
        name = stem(files()[cmd_name])
        module = import_module(f"{commands.__name__}.{name}")
        app = getattr(module, "app", None)
        if app is None:
            app = typer.Typer(**PLAIN)
            settings, kind = getattr(module, "SETTINGS", None), getattr(module, "CLASS", None)
            app.command(cmd_name, cls=kind, context_settings=settings)(getattr(module, name))
        made = typer.main.get_command(app)
        made.name = cmd_name
        _share(
            made,
            [
                _hidden_from_function(p)
                for p in self.params
                if p.name.startswith(PREFIX) and not getattr(p, "hidden", False)
            ],
        )
        return made

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write what `pico --help` says, also after another option."""
        formatter.write(help_text() + "\n")


def build() -> Any:
    """Return the command line."""
    app = typer.Typer(name="pico", cls=Commands, no_args_is_help=True, **PLAIN)
    app.callback()(root)
    return typer.main.get_command(app)


def _hidden_from_function(option: Any) -> Any:
    """Return the option as a command takes it: its callback remembers the value, the function never sees it."""
    own = copy.copy(option)
    own.expose_value = False
    return own


def _share(command: Any, options: list[Any]) -> None:
    taken = {word for p in command.params for word in p.opts}
    command.params = [*command.params, *(o for o in options if not taken & set(o.opts))]
    for below in getattr(command, "commands", {}).values():
        _share(below, options)


def run(words: list[str]) -> int:
    """Run one command; every error becomes a diagnostic and an exit code."""
    session, stepping = Session(json="--json" in words, debug="--debug" in words), "bisect-step" in words
    unsaid.clear()
    standing.clear()
    try:
        group = build()
        with group.make_context("pico", list(words)) as context:
            code = group.invoke(context)
    except typer.Exit as exc:
        code = exc.exit_code
    except (Exception, KeyboardInterrupt) as exc:
        found, code = _explain(exc, words)
        if stepping and code < 128:
            code += 128  # to `git bisect run` 1 would mean a bad commit
        if isinstance(exc, KeyboardInterrupt) and sys.stderr.isatty():
            write(sys.stderr, "")  # the terminal shows ^C where the cursor was
        if session.debug:
            write(sys.stderr, traceback.format_exc(), end="")
        session.report(standing[0].told(found) if standing else found)
    if unsaid:
        from pico.disk import unwritable

        from .views import diagnostics

        found = [unwritable(Path("/dev/stdout"), unsaid[0], what="the answer can't be written to standard output")]
        write(sys.stderr, diagnostics.text(found))
    return int(code or (ExitCode.ERROR if unsaid else 0))


def _explain(exc: BaseException, words: list[str]) -> tuple[list[Diagnostic], int]:
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
    return [_internal(exc)], ExitCode.ERROR


def _refused(exc: BaseException) -> Diagnostic | None:
    """Return what is said where the system refused a file, or a disk is full, fails or is read-only, as SQLite and
    libgit2 say it, too; None for anything else."""
    from pico.disk import number_of, unwritable

    if not isinstance(exc, Exception):
        return None
    if isinstance(exc, OSError) and exc.filename:
        return unwritable(Path(os.fsdecode(exc.filename)), exc, what=os.fsdecode(exc.filename), code="file")
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
        hint = f"did you mean `{near.split(',')[0]}`? {hint}"
    if message.startswith("No such command"):
        unknown = message.split("'")[1] if "'" in message else next((w for w in words if not w.startswith("-")), "")
        message = f"{path} has no command `{unknown}`"
        near = did_you_mean(unknown, context.command.list_commands(context) if context else ())
        hint = near if near.startswith("did") else f"`{path} --help` lists the commands"
    return error("usage", message[:1].lower() + message[1:], hint=hint)


def _internal(exc: BaseException) -> Diagnostic:
    """Return what a user sees of a mistake in PICO itself: one line, and how to report it."""
    frames = traceback.extract_tb(exc.__traceback__)
    last = next((f for f in reversed(frames) if "pico" in f.filename), frames[-1] if frames else None)
    where = f" at {'/'.join(Path(last.filename).parts[-3:])}:{last.lineno}" if last else ""
    text = " ".join(str(exc).split())[:200]
    summary = f"PICO itself failed: {type(exc).__name__}{f': {text}' if text else ''}{where}"
    again = " ".join(["pico", *sys.argv[1:], "--debug"])
    return error("internal", summary, hint=f"this is a mistake in PICO; report it with the output of `{again}`")
