"""All recipes of a lab read against its bench from files alone, as `pico check` asks them: nothing is opened."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import PurePath

from pico.diagnostics import Diagnostic, PicoError, error
from pico.manifest.text.source import Source
from pico.model.setup import Setup
from pico.recipes.reader import Able
from pico.recipes.reading import read_recipe

FOLDER = "recipes"
"""Where the recipes of a lab are, below its folder."""


def check_recipes(
    setup: Setup, top: str, files: Mapping[str, bytes], revision: Callable[[str], bool]
) -> tuple[tuple[str, ...], tuple[Diagnostic, ...]]:
    """Return the names of the recipes of a lab and all that is wrong with them. `files`: the lab's, by path, those of
    recipes below `top`/recipes; `revision`: whether there is one of a name."""
    folder = str(PurePath(top, FOLDER))
    paths = {os.path.normpath(path): data for path, data in files.items()}
    own = sorted(path for path in paths if str(PurePath(path).parent) == folder)

    def fetch(word: str, caller: str) -> tuple[str, bytes]:
        for place in (PurePath(caller).parent, folder):
            for name in (word, f"{word}.yaml"):
                path = os.path.normpath(PurePath(place, name))
                if path in paths:
                    return path, paths[path]
        raise PicoError(error("no-recipe", f"there is no recipe `{word[:60]}`", hint=f"a file in `{FOLDER}/`"))

    found: list[Diagnostic] = []
    for path in own:
        source = Source(path, paths[path].decode("utf-8", "replace"))
        found += read_recipe(source, setup, fetch, Able(revision=revision))[1]
    return tuple(PurePath(path).stem for path in own), tuple(dict.fromkeys(found))
