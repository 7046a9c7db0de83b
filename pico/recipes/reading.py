"""From the texts of recipes to their steps, or all that is wrong with them, before anything moves."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import PurePath

from pico.diagnostics import Diagnostic, PicoError, error
from pico.manifest.recipe_names import by_present_names
from pico.manifest.text.kinds import API
from pico.manifest.text.source import Source
from pico.manifest.text.tree import Document, Map, Node, Scalar, parse
from pico.model.address import renaming_of
from pico.model.setup import Setup
from pico.recipes.parameters import read_parameters
from pico.recipes.reader import Able, Reader
from pico.recipes.reading_figures import read_figures, read_notes
from pico.recipes.reading_steps import Reading, read_steps
from pico.recipes.recipe import Name, Recipe
from pico.recipes.scope import Scope, bench_names
from pico.recipes.terms import Term
from pico.recipes.unattended import read_unattended

KEYS = ("apiVersion", "kind", "metadata", "parameters", "steps", "finally", "returns", "unattended", "figures",
        "notes")  # fmt: skip
METADATA = ("name", "title", "description", "lab")
FOLDER = "recipes"
"""Where the recipes of a lab are, below its folder."""
DEEPEST = 8
"""How deep recipes may call one another."""
Fetch = Callable[[str, str], tuple[str, bytes]]
"""Returns the path and the text of a recipe by its name, as called from the recipe at a path; raises PicoError."""


def read_recipe(
    source: Source, setup: Setup, fetch: Fetch, able: Able | None = None, above: tuple[str, ...] = (),
    bench: Mapping[str, Name] | None = None, made: set[str] | None = None,
) -> tuple[Recipe | None, list[Diagnostic]]:  # fmt: skip
    """Return the recipe of a text, and all that is wrong with it on this bench; None where it can't be read.

    One that is wrong as it stands is read by the present names of parts that it calls as they were called before.
    """
    documents, found = parse(source)
    if found or len(documents) != 1 or not isinstance(documents[0].root, Map):
        text = "a recipe is one mapping of keys to values"
        return None, found or [error("recipe", text, hint=f"begin it with `apiVersion: {API}`", source=source.range(0))]
    before = None if made is None else set(made)
    recipe, found = _read(documents[0], setup, fetch, able or Able(), above, bench, before)
    renamed = by_present_names(documents[0], renaming_of(setup.lab)) if found else None
    if renamed is not None:
        before = None if made is None else set(made)
        recipe, found = _read(renamed.document, setup, fetch, able or Able(), above, bench, before)
        recipe = replace(recipe, told=tuple(dict.fromkeys((*renamed.told, *recipe.told))))
    if made is not None and before is not None:
        made |= before
    return recipe, found


def _read(
    document: Document, setup: Setup, fetch: Fetch, able: Able, above: tuple[str, ...],
    bench: Mapping[str, Name] | None, made: set[str] | None,
) -> tuple[Recipe, list[Diagnostic]]:  # fmt: skip
    source, root, found = document.source, document.root, list[Diagnostic]()
    assert isinstance(root, Map)
    reader = Reader(document, setup, found, able, made)
    names, called = bench_names(setup) if bench is None else bench, list[Recipe]()

    def call(node: Node) -> Recipe | None:
        found = _called(reader, fetch, node, (*above, source.path), names)
        called.extend([found] if found else [])
        return found

    reader.keys(root, KEYS, "a recipe")
    about = _about(reader, root)
    parameters = read_parameters(reader, root.get("parameters"))
    full = frozenset(p.name for p in parameters.values() if p.kind in ("numbers", "texts"))
    reading = Reading(root, reader, full, call)
    own = {p.name: Name(p.kind, p.unit) for p in parameters.values()}
    scope = Scope(names, own)
    steps = read_steps(reading, scope, root.get("steps"), "", "steps")
    if not root.get("steps"):
        reader.wrong(root, "missing-key", "the recipe has no `steps`", "`steps: [{apply: e1}]`")
    finally_ = read_steps(reading, Scope(names, own), root.get("finally"), "finally.", "finally")
    returns, returned = _returns(reader, scope, root.get("returns"))
    alone = read_unattended(reader, names, own, root.get("unattended"), (*steps, *finally_))
    digest = hashlib.sha256("\0".join([source.content, *(r.digest for r in called)]).encode()).hexdigest()
    recipe = Recipe(
        **about, parameters=parameters, steps=steps, finally_=finally_, returns=returns, returned=returned,
        figures=read_figures(reader, returned, root.get("figures")), notes=read_notes(reader, root.get("notes")),
        digest=f"sha256:{digest}", path=source.path, unattended=alone,
        told=tuple(dict.fromkeys(d for r in called for d in r.told)),
    )  # fmt: skip
    return recipe, found


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


def _about(reader: Reader, root: Map) -> dict[str, str]:
    node = root.get("metadata")
    kind = root.get("kind")
    if not isinstance(kind, Scalar) or kind.text != "Recipe":
        reader.wrong(kind or root, "kind", "this is no recipe", "`kind: Recipe`")
    api = root.get("apiVersion")
    if not isinstance(api, Scalar) or api.text != API:
        reader.wrong(api or root, "api-version", f"`apiVersion` is not `{API}`", f"begin it with `apiVersion: {API}`")
    if not isinstance(node, Map):
        reader.wrong(node or root, "missing-key", "the recipe has no `metadata`", "`metadata: {name: tilt_scan}`")
        return {"name": "recipe"}
    reader.keys(node, METADATA, "metadata of a recipe")
    found = {k: v.text for k, (_, v) in node.entries.items() if k in METADATA and isinstance(v, Scalar)}
    if "name" not in found:
        reader.wrong(node, "missing-key", "the recipe has no name", "`metadata: {name: tilt_scan}`")
    lab = reader.setup.lab.name
    if found.get("lab", lab) != lab:
        where = node.entries["lab"][1]
        hint = "take `lab` out where it suits any lab that has the parts it speaks of"
        reader.wrong(where, "lab", f"this recipe is for the lab `{found['lab'][:40]}`, the bench here is `{lab}`", hint)
    return {"name": "recipe", **found}


def _returns(reader: Reader, scope: Scope, node: Node | None) -> tuple[dict[str, Term], dict[str, Name]]:
    if node is not None and not isinstance(node, Map):
        reader.wrong(node, "type", "`returns` is a mapping of names to values", "`returns: {width: spot.x}`")
    entries = node.entries if isinstance(node, Map) else {}
    found = {name: reader.any(scope, value, name) for name, (_, value) in entries.items()}
    return {name: term for name, (term, _) in found.items()}, {name: kind for name, (_, kind) in found.items()}


def _called(
    reader: Reader, fetch: Fetch, node: Node, above: tuple[str, ...], names: Mapping[str, Name]
) -> Recipe | None:  # fmt: skip
    name = node.text if isinstance(node, Scalar) else ""
    if not name:
        reader.wrong(node, "type", "`call` takes the name of a recipe", "`call: null_scan`")
        return None
    try:
        path, text = fetch(name, above[-1])
    except PicoError as exc:
        reader.wrong(node, exc.diagnostics[0].code, exc.diagnostics[0].summary, exc.diagnostics[0].hint)
        return None
    if path in above or len(above) >= DEEPEST:
        way = " → ".join([*above[-3:], path])
        reader.wrong(node, "circle", f"recipes must not call one another in a circle: {way}")
        return None
    source = Source(path, text.decode("utf-8", "replace"))
    recipe, found = read_recipe(source, reader.setup, fetch, reader.able, above, names, reader.made)
    reader.found.extend(found)
    return None if found else recipe
