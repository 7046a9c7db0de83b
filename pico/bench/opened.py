"""One bench that is open: its lab's folder, the edge that sees and moves it, and the one place that waits for it.

The edge is asynchronous, and its loop runs in a private thread that does nothing else. What a service computes it
computes in the thread of its caller: see `docs/decisions/0013-services.md`.
"""

from __future__ import annotations

from collections.abc import Coroutine, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, TypeGuard, TypeVar

from pico.backends.devices import HARDWARE, SIMULATOR, opener
from pico.base.clock import Waits
from pico.bench.running.loop import LoopThread
from pico.diagnostics import PicoError, did_you_mean, error
from pico.edge.network.meant import meant
from pico.edge.network.opening import holder_of
from pico.edge.network.remotes import Far, Place
from pico.history.lab.folder import LabFolder, Safety
from pico.history.lab_history import LabHistory
from pico.manifest.load import find_lab, find_lab_of_bench
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.model.state import LabState
from pico.places.bench import BenchPlace

if TYPE_CHECKING:
    from pico.backends.world import World
    from pico.edge.contract import Edge
    from pico.edge.local import LocalEdge
    from pico.model.operation import Operation

T = TypeVar("T")


class Opened:
    """One bench, opened by `open`: all that its services stand on. Close it when done; it opens again by itself."""

    def __init__(self, folder: LabFolder, place: Place, fidelity: str | None = None) -> None:
        self.folder, self.history, self.place = folder, LabHistory(folder), place
        self.backend_name = place.name
        """The device of the bench, such as `sim`; of one at a coordinator once that was asked."""
        self.fidelity = fidelity or folder.setup.lab.sim.fidelity
        self.asked = fidelity is not None
        """Whether somebody asked for this fidelity."""
        self.speed: float | None = None
        """Share of the joint limits at which robots move here; None: as the lab says."""
        self.lock_timeout = 0.0
        self.recording: str | None = None
        """The open run that what runs here is a step of, see `pico.scripting.recording`."""
        self.waits: Waits = ()
        """When a simulated bench, as it was seen last, was told to let time pass, and how long [s]."""
        self.thread = LoopThread()
        self._edge: Edge | None = None

    @classmethod
    def open(
        cls,
        path: str | Path = ".",
        *,
        backend: str | None = None,
        fidelity: str | None = None,
        speed: float | None = None,
        bench: str | Place | None = None,
        safety: Safety = "",
    ) -> Self:
        """Open the lab that `path` lies in. Nothing is contacted yet, but for a bench on the network.

        `bench`: `sim`, `emulated`, `hardware`, LAB/BENCH of a remote, or `pico://host/LAB/BENCH`; without it the one
        that `PICO_BENCH` or this worktree chose (`pico bench use`), but for the real one, which must be named here.
        `backend`: the bench of this machine with that device. `fidelity`: `kinematic` or `physics`, the lab's own word
        where None. `speed`: share of the joint limits for every robot, instead of the lab's. `safety`: to switch light
        off or to empty a hand, also if the manifests are wrong or gone, see `LabFolder`. Raises PicoError.
        """
        _require_fitting(fidelity, speed)
        if backend is not None:
            opener(backend)
        root = find_lab_of_bench(Path(path)) if safety else find_lab(Path(path))
        place = bench if isinstance(bench, BenchPlace | Far) else meant(root, backend=backend, word=bench)
        if not (bench or backend) and isinstance(place, BenchPlace) and place.name == HARDWARE:
            hint = 'open it with `bench="hardware"`; `bench="sim"` is the simulator'
            text = "this worktree chose the real bench, and a script must name that itself"
            raise PicoError(error("backend", text, hint=hint))
        folder = LabFolder(root, place=place, keeps=True, safety=safety)
        folder.setup = folder.setup.at_speed(speed)
        opened = cls(folder, place, fidelity)
        opened.speed = speed
        if isinstance(place, Far):
            opened._require_far(place, backend)
        elif place.name != SIMULATOR:
            _ = opened.edge  # says what is missing
        return opened

    def _require_far(self, far: Far, backend: str | None) -> None:
        """Be what the bench of a coordinator is; raises PicoError where somebody asked for another backend."""
        able = self.wait(self.edge.describe())
        if backend not in (None, able.name):
            text = f"{far.said} is a {able.name} bench, and this is for a {backend} one"
            raise PicoError(error("backend", text, hint="leave --backend out: the bench is what it is"))
        self.backend_name = able.name
        if not self.asked:
            self.fidelity = able.fidelity

    @property
    def far(self) -> Far | None:
        """The bench of a coordinator that this is; None for one of this machine."""
        return self.place if isinstance(self.place, Far) else None

    @property
    def root(self) -> Path:
        """The lab's folder."""
        return self.folder.root

    @property
    def setup(self) -> Setup:
        """The bench as it is now: lab and component types."""
        return self.folder.setup

    @property
    def state(self) -> LabState:
        """The desired state: what the manifests in the working tree say."""
        return self.folder.state

    @property
    def edge(self) -> Edge:
        """The edge, made when it is first needed; raises PicoError if its device can't be had."""
        if self._edge is None:
            from pico.edge.network.opening import opened, served

            able = None if self.far is not None else served(self.place)
            self._edge = opened(self.setup, self.place, self.fidelity, self.folder.own)
            if able is not None and not self.asked:
                self.fidelity = able.fidelity
        return self._edge

    def edge_for(self, operations: Sequence[Operation] | None) -> Edge:
        """Return the edge for a run of these operations, None for a run that stays open for any. If they may let light
        out of a real laser it is in a process of its own from now on: the guard of that light must not end with this
        one. Raises PicoError if that process can't begin."""
        from pico.planning.checks.emission import lets_out

        edge = self.edge
        if not self._guards(edge):
            return edge
        lit = operations is None or any(lets_out(self.setup, one) for one in operations)
        return self._handed_over(edge) if lit else edge

    def _guards(self, edge: Edge) -> TypeGuard[LocalEdge]:
        """Whether this process itself has the links of a real bench with lasers."""
        if self.place.name != HARDWARE:
            return False
        from pico.backends.device import LightGuarded
        from pico.edge.local import LocalEdge

        return isinstance(edge, LocalEdge) and isinstance(edge.device, LightGuarded) and edge.device.guards()

    def _handed_over(self, edge: Edge) -> Edge:
        from pico.edge.link.resident import ensure
        from pico.edge.network.opening import opened

        assert isinstance(self.place, BenchPlace)
        self.wait(edge.close())
        ensure(self.place)
        self._edge = opened(self.setup, self.place, self.fidelity, self.folder.own)
        return self._edge

    def _guarded_or_dark(self, edge: Edge) -> Edge:
        """Have the process that guards the bench beside any command take over light that is left on; if it can't begin,
        end that light. Nobody hears what is raised here: the next command says what became of it."""
        try:
            return self._handed_over(edge)
        except PicoError:
            with suppress(PicoError):
                self.wait(edge.end_light())
            return edge

    @property
    def sim(self) -> World:
        """The simulated world, to be changed as a hand would; raises PicoError where nothing is simulated."""
        return self.edge.world

    def wait(self, work: Coroutine[Any, Any, T]) -> T:
        """Have the edge do something, and return what comes of it or raise what it raises; Ctrl-C ends the waiting."""
        return self.thread.wait(work)

    def observe(self) -> Observation:
        """Look, and return what was seen."""
        seen = self.wait(self.edge.observe())
        self.waits = seen.waits or ()
        return seen

    def suit(self, plan: Plan) -> None:
        """Have the fidelity that a plan was made for."""
        if plan.backend == self.backend_name and plan.fidelity != self.fidelity:
            self.fidelity, self._edge = plan.fidelity, None

    def wait_until_free(self, seconds: float) -> None:
        """Wait until nobody moves the bench, at most so long here and again when it is taken.

        Raises PicoError (exit code LOCKED), naming who has it.
        """
        from pico.edge.lease import wait_until_free

        self.lock_timeout = seconds
        self.wait(wait_until_free(lambda: holder_of(self.place), seconds))

    def close(self) -> None:
        """Let go of the edge and end its thread; one left busy by Ctrl-C is not waited for."""
        if self.thread.elsewhere:  # it is the other process's to close
            return
        if (edge := self._edge) is not None and not self.thread.left_busy:
            if self._guards(edge) and edge.leaves_light():
                edge = self._guarded_or_dark(edge)
            self.wait(edge.close())
        self._edge = None
        self.thread.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _require_fitting(fidelity: str | None, speed: float | None) -> None:
    if fidelity not in (None, "kinematic", "physics"):
        known = ["kinematic", "physics"]
        raise PicoError(error("fidelity", f"there is no fidelity `{fidelity}`", hint=did_you_mean(fidelity, known)))
    if speed is not None and not 0 < speed <= 1:
        raise PicoError(error("speed", f"a speed of {speed:g} is no share of the joint limits", hint="0.01 to 1"))
