"""Pictures from disk measured by kernels: no bench, no lab."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from pico.diagnostics import ExitCode, PicoError, error

from ..session import Session
from ..views import pictures as view

_ABOVE_BLACK = ("light", "peak", "visibility")
_NO_BLACK = "the black level is taken as 0; --black-level COUNT gives that of the camera"


def measured(
    session: Session, kernels: Sequence[str], patterns: Sequence[str], at: Sequence[float], pixel_size: float | None,
    black_level: float | None, full_scale: float | None,
) -> int:  # fmt: skip
    """Show what each row of kernels makes of each picture, and return the exit code: an error if one is unknown.

    Raises PicoError for kernels or files that are none.
    """
    from pico.kernels.files import frame_from, pictures, places_of, read_picture
    from pico.kernels.kernel import Result
    from pico.kernels.pipeline import run
    from pico.kernels.series import along, split

    parsed = [(text, *split(text)) for text in kernels]
    files = pictures(patterns)
    if at and len(at) != len(files):
        raise PicoError(error("usage", f"{len(at)} places for {len(files)} pictures", hint="give --at once a picture"))
    series = any(last for _, _, last in parsed)
    if series and pixel_size is None:
        hint = "add --pixel-size MICROMETERS of the camera"
        raise PicoError(error("usage", "M2 needs the size of a pixel", hint=hint))
    places = tuple(at) or (places_of(files) if series else ())
    rows: list[view.Row] = []
    first: dict[str, list[Result]] = {text: [] for text in kernels}
    for file in files:
        try:
            frame = frame_from(read_picture(file), pixel_size or 1.0, black_level, full_scale)
        except ValueError as exc:
            raise PicoError(error("picture-file", f"{file.name}: {exc}", address=str(file))) from None
        for text, pipeline, last in parsed:
            found = run(pipeline, frame)
            if black_level is None and not found.unknown and pipeline.steps[-1].name in _ABOVE_BLACK:
                found = replace(found, remark="; ".join(filter(None, (found.remark, _NO_BLACK))))
            first[text].append(found)
            rows.append((str(file), " | ".join(step.name for step in pipeline.steps) if last else text, found))
    for text, _, last in parsed:
        if last is not None:
            for one in along(first[text], places, last):
                rows.append((f"{len(files)} pictures {one.axis}".strip(), text, one.result))
    session.show(view, rows, "um" if pixel_size else "px")
    return ExitCode.ERROR if any(found.unknown for _, _, found in rows) else ExitCode.DONE


def require_alone(picture: Path | None, dry_run: bool) -> None:
    """Raise PicoError for options that are of a measurement at the bench."""
    if picture is not None or dry_run:
        name = "--dry-run" if dry_run else "--picture"
        raise PicoError(error("usage", f"{name} is of the bench, and --image measures files", hint=f"leave out {name}"))
