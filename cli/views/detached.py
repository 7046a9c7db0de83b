"""A recipe that was run beside the coordinator: what it said, and what came back of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .style import count


def line(document: Mapping[str, Any]) -> str:
    """Return the line of a document that it said, empty for one that needs none."""
    if document.get("event") == "step":
        depth = str(document["path"]).count(".") + 1
        return f"{'  ' * depth}{document['title']}"
    if document.get("schema") == "pico.question/v1":
        return f"asks: {document['text']} (answered in the page, or by `pico runs attach` at a terminal)"
    if document.get("schema") == "pico.diagnostics/v1":
        return "\n".join(f"{one['severity']}[{one['code']}]: {one['summary']}" for one in document["diagnostics"])
    if document.get("schema") == "pico.recipe_run/v1":
        return f"{document['recipe']}: {document['outcome']}"
    return ""


def text(about: Mapping[str, Any], branch: str) -> str:
    """Return how it ended, and where its commits and runs are."""
    runs = len(about["runs"])
    said = f"Run {about['id']} has ended with exit code {about['exit']}; {count(runs, 'run')} at {about['bench']}"
    if runs:
        said += f", which {'that branch or ' if branch else ''}the next `pico commit` carries"
    return f"{f'Its commits are on the branch {branch}: `pico merge {branch}`. ' if branch else ''}{said}."


def data(about: Mapping[str, Any], branch: str) -> dict[str, Any]:
    """Return schema `pico.detached/v1`: the `run`, its `exit`, its `runs` at the bench, and the `branch` of its
    commits, empty where it made none."""
    return {
        "schema": "pico.detached/v1", "run": about["id"], "exit": about["exit"], "runs": about["runs"],
        "branch": branch,
    }  # fmt: skip
