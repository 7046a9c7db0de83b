"""Changes that were taken back, or done once more."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.history.restoring.transplant import Transplanted
from pico.model.record import as_json

from .diff import lines
from .style import listed, paint


def text(done: Sequence[Transplanted], *, before: str) -> str:
    """Return what was written, and how to go back to the commit `before`."""
    block = [line for one in done for line in _one(one)]
    made = [one for one in done if one.commit]
    written = sorted({path for one in done for path in one.files})
    if made:
        back = "pico revert HEAD" if len(made) == 1 else f"git reset --keep {before[:7]}"
        block += ["", "Only manifests changed, nothing moved: `pico plan` shows what would.", f"Go back with `{back}`."]
    elif written:
        block += ["", f"Written, not committed: {listed(written)}. Nothing moved: `pico plan` shows what would."]
        block.append(f"Commit with `pico commit --planned -m ...`; go back with `git restore {' '.join(written)}`.")
    return "\n".join(block)


def _one(one: Transplanted) -> list[str]:
    title = f'{one.name} "{one.summary}"' if one.name != one.of[:7] else f'{paint("yellow", one.name)} "{one.summary}"'
    if not one.files:
        what = "this state has nothing of it to take back" if one.way == "revert" else "this state has that already"
        return [f"{title}: {what}. Nothing to do."]
    did = "Took back" if one.way == "revert" else "Picked"
    commit = f" [{paint('yellow', one.commit[:7])}]" if one.commit else ""
    return [f"{did} {title}{commit}", *(lines(one.changes) or ["  nothing changed on the table"])]


def data(done: Sequence[Transplanted], **_: Any) -> dict[str, Any]:
    """Return schema `pico.carried/v1`: for each change `way`, `of`, `commit`, `files`, `changes`, `diagnostics`."""
    return {"schema": "pico.carried/v1", "carried": as_json(done)}
