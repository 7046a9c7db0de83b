"""What a command has changed that a full, failing or read-only disk did not let finish, and what not: by looking."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pico.base.state_files import WORLD
from pico.diagnostics import Diagnostic, warning
from pico.disk import of_disk
from pico.edge.network.remotes import Place
from pico.history.git.places import places, small
from pico.manifest.files import read_folder


class Standing:
    """How a lab stands with one of its benches: the simulated table, the manifests and HEAD. `begun`: a run began."""

    def __init__(self, place: Place) -> None:
        root, self.place, self.begun = place.root, place, False
        world = WORLD.path(place.folder)
        self.table = world.stat().st_mtime_ns if world.exists() else 0
        self.manifests = read_folder(root)[0]
        at = places(root)
        head = small(at.own / "HEAD").strip() if at else b""
        self.head = at and (head, small(at.common / head.removeprefix(b"ref: ").decode(errors="surrogateescape")))

    def told(self, found: Sequence[Diagnostic]) -> list[Diagnostic]:
        """Return `found` with a note of what is as it was, and what is not, where a disk is wrong, or where git failed
        and does not tell why."""
        if not any(of_disk(d) or d.code == "git" for d in found):
            return [*found]
        now = Standing(self.place)
        said = [
            "`pico status` shows what moved" if self.begun or now.table != self.table else "nothing moved",
            "the manifests are as they were" if now.manifests == self.manifests else "manifests changed: `git diff`",
            "no commit was made" if now.head == self.head else "HEAD moved: `git log -1`",
        ]
        return [*found, replace(warning("standing", "; ".join(said[: 3 if self.head else 2])), severity="note")]
