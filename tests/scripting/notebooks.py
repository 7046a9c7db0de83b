"""Executes notebooks as their reader would see them, without Jupyter: what a cell prints, and what its last line is."""

from __future__ import annotations

import ast
import base64
import contextlib
import io
import json
import os
import re
from pathlib import Path
from typing import Any

_VARIES = re.compile(r"\d{8}T\d{6}Z-[0-9a-f]{6}|/\S*/(?=shel)|\d{4}-\d\d-\d\dT[\d:.]+Z")
"""Ids of runs, folders and times: another each time."""


def executed(notebook: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return a notebook with the outputs that its cells give in a new folder; what a cell raises goes to the caller."""
    names: dict[str, Any] = {"__name__": "__main__"}
    cells, count, here = [], 0, Path.cwd()
    os.chdir(folder)
    try:
        for cell in notebook["cells"]:
            if cell["cell_type"] != "code":
                cells.append(cell)
                continue
            count += 1
            outputs = run_cell("".join(cell["source"]), names, count)
            cells.append({**cell, "execution_count": count, "outputs": outputs})
    finally:
        os.chdir(here)
    return {**notebook, "cells": cells}


def run_cell(source: str, names: dict[str, Any], count: int) -> list[dict[str, Any]]:
    """Return the outputs of one cell."""
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    printed, value = io.StringIO(), None
    with contextlib.redirect_stdout(printed):
        exec(compile(tree, "<cell>", "exec"), names)
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), "<cell>", "eval"), names)
    found: list[dict[str, Any]] = []
    if printed.getvalue():
        found.append({"output_type": "stream", "name": "stdout", "text": printed.getvalue().splitlines(keepends=True)})
    if value is not None:
        found.append({"output_type": "execute_result", "execution_count": count, "metadata": {}, "data": shown(value)})
    return found


def shown(value: Any) -> dict[str, Any]:
    """Return a value in each form that it has, as Jupyter keeps them."""
    data: dict[str, Any] = {"text/plain": repr(value).splitlines(keepends=True)}
    if html := getattr(value, "_repr_html_", lambda: None)():
        data["text/html"] = html.splitlines(keepends=True)
    if png := getattr(value, "_repr_png_", lambda: None)():
        data["image/png"] = base64.b64encode(png).decode()
    return data


def same(notebook: dict[str, Any]) -> str:
    """Return what must be the same each time that a notebook is executed: all text, and that there is a picture."""
    told = json.dumps(notebook, sort_keys=True, indent=1, ensure_ascii=False)
    return _VARIES.sub("…", re.sub(r'("image/png": )"[^"]*"', r"\1…", told))


def written(notebook: dict[str, Any], path: Path) -> None:
    """Write a notebook as Jupyter does."""
    path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False, sort_keys=True) + "\n", encoding="utf-8")
