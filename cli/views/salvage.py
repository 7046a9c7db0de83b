"""What can be salvaged of a damaged journal, and what would be lost."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .style import columns, count

if TYPE_CHECKING:
    from pico.bench.mending.journal import Salvaged

MOST = 20
"""So many lost runs are listed."""


def text(found: Salvaged) -> str:
    """Return what a new journal holds, what is lost with the old one, and what to call."""
    if not found.damaged:
        return f"The journal of {found.bench} is intact: {count(found.made.intact, 'run')}. Nothing was changed."
    made, would = found.made, "" if found.written else "would be "
    said = [f"The journal of {found.bench} is damaged: {found.broken or 'rows in it are not as they were written'}"]
    said.append(f"  {count(made.intact, 'run')} {would}kept as they are")
    if made.from_commits:
        said.append(f"  {count(len(made.from_commits), 'run')} {would}taken from commits")
    said.append(f"  {count(len(made.lost), 'run')} {would}lost: no commit has them")
    rows = [[one.run, one.started_at[:16].replace("T", " "), ", ".join(one.what[:3])] for one in made.lost[:MOST]]
    said += columns(rows, indent="    ") if rows else []
    if found.broken:
        said.append("  Runs that no commit has and that stood in the unreadable part are lost, too, and not listed.")
    if made.lost or found.broken:
        said.append(
            "  A part that a hand took in a lost run, and axes that were set in one, are unknown afterwards: "
            "look at the bench before you move it."
        )
    if found.written:
        old = f"the old one is in {found.aside}" if found.aside else "there was no old one to set aside"
        said += ["", f"The new journal is in place; {old}."]
    else:
        said += ["", "Nothing was changed. `pico doctor --journal --yes` does this and sets the old journal aside."]
    return "\n".join(said)


def data(found: Salvaged) -> dict[str, Any]:
    """Return schema `pico.salvage/v1`: `bench`, the `journal`, whether it is `damaged`, how many runs are `intact`, the
    ids of those taken `from_commits`, the `lost` runs (`run`, `started_at`, `what` of each is damaged), and where the
    old journal lies now (`aside`)."""
    lost = [{"run": one.run, "started_at": one.started_at, "what": list(one.what)} for one in found.made.lost]
    return {
        "schema": "pico.salvage/v1", "bench": found.bench, "journal": str(found.path), "damaged": found.damaged,
        "intact": found.made.intact, "from_commits": list(found.made.from_commits), "lost": lost,
        "aside": str(found.aside) if found.aside else None,
    }  # fmt: skip
