"""Pictures of what a change does to the table, from above: before with what is to move, and after."""

from __future__ import annotations

from pathlib import Path

from pico.bench.checking.candidate import Candidate, Origin, start
from pico.bench.checking.verdict import LabChecked, Picture
from pico.disk import writing


def draw(candidate: Candidate, before: Origin, found: LabChecked, folder: Path, stem: str) -> tuple[Picture, ...]:
    """Draw a lab before and after into `folder` as STEM-before.png and STEM-after.png, and return them; none where
    nothing differs or where it can't be read. Raises PicoError where a file can't be written."""
    if found.plan is None or not found.changes:
        return ()
    from pico.bench.picturing.contents import goals, marks, standing, steps
    from pico.drawing.picture import render, write_png

    setup, wanted = candidate.manifests.require()
    begin, _ = start(setup, before)
    with writing(folder, what=f"can't make the folder {folder}"):
        folder.mkdir(parents=True, exist_ok=True)
    first = render(
        setup, standing(setup, begin), {}, view="top",
        ghosts=goals(setup, found.plan), marks=marks(setup, found.plan), steps=steps(found.plan),
    )  # fmt: skip
    then = render(setup, standing(setup, wanted), {}, view="top")
    paths = (folder / f"{stem}-before.png", folder / f"{stem}-after.png")
    for image, path in zip((first, then), paths, strict=True):
        path.unlink(missing_ok=True)  # a link that somebody put there is not followed
        write_png(image, path)
    return Picture(title="before", path=str(paths[0])), Picture(title="after", path=str(paths[1]))
