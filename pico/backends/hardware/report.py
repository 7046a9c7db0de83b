"""The reports of commissioning, as the folder of a lab has them."""

from __future__ import annotations

import json
from pathlib import Path

from pico.base import clock
from pico.diagnostics import PicoError, error
from pico.disk import write_whole
from pico.model.commissioning import CODE, FILES, FORMAT, Commissioning
from pico.model.record import as_json

LARGEST = 4 * 1024 * 1024


def read(root: Path, bench: str) -> Commissioning | None:
    """Return the report of a bench of the lab in `root`, None where there is none; raises PicoError where its file is
    something else."""
    path = root / FILES[bench]
    try:
        if not path.exists():
            return None
        if path.stat().st_size > LARGEST:
            raise ValueError("too large")
        return _report(json.loads(path.read_bytes()))
    except (OSError, ValueError, RecursionError) as exc:
        hint = "bring it back from Git, or delete it and begin anew: `pico commission`"
        why = str(exc).splitlines()[0][:80]
        raise PicoError(error(CODE, f"{path.name} is no report of a commissioning: {why}", hint=hint)) from exc


def write(root: Path, report: Commissioning) -> Path:
    """Write a report into the folder of the lab in `root`, and return the file; raises PicoError."""
    path = root / FILES[report.bench]
    write_whole(path, (json.dumps(as_json(report), indent=2, ensure_ascii=False) + "\n").encode())
    return path


def _report(document: object) -> Commissioning:
    from pydantic import TypeAdapter

    found: Commissioning = TypeAdapter(Commissioning).validate_python(FORMAT.lifted(document))
    for step in found.steps.values():
        clock.parse_zoned(step.at)
    return found
