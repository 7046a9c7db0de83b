"""What is wrong with a plug-in, as one diagnostic of code `plugin`: its kind, its name, its package, its own file and
line, the words of its exception, and what to do."""

from __future__ import annotations

import inspect
import linecache
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, Position, SourceRange, error
from pico.plug_ins.known import PlugIn, own_file, plug_in_of

CODE = "plugin"


def broken(one: PlugIn, why: str, at: object = None) -> PicoError:
    """Return the error of a plug-in that is not what it should be: `why` follows its title; `at`: its module or
    function."""
    source = None
    with suppress(TypeError, OSError):
        if at is not None and (path := inspect.getsourcefile(inspect.unwrap(at) if callable(at) else at)):  # type: ignore[arg-type]
            line = at.__code__.co_firstlineno if hasattr(at, "__code__") else 1
            source = _line(path, line)
    return PicoError(error(CODE, f"{one.title} {why}", hint=_hint(one), source=source))


def blamed(exc: BaseException, more: Mapping[str, str] = {}) -> Diagnostic | None:
    """Return the fault of a plug-in by whose code an exception came, by the frames that it went through; None if it
    went through none. `more`: as `pico.plug_ins.known.FOLDERS`."""
    for frame in reversed(_frames(exc)):
        if (one := _of(frame, more)) is not None:
            return fault(one, exc, "failed")
    return None


def fault(one: PlugIn, exc: BaseException, what: str) -> Diagnostic:
    words = " ".join(str(exc.msg if isinstance(exc, SyntaxError) else exc).split())[:300]
    said = f"{type(exc).__name__}: {words}" if words else type(exc).__name__
    return error(CODE, f"{one.title} {what}: {said}", hint=_hint(one, exc), source=_place(one, exc))


def _hint(one: PlugIn, exc: BaseException | None = None) -> str:
    if not one.package:
        return "correct the file, or remove it"
    without = f"`pip uninstall {one.package}`"
    if isinstance(exc, ModuleNotFoundError) and exc.name:
        top = exc.name.partition(".")[0]
        if top == one.module.partition(".")[0]:
            return f"`pip install --force-reinstall {one.package}` if its files are damaged, or {without}"
        return f"`pip install {top}` if that is the package it lacks, or {without}"
    return f"correct the file, or {without}"


def _place(one: PlugIn, exc: BaseException) -> SourceRange | None:
    """Return the line of the plug-in's own file at which an exception came; its file if there is no such line."""
    if isinstance(exc, SyntaxError) and exc.filename:
        return _line(exc.filename, exc.lineno or 1)
    top, trace = one.module.partition(".")[0], exc.__traceback__
    found = None
    while trace is not None:
        module, path = str(trace.tb_frame.f_globals.get("__name__", "")), trace.tb_frame.f_code.co_filename
        if module == one.module or (module.partition(".")[0] == top != "pico" and not own_file(path)):
            found = path, trace.tb_lineno
        trace = trace.tb_next
    if found is not None:
        return _line(*found)
    file = getattr(sys.modules.get(one.module), "__file__", None)
    return _line(file, 1) if file else None


def _line(path: str, line: int) -> SourceRange:
    text = linecache.getline(path, line).rstrip("\n")
    begins = len(text) - len(text.lstrip()) + 1
    return SourceRange(path, Position(line, begins), Position(line, max(len(text), begins) + 1), text)


def _frames(exc: BaseException) -> list[Any]:
    found, trace = [], exc.__traceback__
    while trace is not None:
        found.append(trace.tb_frame)
        trace = trace.tb_next
    return found


def own_met_it(exc: BaseException) -> bool:
    """Whether PICO's own code, called by the plug-in, met an exception last."""
    named = [f for f in _frames(exc) if own_file(f.f_code.co_filename) or _of(f)]
    last = named[-1].f_code.co_filename if named else ""
    return own_file(last) and Path(last).parent != Path(__file__).parent


def _of(frame: Any, more: Mapping[str, str] = {}) -> PlugIn | None:
    return plug_in_of(str(frame.f_globals.get("__name__", "")), frame.f_code.co_filename, more)
