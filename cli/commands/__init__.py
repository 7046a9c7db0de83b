"""A file a command, and nothing to be added anywhere else: a function of the file's name, or a group called `app`.

`HEADING = "..."` and `ORDER = ...`, a line each, say where `pico --help` shows the command: under which of HEADINGS,
and where among the commands there, by ascending order; last of all without them. No two commands share both; PICO's own
orders are tens, so that a new command fits between. `SETTINGS` and `CLASS`, if there are any, are those of its typer
command. Names, headings and what the commands do are read from the files as text: only the command that is asked for is
imported (`cli.app.Commands`).
"""

from __future__ import annotations

import io
import os

HEADINGS = ("The main job", "Manifests", "History", "One operation at a time", "Recipes", "The simulator, and the rest")

LAST = 9999
"""The order of a command that declares none."""


def files() -> dict[str, str]:
    """Return the file of each command, by the command's name."""
    found = sorted(
        e.path for folder in __path__ for e in os.scandir(folder) if e.name[0] != "_" and e.name[-3:] == ".py"
    )
    return {stem(path).rstrip("_").replace("_", "-"): path for path in found}


def stem(path: str) -> str:
    """Return the name of the module in a file."""
    return path.rpartition(os.sep)[2].removesuffix(".py")


def summary() -> dict[str, dict[str, str]]:
    """Return the commands under each heading with what each does, in order."""
    found = sorted(_line(name, path) for name, path in files().items())
    return {heading: {name: line for under, _, name, line in found if under == heading} for heading in HEADINGS}


def _line(name: str, path: str) -> tuple[str, int, str, str]:
    """Return the heading of a command, its order there, its name, and what it does."""
    with io.open_code(path) as file:  # to import pathlib takes longer than all of this
        text = file.read().decode(errors="replace")  # a file put beside PICO's may be anything
    heading = text.partition('\nHEADING = "')[2].partition('"')[0]
    order = text.partition("\nORDER = ")[2].partition("\n")[0]
    place = (heading, int(order)) if heading in HEADINGS and order.isdecimal() else (HEADINGS[-1], LAST)
    group, single = text.partition("\napp = ")[2], text.partition(f"\ndef {stem(path)}(")[2]
    said = group.partition('help="')[2].partition('"') if group else single.partition('"""')[2].partition('"""')
    return *place, name, said[0].partition("\n")[0]
