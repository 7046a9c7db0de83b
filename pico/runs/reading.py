"""Reading what a commit carries of a run. It may be damaged, of a newer PICO, or written by somebody else altogether:
then that is said, by name."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import fields, replace
from functools import cache
from typing import Any

from pico.diagnostics import Diagnostic, warning
from pico.model.record import as_json
from pico.model.trace.run import FOLD, FORMAT, SHARED, Run, TraceEvent

LARGEST = 1 << 20
"""Bytes above which no document of a run is read."""
_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,99}")
_STATE = re.compile(r"sha256:[0-9a-f]{64}")
_HASH = re.compile(r"[0-9a-f]{64}")
_DAY = re.compile(r"\d{4}-\d{2}-\d{2}T\d{2}:\d{2}:\d{2}[.0-9]*(?:Z|[+-]\d{2}:\d{2})")


def read_document(path: str, data: bytes, name: str) -> Run | Diagnostic:
    """Return the document of the run `name`, or a warning that names the file and says what is wrong with it.

    Keys that this version does not know are passed over.
    """
    if len(data) > LARGEST:
        return _damaged(path, f"it has {len(data)} bytes, and no document of a run is larger than {LARGEST}")
    try:
        content = _from_json(data)
    except ValueError as exc:
        return _damaged(path, str(exc))
    try:
        content = FORMAT.lifted(content)
    except ValueError as exc:
        return warning("run-file", f"{path} is {exc}")
    try:
        document = _checked(content, Run)
    except ValueError as exc:
        return _damaged(path, str(exc))
    wrong = _wrong(document, name)
    return _damaged(path, wrong) if wrong else on_its_bench(document)


def on_its_bench(document: Run) -> Run:
    """Return the document of a run with its bench; one of an earlier PICO says only which device that had."""
    return document if document.bench else replace(document, bench=document.environment.get("backend"))


def read_events(path: str, data: bytes, diagnostics: list[Diagnostic] | None = None) -> tuple[TraceEvent, ...]:
    """Return the events of a `trace.jsonl` or `measurements.jsonl`; lines that are none are passed over.

    A warning that names the file and the first such line is appended to `diagnostics`.
    """
    found, wrong = [], []
    for number, line in enumerate(data.split(b"\n"), 1):
        if line:
            try:
                content = _from_json(line)
                if not isinstance(content, dict):
                    raise ValueError("it is no object")
                found.append(_checked(content, TraceEvent))
            except ValueError as exc:
                wrong.append((number, str(exc)))
    if wrong and diagnostics is not None:
        more = f", and {len(wrong) - 1} more lines" if len(wrong) > 1 else ""
        diagnostics.append(_damaged(f"{path}, line {wrong[0][0]}{more}", wrong[0][1]))
    return tuple(found)


def members(document: Run) -> tuple[Run, ...]:
    """Return the documents of the runs that are folded into one, those that can be read; none where nothing is."""
    shared = {key: value for key, value in as_json(document).items() if key in SHARED} if document.folded else {}
    found = []
    for own in document.folded:
        with suppress(ValueError):
            one = _checked({**shared, **own}, Run)
            found += [one] if not _wrong(one, one.id) else []
    return tuple(found)


def _wrong(document: Run, name: str) -> str:
    """Return what no document that PICO wrote has."""
    if document.id != name or not _ID.fullmatch(name):
        return f"it says that it is of the run {document.id[:60]!r}"
    if not _DAY.fullmatch(document.started_at) or (document.ended_at and not _DAY.fullmatch(document.ended_at)):
        return "it does not say when the run was"
    if document.folded or name.endswith(FOLD):
        ids = {one.id for one in members(document)} - {name}
        if len(ids) < 2 or len(ids) != len(document.folded):
            return "it does not list each of the runs that are folded into it"
    named = [f.sha256 for f in document.files.values()] + [a.sha256 for a in document.artifacts]
    if not all(_HASH.fullmatch(sha256) for sha256 in named):
        return "it names a file by what is no SHA-256"
    states = (document.state_before, document.state_after)
    return "" if all(_STATE.fullmatch(s) for s in states) else "it does not say which states the run led from and to"


def _from_json(data: bytes) -> Any:
    from pydantic_core import from_json

    return from_json(data, allow_inf_nan=False)


def _checked(content: Mapping[str, Any], kind: type) -> Any:
    """Return a record; raises ValueError (in one line) where `content` is none."""
    from pydantic import ValidationError

    known = {field.name for field in fields(kind)}
    try:
        return _adapter(kind).validate_python({k: v for k, v in content.items() if k in known})
    except ValidationError as exc:
        first = exc.errors()[0]
        raise ValueError(f"{'.'.join(str(word) for word in first['loc'])}: {first['msg']}") from None


@cache
def _adapter(kind: type) -> Any:
    from pydantic import TypeAdapter

    return TypeAdapter(kind)


def _damaged(path: str, why: str) -> Diagnostic:
    hint = "`git log -- FILE` shows who changed it; the commit that carried the run first has it as it was"
    return warning("run-file", f"{path} is damaged", detail=why[:300], hint=hint)
