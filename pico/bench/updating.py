"""The bench's own Lab against the one that the working tree describes: what differs, and adopting it."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from pico.edge import own_lab
from pico.execution.stale import edited
from pico.model.record import record

if TYPE_CHECKING:
    from pico.bench.async_bench import AsyncBench
    from pico.history.lab.folder import LabFolder


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


def proposal(folder: LabFolder) -> Proposal:
    """Return what the working tree proposes; raises PicoError for what is wrong with it."""
    assert folder.own is not None
    tree = own_lab.proposed(folder.root)
    wanted, now = own_lab.setup_of(tree), folder.setup
    patch = "".join(_patch(folder.own.files, tree.files))
    return Proposal(bench=now.digest(), tree=wanted.digest(), differences=tuple(edited(now, wanted)), patch=patch)


async def adopt(bench: AsyncBench) -> None:
    """Let the bench adopt what the working tree proposes; raises PicoError as `Edge.adopt` does."""
    tree = own_lab.proposed(bench.root)
    await bench.edge.adopt(tree, "pico bench update")
    bench.folder.adopt(tree)


def _patch(before: Mapping[str, str], after: Mapping[str, str]) -> Iterator[str]:
    for name in sorted(before.keys() | after.keys()):
        old, new = (files.get(name, "").splitlines(keepends=True) for files in (before, after))
        for line in difflib.unified_diff(old, new, f"bench/{name}", f"tree/{name}", n=2):
            yield line if line.endswith("\n") else f"{line}\n"
