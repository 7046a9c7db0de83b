"""Arguments and options that several commands take."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

import typer
from typer.core import TyperCommand, TyperGroup

from pico.diagnostics import PicoError, error

_KEY = "pico.scope"
PREFIX = "session_"  # so that a command may have an argument called `folder` of its own


def remember(context: typer.Context, parameter: typer.CallbackParam, value: Any) -> Any:
    """Keep an option for `Session.of`, given before or after the command's name; the later one wins."""
    if value is not None and value is not False:
        context.meta.setdefault("pico.session", {})[str(parameter.name).removeprefix(PREFIX)] = value
    return value


Component = Annotated[str, typer.Argument(metavar="COMPONENT", help="A component of the inventory.")]
Revision = Annotated[
    str | None,
    typer.Argument(metavar="REV", help="A commit, branch or tag; without it the manifest."),
]
PlanOrRevision = Annotated[
    str | None,
    typer.Argument(metavar="PLANFILE|REV", help="A saved plan or a revision; ./NAME is a file."),
]
Seed = Annotated[
    int | None, typer.Option("--seed", metavar="N", min=0, help="Of a new simulated world: what is hidden in it.")
]
Fidelity = Annotated[
    str | None, typer.Option("--fidelity", metavar="kinematic|physics", help="How the simulator moves things.")
]
Yes = Annotated[bool, typer.Option("--auto-approve", "--yes", "-y", help="Do not ask.")]
Exact = Annotated[bool, typer.Option("--exact", help="Move for less than the tolerance, too.")]
RunBack = Annotated[str | None, typer.Argument(metavar="[RUN]", help="Its id, or how that begins or ends.")]
OfPerson = Annotated[str | None, typer.Option("--of", metavar="NAME", help="Take back a run of this person.")]
Align = Annotated[bool, typer.Option("--align", help="Then seek the goals that are not aligned.")]
NoAlign = Annotated[bool, typer.Option("--no-align", help="Do not, though the lab's policy says so.")]
DetailedExit = Annotated[bool, typer.Option("--detailed-exitcode", help="Exit with 2 where something would move.")]
Out = Annotated[Path | None, typer.Option("--out", metavar="FILE", help="Write to FILE.")]
Exclude = Annotated[
    list[str] | None,
    typer.Option(
        "--exclude",
        metavar="COMPONENT",
        help="Leave it alone; may be given again.",
    ),
]
Prefer = Annotated[
    Literal["fewest-moves", "shortest-time"],
    typer.Option("--prefer", metavar="fewest-moves|shortest-time", help="What counts first."),
]
Mainline = Annotated[
    int | None,
    typer.Option("--mainline", metavar="N", help="Of a merge: the side, from 1, that counts as what was before."),
]
NoCommit = Annotated[bool, typer.Option("--no-commit", help="Write the manifests, and leave the commit to you.")]
Speed = Annotated[float | None, typer.Option("--speed", metavar="SHARE", help="Share of the joint limits, up to 1.")]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Show the plan of it and move nothing.")]
Manifest = Annotated[
    bool, typer.Option("--manifest", help="Write it into the manifest, checked as a move is; the bench stays.")
]
Pairs = Annotated[list[str] | None, typer.Argument(metavar="KEY=VALUE...", help="What is asked of it.")]
LockTimeout = Annotated[
    float | None,
    typer.Option(
        "--lock-timeout", metavar="SECONDS", help="Wait so long for who has the bench.", min=0, callback=remember
    ),
]
"""Of commands that take the bench; `Session.of` knows it."""
StopOnError = Annotated[bool, typer.Option("--stop-on-error", help="Start nothing more once something fails.")]
GitWords = Annotated[
    list[str] | None, typer.Argument(metavar="REMOTE|REF", help="For git, as it is; git's options, too.")
]


PLAIN: dict[str, Any] = {"rich_markup_mode": None, "add_completion": False}


