"""All commands together, the options that each of them takes, and what becomes of errors."""

from __future__ import annotations

import copy
import re
import sys
import traceback
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer
from typer.core import TyperGroup

from pico.diagnostics import ExitCode

from . import commands
from .arguments import PLAIN, PREFIX, remember
from .at_once.complete import SHARED, plain
from .at_once.help import help_text
from .commands import files, stem
from .errors import explain
from .hints import flags_of
from .session import Session, standing
from .terminal.output import flags, unsaid, write

_REVISION = re.compile(r"\b(REV|REVISION|BASE)\b|A\.\.B")
EVERYWHERE = "Every command takes -C DIR, --json, --debug, --backend NAME, --emulate, --bench NAME: `pico --help`."


def _version(value: bool) -> None:
    if value:
        from pico.version import __version__

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
    session_at: Annotated[
        str | None,
        typer.Option(
            "--bench", metavar="NAME", help="Which bench: sim, emulated, hardware, or LAB/BENCH.", callback=remember
        ),
    ] = None,
    session_emulate: Annotated[
        bool,
        typer.Option("--emulate", help="With --backend hardware: emulators of the devices.", callback=remember),
    ] = False,
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
        """Return a command with the options that all commands take, made once; None where there is no such file."""
        if cmd_name not in self.commands and cmd_name in files():
            self.commands[cmd_name] = self._made(cmd_name)
        return self.commands.get(cmd_name)

    def _made(self, cmd_name: str) -> Any:
        name = stem(files()[cmd_name])
        module = _module(cmd_name, name)
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


def _module(command: str, name: str) -> Any:
    """Return the module of a command; raises PicoError for a file put beside PICO's that is broken."""
    path = f"{commands.__name__}.{name}"
    if Path(files()[command]).parent == Path(__file__).parent / "commands":
        return import_module(path)
    from pico.plug_ins.calling import calling
    from pico.plug_ins.faults import broken
    from pico.plug_ins.known import PlugIn

    one = PlugIn("pico.commands", command, path)
    with calling(one, "cannot be imported"):
        module = import_module(path)
    if not hasattr(module, "app") and not callable(getattr(module, name, None)):
        raise broken(one, f"has neither a function `{name}` nor an `app`", at=module)
    return module


@cache
def build() -> Any:
    """Return the command line; a program that runs several commands makes it once."""
    app = typer.Typer(name="pico", cls=Commands, no_args_is_help=True, pretty_exceptions_enable=False, **PLAIN)
    app.callback()(root)
    return typer.main.get_command(app)


def _hidden_from_function(option: Any) -> Any:
    """Return the option as a command takes it: its callback remembers the value, the function never sees it, and its
    help has a line for all of them."""
    own = copy.copy(option)
    own.expose_value, own.hidden = False, True
    return own


def _named(argument: Any) -> None:
    """Let an argument be called in its command's help as it is here: `REV`, `[REV]` or `[REV]...`."""
    word = (argument.metavar or argument.name.upper()).removesuffix("...")
    word = word[1:-1] if word[:1] == "[" else word
    piece = (word if argument.required else f"[{word}]") + ("..." if argument.nargs == -1 else "")
    argument.get_usage_pieces = lambda ctx: [piece]
    argument.get_help_record = lambda ctx: (word, argument.help)


def _refuse_empty(argument: Any) -> None:
    """Let an argument that takes a revision refuse an empty word, as an empty variable of a shell leaves it: it does
    not mean what leaving it out means."""
    inner = argument.callback

    def check(context: Any, parameter: Any, value: Any) -> Any:
        for word in (value,) if isinstance(value, str) else value or ():
            if isinstance(word, str) and not word.strip():
                from pico.history.git.revisions import require_name

                require_name(word)
        return inner(context, parameter, value) if inner else value

    argument.callback = check


def _share(command: Any, options: list[Any]) -> None:
    taken = {word for p in command.params for word in p.opts}
    for argument in command.params:
        if argument.param_type_name == "argument":
            _named(argument)
            if _REVISION.search(argument.metavar or argument.name.upper()):
                _refuse_empty(argument)
    command.params = [*command.params, *(o for o in options if not taken & set(o.opts))]
    command.help = (command.help or "").replace("Examples:\n", "\b\nExamples:\n")
    command.epilog = EVERYWHERE
    for below in getattr(command, "commands", {}).values():
        _share(below, options)


def _no_code(command: str, code: object) -> NoReturn:
    """Raise PicoError for a command that returned what is no exit code."""
    from pico.plug_ins.calling import shown
    from pico.plug_ins.faults import broken
    from pico.plug_ins.known import PlugIn

    name = stem(files()[command])
    one, module = PlugIn("pico.commands", command, name), sys.modules.get(f"{commands.__name__}.{name}")
    raise broken(one, f"failed: it returned {shown(code)}, expected an exit code", at=getattr(module, name, module))


def run(words: list[str]) -> int:
    """Run one command; every error becomes a diagnostic and an exit code."""
    session = Session(json="--json" in words, debug="--debug" in words)
    named = plain(words, SHARED)
    stepping = named[:2] == ["bisect", "step"] or named[:1] == ["bisect-step"]
    words = [*named[1:], "--help"] if named[:1] == ["help"] else words
    unsaid.clear()
    flags.clear()
    standing.clear()
    try:
        group = build()
        with group.make_context("pico", list(words)) as context:
            context.meta["pico.words"] = tuple(words)
            try:
                code = group.invoke(context)
                if code is not None and not isinstance(code, int):
                    _no_code(context.invoked_subcommand or named[0], code)
            finally:  # also of a command that was not understood, and made no session
                flags[:] = flags or flags_of(context.meta.get("pico.session", {}))
    except typer.Exit as exc:
        code = exc.exit_code
    except (Exception, KeyboardInterrupt) as exc:
        found, code = explain(exc, words)
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
