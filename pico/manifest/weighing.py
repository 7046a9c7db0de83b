"""What is told of files that are not read, once the state is known: may they hold parts that would else go home?"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

from pico.diagnostics import Diagnostic
from pico.manifest.file_names import AWAY, GONE, UNSEEN, SetAside, about, set_aside_from
from pico.model.setup import Setup
from pico.model.state import LabState


def weighed(found: Iterable[Diagnostic], setup: Setup | None, state: LabState | None) -> list[Diagnostic]:
    """Return diagnostics with an error for each thing unseen or set aside, where it may name a part that would else go
    home; of what is gone nothing where anything is wrong, for what can't be read may hold its parts."""
    every = list(found)
    aside = [d for d in every if isinstance(d, SetAside)]
    every = [d for d in every if not isinstance(d, SetAside)]
    inventory = setup.lab.inventory if setup else {}
    homeless = {name for name, part in inventory.items() if part.home is not None}
    homeless -= state.components.keys() if state else set()
    if homeless or not (setup and state):
        every = [replace(d, severity="error") if d.code == UNSEEN else d for d in every]
    if setup and state and homeless:
        told = {d.source.path for d in every if d.severity == "error" and d.source}
        every += [e for d in aside if d.path not in told for e in _holding(d, setup.lab.name, homeless)]
    refused = any(d.severity == "error" or d.code == UNSEEN for d in every)
    return [d for d in every if not (refused and d.code == GONE)]


def _holding(found: SetAside, lab: str, homeless: Collection[str]) -> list[Diagnostic]:
    """Return an error for a state of the lab that was set aside, where it names parts that no other does."""
    from pico.manifest.edit import components_of

    names = ", ".join(sorted(components_of(found.data, lab) & set(homeless)))
    text = f"a state with {names} that is not read, and no other file names {names}"
    hint = f"call it `{set_aside_from(found.path)}`, in a folder that is read; if {names} shall go home: {AWAY}"
    return [about(found.path, "name", text, hint)] if names else []