class Group(TyperGroup):
    """Commands under one name, each listed with its whole first line."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the list."""
        known = [(name, self.get_command(ctx, name)) for name in self.list_commands(ctx)]
        with formatter.section("Commands"):
            formatter.write_dl([(name, (command.help or "").partition("\n")[0]) for name, command in known if command])


def group(help: str, examples: tuple[str, ...], alone: bool = False) -> typer.Typer:
    """Return commands under one name; `help` is their line in `pico --help`, `alone`: the name does something alone."""
    said = "\n".join([help, "", "Examples:", *(f"  {line}" for line in examples)])
    return typer.Typer(cls=Group, help=said, no_args_is_help=not alone, invoke_without_command=alone, **PLAIN)


class Scoped(TyperCommand):
    """A command that takes names after `--`, apart from its other arguments; see `scope_of`."""

    names = "COMPONENT[.TUNABLE]..."

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse what stands before `--`, and keep what stands after it."""
        at = args.index("--") if "--" in args else len(args)
        ctx.meta[_KEY] = tuple(args[at + 1 :])
        try:
            return super().parse_args(ctx, args[:at])
        except Exception as exc:
            if "extra argument" in str(getattr(exc, "message", "")):
                exc.message = f"{exc.message.rstrip('.')}: components go after `--`"  # type: ignore[attr-defined]
            raise

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """Return the words of the usage line."""
        return [*super().collect_usage_pieces(ctx), f"[-- {self.names}]"]


def aligning(align: bool, no_align: bool) -> bool | None:
    """Return whether somebody wants goals to be sought, or wants them not to be; None: as the policy of the lab says.
    Raises PicoError for both."""
    if align and no_align:
        raise PicoError(error("usage", "--align and --no-align contradict each other", hint="give one of them"))
    return True if align else False if no_align else None


def scope_of(context: typer.Context) -> tuple[str, ...]:
    """Return the names that were given after `--`."""
    found: tuple[str, ...] = context.meta.get(_KEY, ())
    return found


def pairs(words: list[str] | None, positional: tuple[str, ...] = ()) -> dict[str, str]:
    """Return `key=value` words as a mapping; bare words take the names of `positional` in turn. The value of a step
    begins with its sign: `angle+=5` is `angle` and `+=5`.

    Raises PicoError for a word without `=` that has no name.
    """
    found: dict[str, str] = {}
    names = iter(positional)
    for word in words or []:
        key, value = _assigned(word)
        if "=" not in word:
            key, value = _named(word, names), word
        if key in found:
            raise PicoError(error("usage", f"`{key}` is given twice"))
        found[key] = value
    return found


def _assigned(word: str) -> tuple[str, str]:
    """Return the name and the value of `angle=3`, `angle += 5`; a word without `=` is a name."""
    key, equals, value = word.partition("=")
    key = key.rstrip()
    if equals and key.endswith(("+", "-")):
        key, value = key[:-1], f"{key[-1]}={value}"
    return key.strip(), value.strip()


def value_of(address: str, words: list[str]) -> tuple[str, dict[str, str]]:
    """Return the component and the values of its tunables: of `p1.angle 3 deg`, `p1.angle=3`, `p1 angle=3 tip=1`,
    `p1 angle+=5`."""
    for word in words:
        if word.startswith("--"):
            _named(word, iter(()))
    component, _, tunable = address.partition(".")
    if sum("=" in word for word in words) > 1:
        return component, pairs(words)
    said = " ".join([tunable, *words]).strip()
    name, value = _assigned(said) if "=" in said else said.split(maxsplit=1) if " " in said else (said, "")
    return component, {name: value.strip()} if said else {}


def _named(word: str, names: Iterator[str]) -> str:
    if word.startswith("--"):
        raise PicoError(error("usage", f"no such option: {word}"))
    if "/" in word or word == "home":
        return "slot"
    name = next(names, None)
    if name is None:
        raise PicoError(error("usage", f"`{word}` is no `key=value`", hint="for example `angle=3`"))
    return name
