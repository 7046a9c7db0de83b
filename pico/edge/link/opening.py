"""Opening the edge of a bench and its memory: of the process that serves it, else in this one."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from pico.attachment import bench_folder
from pico.model.setup import Setup

if TYPE_CHECKING:
    from pico.backends.device import Capabilities
    from pico.edge.protocol import Edge, OwnLab
    from pico.runs.memory import Memory


def opened(setup: Setup, root: Path, backend: str, fidelity: str, lab: OwnLab | None = None) -> Edge:
    """Return the edge of the bench of the lab in `root`: the one that serves it, else one in this process.

    `lab`: what `setup` was read from. Raises PicoError for a backend that there is not.
    """
    socket = _served(root)
    if socket is None:
        from pico.edge.local import embedded

        return embedded(setup, root, backend, fidelity, lab)
    from pico.edge.link.client import RemoteEdge

    return RemoteEdge(socket, root)


def _served(root: Path) -> Path | None:
    if not (bench_folder(root) / "edge.json").exists():
        return None
    from pico.edge.link.place import find

    return find(root)


def own_lab(root: Path) -> OwnLab | None:
    """Return the Lab that the bench of the lab in `root` keeps as its own; None where it keeps none yet. Raises
    PicoError where it can't be read."""
    socket = _served(root)
    if socket is None:
        from pico.edge import own_lab

        return own_lab.read(root)
    from pico.edge.link.client import Line

    found: OwnLab | None = Line(socket).call("lab")
    return found


def served(root: Path) -> Capabilities | None:
    """Return what the process can do that serves the bench of the lab in `root`; None where none does."""
    socket = _served(root)
    if socket is None:
        return None
    from pico.edge.link.client import Line

    able: Capabilities = Line(socket).call("describe")
    return able


@contextmanager
def remembered(root: Path) -> Iterator[Memory | None]:
    """Give what the bench of the lab in `root` remembers of its runs, only to read it, and None where there was none
    yet. Raises PicoError where it can't be read."""
    socket, path = _served(root), bench_folder(root) / "journal.sqlite"
    if socket is not None:
        from pico.edge.link.client import RemoteEdge

        yield RemoteEdge(socket).memory
    elif path.exists():
        from pico.runs.journal import Journal

        with closing(Journal(path, looking=True)) as journal:
            yield journal
    else:
        yield None
