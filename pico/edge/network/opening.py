"""Opening the edge of a bench and its memory: at a coordinator, else of who serves it here, else in this process."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from pico.attachment import bench_folder
from pico.model.setup import Setup

if TYPE_CHECKING:
    from pico.backends.device import Capabilities
    from pico.edge.link.line import Line
    from pico.edge.network.remotes import Far
    from pico.edge.protocol import Edge, Holder, OwnLab
    from pico.runs.memory import Memory


def opened(
    setup: Setup, root: Path, backend: str, fidelity: str, lab: OwnLab | None = None, far: Far | None = None
) -> Edge:  # fmt: skip
    """Return the edge of the bench of the lab in `root`, or of the bench `far` of a coordinator: the one that serves
    it, else one in this process.

    `lab`: what `setup` was read from. Raises PicoError for a backend that there is not.
    """
    line = line_of(root, far)
    if line is None:
        from pico.edge.local import embedded

        return embedded(setup, root, backend, fidelity, lab)
    from pico.edge.link.client import RemoteEdge

    return RemoteEdge(line)


def line_of(root: Path, far: Far | None = None) -> Line | None:
    """Return the line to the edge of a bench, None where none serves it."""
    if far is not None:
        from pico.edge.network.line import line_to

        return line_to(far)
    if not (bench_folder(root) / "edge.json").exists():
        return None
    from pico.edge.link.line import SocketLine
    from pico.edge.link.place import find

    socket = find(root)
    return None if socket is None else SocketLine(socket, root)


def own_lab(root: Path, far: Far | None = None) -> OwnLab | None:
    """Return the Lab that a bench keeps as its own; None where it keeps none yet. Raises PicoError where it can't be
    read."""
    line = line_of(root, far)
    if line is None:
        from pico.edge import own_lab

        return own_lab.read(root)
    found: OwnLab | None = line.call("lab")
    return found


def served(root: Path, far: Far | None = None) -> Capabilities | None:
    """Return what the process can do that serves a bench; None where none does."""
    line = line_of(root, far)
    able: Capabilities | None = None if line is None else line.call("describe")
    return able


def holder_of(root: Path, far: Far | None = None) -> Holder | None:
    """Return who moves a bench, None where nobody does."""
    if far is None:
        from pico.edge.lease import BenchLock

        return BenchLock(root).holder()
    line = line_of(root, far)
    found: Holder | None = None if line is None else line.call("holder")
    return found


@contextmanager
def remembered(root: Path, far: Far | None = None) -> Iterator[Memory | None]:
    """Give what a bench remembers of its runs, only to read it, and None where there was none yet. Raises PicoError
    where it can't be read."""
    line, path = line_of(root, far), bench_folder(root) / "journal.sqlite"
    if line is not None:
        from pico.edge.link.client import RemoteEdge

        yield RemoteEdge(line).memory
    elif path.exists():
        from pico.runs.journal import Journal

        with closing(Journal(path, looking=True)) as journal:
            yield journal
    else:
        yield None
