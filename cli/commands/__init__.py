"""A file a command, and nothing to be added anywhere else: a function of the file's name, or a group called `app`.

The first line of a file says where `pico --help` shows the command: under which heading, and which in turn; last where
it says nothing. `SETTINGS` and `CLASS`, where it has them, are those of its typer command. Names, headings and what the
commands do are read from the files as text: only the command that is asked for is imported (`cli.app.Commands`).
"""

from __future__ import annotations

import io
import os

HEADINGS = ("The main job", "Manifests", "History", "One operation at a time", "Recipes", "The simulator, and the rest")


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
    """Return the heading of a command, its turn there, its name, and what it does."""
    with io.open_code(path) as file:  # to import pathlib takes longer than all of this
        text = file.read().decode()
    heading, _, turn = text.strip('"').partition(": ")[0].rpartition(", ")
    place = (heading, int(turn)) if heading in HEADINGS and turn.isdecimal() else (HEADINGS[-1], 999)
    group, single = text.partition("\napp = ")[2], text.partition(f"\ndef {stem(path)}(")[2]
    said = group.partition('help="')[2].partition('"') if group else single.partition('"""')[2].partition('"""')
    return *place, name, said[0].partition("\n")[0]
