"""Pictures of a run of a recipe: the commits that it made, its trace, and the figures that it declares."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError, error
from pico.drawing.plots import curves, lineage, timeline
from pico.model.primitive import primitive
from pico.recipes.figures.retold import Retold, require_returned
from pico.recipes.log import About
from pico.recipes.recipe import Figure, Recipe
from pico.runs.document import recorded
from pico.runs.operations import operations

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.drawing.picture import Image

COMMITS, TRACE = "commits", "trace"
_KINDS = {"set": "setting", "home": "setting", "auto_range": "exposing", "optimize": "aligning", "verify": "aligning",
          "measure": "measuring"}  # fmt: skip


def curves_of(figure: Figure, returns: Mapping[str, Any], run: str) -> tuple[curves.Curve, ...]:
    """Return the curves of a figure; raises PicoError where lists differ in length, numbers are
    not finite, or there is not one point."""
    found = []
    for one in figure.series:
        x, y, sigma, theory = (_numbers(returns.get(name)) for name in (one.x, one.y, one.sigma, one.theory))
        if any(len(values) != len(x) for values in (y, *filter(None, (sigma, theory)))):
            names = ", ".join(filter(None, (one.x, one.y, one.sigma, one.theory)))
            raise PicoError(error("figure", f"in run {run} {names} of {one.label} differ in length"))
        if not all(map(math.isfinite, (*x, *y, *sigma, *theory))):
            raise PicoError(error("figure", f"in run {run} not all numbers of {one.label} are finite"))
        found += [curves.Curve(one.label, x, y, sigma, theory)] if x else []
    if not found:
        raise PicoError(error("nothing", f"run {run} returned no numbers to plot as {figure.name}"))
    return tuple(found)


def pictures(
    bench: Bench, recipe: Recipe, about: About, found: Retold
) -> Iterator[tuple[str, Callable[[], Image]]]:  # fmt: skip
    """Yield the names of the pictures of a run of a recipe, each with what draws it; raises PicoError where the run
    came to no end, for then it returned nothing."""
    title, notes = f"{recipe.title or recipe.name}, run {about.id}", recipe.notes
    if any(ask.step and ask.step.kind == "commit" for ask, _ in found.acts):
        yield COMMITS, lambda: _lineage(bench, title, found, notes)
    yield TRACE, lambda: _timeline(bench, title, found, notes)
    for figure in recipe.figures.values():
        drawn = curves_of(figure, require_returned(found, recipe.name, about.id), about.id)
        yield figure.name, lambda f=figure, d=drawn: curves.picture(f"{f.title}, run {about.id}", f.x, f.y, d, notes)  # type: ignore[misc]


def _numbers(value: Any) -> tuple[float, ...]:
    return tuple(float(v) for v in (value if isinstance(value, list | tuple) else () if value is None else (value,)))


def _lineage(bench: Bench, title: str, found: Retold, notes: tuple[str, ...]) -> Image:
    history, made, back, named = bench.folder.history(), list[str](), list[tuple[str, str]](), dict[str, str]()
    head = ""
    for ask, known in found.acts:
        kind = ask.step.kind if ask.step else ""
        if kind == "commit":
            head = str(known.told[""]) if known.told else head
            made.append(head)
        elif kind == "checkout":
            there = named.get(ask.given["revision"]) or history.resolve(ask.given["revision"]).id
            back += [(head, there)] if head and there != head else []
            head = there
            made += [there] if there not in made else []
        elif kind == "tag":
            named[str(ask.given["name"])] = head
    tags = {commit: name for name, commit in named.items()}
    commits = [history.resolve(one) for one in dict.fromkeys(made)]
    nodes = [
        lineage.Node(c.id, c.parents, (tags.get(c.id, c.label), *_two_lines(c.summary))) for c in commits
    ]  # fmt: skip
    return lineage.picture(title, nodes, back, notes)


def _two_lines(summary: str) -> tuple[str, ...]:
    words = summary.split()
    cut = next((n for n in range(1, len(words) + 1) if len(" ".join(words[:n])) > 13), len(words))
    return tuple(filter(None, (" ".join(words[: max(1, cut - 1)]), " ".join(words[max(1, cut - 1) :]))))


def _timeline(bench: Bench, title: str, found: Retold, notes: tuple[str, ...]) -> Image:
    memory = bench.edge.memory
    runs = {one.run: one for one in memory.runs()} if memory else {}
    spans, marks, now, seen = list[timeline.Span](), dict[float, str](), 0.0, set[str]()
    for ask, known in found.acts:
        if ask.step and ask.step.kind in ("tag", "checkout"):
            marks[now] = str(ask.given.get("name") or f"→ {ask.given['revision']}")
        for run in (r for r in known.runs if r in runs and r not in seen):
            seen.add(run)
            one = recorded(bench.setup, memory, runs[run]) if memory else None
            done = [op for op in operations(one.trace) if op.start is not None and op.seconds] if one else []
            spans += [
                timeline.Span(
                    _kind(op.primitive), now + (op.start or 0.0), now + (op.start or 0.0) + (op.seconds or 0.0)
                )
                for op in done
            ]
            now = max([now, *(span.end for span in spans[-len(done) :])]) if done else now
    if not spans:
        raise PicoError(error("nothing", "this bench remembers nothing of what the recipe did"))
    return timeline.picture(title, spans, marks, notes)


def _kind(name: str) -> str:
    return "moving" if primitive(name).by == "arm" else _KINDS.get(name, name)
