"""Physical changes taken back or done again: the manifests only, and only to what can stand on the table."""

from __future__ import annotations

from collections.abc import Sequence

from pico.diagnostics import Diagnostic, PicoError
from pico.history import carry
from pico.history.carry import Carried
from pico.history.folder import LabFolder
from pico.manifest.load import Manifests
from pico.merging import impossible, overlapping


def revert(
    folder: LabFolder, revision: str, *, message: str = "", mainline: int | None = None, commit: bool = True
) -> Carried:
    """Take back what a revision changed; see `pico.history.carry.revert`. Nothing moves, runs and notes stay."""
    return carry.revert(folder, revision, out_of_reach, message=message, mainline=mainline, commit=commit)


def cherry_pick(
    folder: LabFolder, revisions: Sequence[str], *, mainline: int | None = None, commit: bool = True
) -> tuple[Carried, ...]:
    """Do once more what revisions changed; see `pico.history.carry.cherry_pick`. Nothing moves, no run is copied."""
    return carry.cherry_pick(folder, revisions, out_of_reach, mainline=mainline, commit=commit)


def out_of_reach(wanted: Manifests, before: Manifests) -> tuple[Diagnostic, ...]:
    """Return why a state can't stand, or why a bench in the state `before` can't be brought to it.

    A state before that could not stand itself was never on the bench: then the bench with every part at home counts.
    """
    try:
        stood = not overlapping(before)
    except PicoError:
        stood = False
    return impossible(wanted, before.state if stood else None)
