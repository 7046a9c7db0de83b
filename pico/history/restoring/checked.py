"""Physical changes taken back or done again: the manifests only, and only to what can stand on the table."""

from __future__ import annotations

import re
from collections.abc import Sequence

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.history.lab.folder import LabFolder
from pico.history.merge.checked import impossible, overlapping
from pico.history.restoring import selected as taken
from pico.history.restoring import transplant as carry
from pico.history.restoring.selected import SelectedParts
from pico.history.restoring.transplant import Transplanted
from pico.manifest.load import Manifests


def revert(
    folder: LabFolder, revision: str, *, message: str = "", mainline: int | None = None, commit: bool = True
) -> Transplanted:
    """Take back what a revision changed; see `restoring.transplant.revert`. Nothing moves, runs and notes stay."""
    return carry.revert(folder, revision, out_of_reach, message=message, mainline=mainline, commit=commit)


def cherry_pick(
    folder: LabFolder, revisions: Sequence[str], *, mainline: int | None = None, commit: bool = True
) -> tuple[Transplanted, ...]:
    """Do once more what revisions changed; see `restoring.transplant.cherry_pick`. Nothing moves, no run is copied."""
    return carry.cherry_pick(folder, revisions, out_of_reach, mainline=mainline, commit=commit)


def select_parts(folder: LabFolder, revision: str, names: Sequence[str]) -> SelectedParts:
    """Return what the manifests must say for components or tunables to be as in a revision; see `restoring.selected`.

    Raises PicoError as that does, and (exit 3) where one of them could not stand beside the rest of the manifest.
    """
    found = taken.select_parts(folder, revision, names)
    parts = {name.partition(".")[0] for name in found.names} if found.changes else set()
    wrong = [d for d in overlapping(found.manifests) if parts & set(re.findall(r"\w+", d.summary))]
    if wrong:
        hint = "name the other component, too, if it is to move as well; nothing was written"
        text = f"{revision} -- {' '.join(found.names)} does not fit the rest of the manifest"
        raise PicoError([*wrong, error("taken-impossible", text, hint=hint)], ExitCode.IMPOSSIBLE)
    return found


def out_of_reach(wanted: Manifests, before: Manifests) -> tuple[Diagnostic, ...]:
    """Return why a state can't stand, or why a bench in the state `before` can't be brought to it.

    A state before that could not stand itself was never on the bench: then the bench with every part at home counts.
    """
    try:
        stood = not overlapping(before)
    except PicoError:
        stood = False
    return impossible(wanted, before.state if stood else None)
