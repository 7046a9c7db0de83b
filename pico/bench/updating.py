"""The bench's own Lab against the one that the working tree describes: what differs, and adopting it.

No bench is opened for it: a state that names a part of the new Lab can't be read against the old one.
"""

from __future__ import annotations

import asyncio
import difflib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from pico.edge import own_lab
from pico.edge.link.opening import opened
from pico.edge.link.opening import own_lab as kept
from pico.execution.stale import edited
from pico.model.record import record

if TYPE_CHECKING:
    from pico.edge.protocol import Edge, OwnLab

DOING = "pico bench update"


@record
class Proposal:
    """What the working tree would have the bench be: the digests of both, what differs in words (the first few) and as
    a unified diff of the files, from the bench to the tree. Comments alone may differ; the digests are then one."""

    bench: str
    tree: str
    differences: tuple[str, ...] = ()
    patch: str = ""

    @property
    def new(self) -> bool:
        """Whether there is anything to adopt."""
        return bool(self.patch)


def proposal(root: Path) -> Proposal:
    """Return what the working tree of the lab in `root` proposes; nothing new where its bench keeps no Lab yet. Raises
    PicoError for what is wrong with either."""
    tree = own_lab.proposed(root)
    own = kept(root) or tree
    wanted, now = own_lab.setup_of(tree), own_lab.setup_of(own)
    patch = "".join(_patch(own.files, tree.files))
    return Proposal(bench=now.digest(), tree=wanted.digest(), differences=tuple(edited(now, wanted)), patch=patch)


async def adopt(edge: Edge, root: Path) -> OwnLab:
    """Let the bench of an edge adopt what the working tree in `root` describes, and return that; raises PicoError as
    `Edge.adopt` does."""
    tree = own_lab.proposed(root)
    await edge.adopt(tree, DOING)
    return tree


def update(root: Path, backend: str) -> None:
    """Let the bench of the lab in `root` adopt what the working tree describes; raises PicoError as `adopt` does."""
    own = kept(root) or own_lab.proposed(root)
    setup = own_lab.setup_of(own)

    async def go() -> None:
        edge = opened(setup, root, backend, setup.lab.sim.fidelity, own)
        try:
            await adopt(edge, root)
        finally:
            await edge.close()

    asyncio.run(go())


def _patch(before: Mapping[str, str], after: Mapping[str, str]) -> Iterator[str]:
    for name in sorted(before.keys() | after.keys()):
        old, new = (files.get(name, "").splitlines(keepends=True) for files in (before, after))
        for line in difflib.unified_diff(old, new, f"bench/{name}", f"tree/{name}", n=2):
            yield line if line.endswith("\n") else f"{line}\n"
