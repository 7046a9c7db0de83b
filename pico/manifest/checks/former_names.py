"""Whether the former names of parts (`formerly:`) are names of one part each."""

from __future__ import annotations

from collections.abc import Iterator

from pico.diagnostics import Diagnostic, error
from pico.manifest.text.names import name_problem
from pico.manifest.text.places import where
from pico.manifest.text.tree import Document
from pico.model.lab import Lab


def check_former_names(document: Document, lab: Lab) -> Iterator[Diagnostic]:
    """Yield what is wrong with the former names of a lab's parts, each at its place in the document."""
    owner: dict[str, tuple[str, int]] = {}
    for name, part in lab.inventory.items():
        for n, old in enumerate(part.formerly or ()):
            at = where(document, "inventory", name, "formerly", n)
            if problem := name_problem(old):
                text = f"the former name `{old[:40]}` of {name} is not a name"
                yield error("name", text, hint=f"expected {problem}", source=at)
            elif old in lab.inventory:
                text = f"{name} was formerly called {old}, but {old} is a part of this lab"
                hint = f"take {old} out of `formerly`, or give the other part another name"
                yield error("formerly", text, hint=hint, address=name, source=at)
            elif old in owner:
                other, place = owner[old]
                detail = f"{other} has it at {where(document, 'inventory', other, 'formerly', place)}"
                text = (
                    f"{name} and {other} both claim the former name {old}" if other != name else f"{old} is there twice"
                )
                hint = "keep it at the part that had this name"
                yield error("formerly", text, detail=detail, hint=hint, address=name, source=at)
            else:
                owner[old] = (name, n)
