"""Whether the kernels that measurables name are there, and fit what they are given; imports no numpy."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.kernels.pipeline import Pipeline, misfit, parsed
from pico.manifest.text.places import where
from pico.manifest.text.tree import Document
from pico.model.catalog import ComponentType, Measurable


def check_kernels(document: Document, kind: ComponentType) -> Iterator[Diagnostic]:
    """Yield what is wrong with the kernels of a type's measurables, each at its place in the document."""
    for name, measurable in kind.measurables.items():
        if (measurable.kernel is None) == (measurable.datatype == "numbers"):
            text = f"`{name}` has numbers by name, and no kernel that makes them"
            if measurable.kernel is not None:
                text = f"`{name}` is made by a kernel, and not declared to be numbers by name"
            hint = "expected `datatype: numbers` with `kernel: image | centroid` or the like, or neither"
            yield error("kernel", text, hint=hint, source=where(document, "measurables", name, "datatype"))
        elif measurable.kernel is not None:
            at = where(document, "measurables", name, "kernel")
            try:
                pipeline = parsed(measurable.kernel)
            except PicoError as exc:
                yield from (replace(d, source=at) for d in exc.diagnostics)
                continue
            yield from (replace(d, source=d.source or at) for d in _fit(document, kind, name, measurable, pipeline))


def _fit(
    document: Document, kind: ComponentType, name: str, measurable: Measurable, pipeline: Pipeline
) -> Iterator[Diagnostic]:
    source = kind.measurables.get(pipeline.source)
    if source is None:
        known = [n for n, m in kind.measurables.items() if m.kernel is None]
        hint = did_you_mean(pipeline.source, known) or "expected one of the type's own `measurables`"
        yield error("kernel", f"`{name}` is made of `{pipeline.source}`, which {kind.name} does not measure", hint=hint)
        return
    if problem := misfit(pipeline, source.datatype):
        yield problem
    elif pipeline.last.gives != "numbers":
        text = f"`{pipeline.steps[-1].name}` gives an image, no numbers"
        yield error("kernel", text, hint="append a kernel such as `| centroid`")
    elif measurable.unit != pipeline.last.unit:
        at = where(document, "measurables", name, "unit" if measurable.unit else "kernel")
        text = f"the unit of `{name}` is {measurable.unit or 'not given'}, and its kernel has {pipeline.last.unit}"
        yield error("unit", text, hint=f"expected `unit: {pipeline.last.unit}`", source=at)
