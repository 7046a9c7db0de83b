"""What a command takes, read from its file as text: Tab must wait neither for typer nor for what a command imports."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Any

Declared = tuple[dict[str, str], list[str]]
"""The metavars of options, by name and empty for flags, and those of arguments, in order."""


def declared(file: str) -> dict[str, Declared]:
    """Return what the command in a file takes, or each command of the group in it by its name; "" is a single one."""
    path = Path(file)
    tree, shared = (
        ast.parse(p.read_text(encoding="utf-8")) for p in (path, Path(__file__).parents[1] / "arguments.py")
    )
    named = {n.targets[0].id: n.value for n in (*shared.body, *tree.body)
             if isinstance(n, ast.Assign) and isinstance(n.targets[0], ast.Name)}  # fmt: skip
    found = {_name(node, path.stem): node for node in tree.body if isinstance(node, ast.FunctionDef)}
    return {name: _taken(node, named) for name, node in found.items() if name is not None}


def _name(function: ast.FunctionDef, single: str) -> str | None:
    """Return the name of a group's command, empty for the one command of a file; None for another function."""
    for call in function.decorator_list:
        if isinstance(call, ast.Call) and ast.unparse(call.func) == "app.command":
            given = [n.value for n in ast.walk(call) if isinstance(n, ast.Constant)]
            return str(given[0]) if given else function.name.replace("_", "-")
    return "" if function.name == single else None


def _taken(function: ast.FunctionDef, named: dict[str, Any]) -> Declared:
    options: dict[str, str] = {}
    arguments: list[str] = []
    for argument in function.args.args[1:]:
        annotation: Any = named.get(getattr(argument.annotation, "id", ""), argument.annotation)
        if ast.unparse(annotation).partition("[")[0] != "Annotated":
            continue  # typer makes something of it, but nothing says what Tab could offer
        kind, call = annotation.slice.elts
        metavar = next((k.value.value for k in call.keywords if k.arg == "metavar"), "VALUE")
        if call.func.attr == "Argument":
            arguments.append(metavar)
        else:
            words = [a.value for a in call.args] or [f"--{argument.arg.replace('_', '-')}"]
            options |= dict.fromkeys(words, "" if ast.unparse(kind) == "bool" else metavar)
    return options, arguments
