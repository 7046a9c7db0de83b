"""What `pico.open` gives: a bench with all its services, and what makes a script short."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from typing import Any, TypeVar, overload

from pico.bench.bench import Bench as Services
from pico.bench.commits import CommitMode
from pico.bench.plans import written
from pico.diagnostics import PicoError, did_you_mean, error
from pico.model.measurement import Measurement
from pico.model.observation import Observation, live_state
from pico.model.plan import Plan
from pico.model.quantities import QuantityError, Value, convert, example
from pico.model.state import LabState
from pico.model.trace.report import Committed, RunReport
from pico.runs.event_model import documents, units_of
from pico.scripting.outcome import require_done, require_possible
from pico.scripting.parts import Part
from pico.scripting.readings import Measurable, Reading
from pico.scripting.recording import Recording
from pico.scripting.status import Queue, Status
from pico.scripting.tables import Table
from pico.scripting.tunables import Tunable

T = TypeVar("T")
AXES = {"x": "mm", "y": "mm", "yaw": "deg"}
"""The axes of a pose, with their units."""


class Bench(Services):
    """One bench, for scripts and notebooks. Every call blocks until it is done, and raises PicoError in words.

    >>> bench = pico.open("labs/shel")
    >>> bench["p1"].angle = 10
    >>> bench.measure("cam.image | centroid")
    <cam.image | centroid: x 12.3 ± 0.04 um, y -3.1 ± 0.04 um, 1024 x 1280 uint16>
    """

    @cached_property
    def _queue(self) -> Queue:
        return Queue()

    def __repr__(self) -> str:
        where = f"{self.backend_name} ({self.fidelity}), {self.root.name}/"
        return f"<bench {self.setup.lab.name}: {len(self)} parts, {where}>"

    def _repr_html_(self) -> str:
        return self.live()._repr_html_()

    # parts and tunables by name

    @cached_property
    def parts(self) -> Mapping[str, Part]:
        """The parts of the inventory by name."""
        return {name: Part(self, name) for name in sorted(self.setup.lab.inventory)}

    def __iter__(self) -> Iterator[str]:
        return iter(self.parts)

    def __len__(self) -> int:
        return len(self.parts)

    def __contains__(self, name: object) -> bool:
        return name in self.parts

    def __getitem__(self, address: str) -> Any:
        """Return a part (`p1`), or a tunable or measurable of one (`p1.angle`, `cam.centroid`, `cam.image | centroid`).

        Raises KeyError, in words, for what there is not.
        """
        if not isinstance(address, str):
            raise KeyError(f"a part is called by its name, a text, not by {address!r}")
        name, dot, rest = address.partition(".")
        if name not in self.parts:
            known = did_you_mean(name, self.parts) or f"it has {', '.join(self.parts)}"
            raise KeyError(f"{self.setup.lab.name} has no `{name}`: {known}")
        if not dot:
            return self.parts[name]
        if "|" in rest:
            return Measurable(self, address)
        try:
            return getattr(self.parts[name], rest)
        except AttributeError as exc:
            raise KeyError(str(exc)) from None

    def seen(self) -> Observation:
        """Look, and return what is seen, without what light tells of it."""
        return self.wait(self.edge.observe())

    def live(self) -> LabState:
        """Return the state in which the bench is seen to be."""
        return live_state(self.setup, self.seen())

    # what a script does

    def set(self, values: Mapping[str, Value]) -> RunReport:
        """Set tunables by address, numbers in their units or texts with others, side by side as far as their motors
        can: `bench.set({"p1.angle": 10, "cam.exposure": "2 ms"})`. Raises PicoError where that can't be, or fails."""
        _require_entries(values, "set", '`bench.set({"p1.angle": 10})`')
        checked = {address: self._tunable(address).checked(value) for address, value in values.items()}
        return self.do_plan(lambda: self.plans.setting(checked))

    def move(self, places: Mapping[str, str | Mapping[str, float]]) -> RunReport:
        """Take parts to slots or poses, x and y [mm], yaw [deg], or texts with other units:
        `bench.move({"p2": {"x": 520}, "lx_100": "home"})`. Raises PicoError where that can't be, or fails."""
        _require_entries(places, "moved", '`bench.move({"p2": {"x": 520}, "lx_100": "home"})`')
        wanted = {name: self._place(name, place) for name, place in places.items()}
        return self.do_plan(lambda: self.plans.moving(wanted))

    def do(self, component: str, primitive: str, **arguments: Value) -> RunReport:
        """Do one primitive: `bench.do("cam", "auto_range")`; raises PicoError where that can't be, or fails."""
        return self.do_plan(lambda: self.single(component, primitive, **arguments))

    def home(self, address: str) -> RunReport:
        """Have an axis find its zero: `bench.home("p1.angle")`; raises PicoError."""
        component, _, tunable = address.partition(".")
        return self.do(component, "home", tunable=tunable)

    @overload
    def measure(self, what: str, /) -> Reading: ...

    @overload
    def measure(self, what: str, also: str, /, *more: str) -> tuple[Reading, ...]: ...

    def measure(self, *what: str) -> Reading | tuple[Reading, ...]:
        """Measure and return what was measured, in a run: `bench.measure("cam.centroid")`, by kernels
        `bench.measure("cam.image | centroid")`, several at once. Raises PicoError where there is no value."""
        from pico.kernels.pipeline import spelt

        if not what or not all(isinstance(one, str) for one in what):
            raise PicoError(error("request", "what is to be measured?", hint='such as `bench.measure("cam.centroid")`'))
        pairs = [(c.strip(), spelt(m)) for c, _, m in (one.partition(".") for one in what)]
        for component, measurable in pairs:
            if component not in self.setup.lab.cameras:
                self._found(component)
            self.setup.measurable_of(component, measurable)
        report = self.do_plan(lambda: self.plans.measuring(list(dict.fromkeys(pairs))))
        found = tuple(self._reading(report.measurements[f"{c}.{m}"]) for c, m in pairs)
        return found[0] if len(what) == 1 else found

    def _reading(self, found: Measurement) -> Reading:
        if found.unknown:
            text = f"{found.address} has no value: {found.unknown}"
            raise PicoError(error("unknown", text, hint=self.measurements.advice(found), address=found.address))
        return Reading(self, found)

    def pause(self, seconds: float) -> None:
        """Let time pass on the bench's clock [s]: a simulated one passes at once. Raises PicoError on a simulated bench
        while a run is recorded, for its time is that of the run."""
        if isinstance(seconds, bool) or not isinstance(seconds, int | float) or not 0 <= seconds < math.inf:
            raise PicoError(error("request", f"a pause of {seconds!r}", hint="seconds, a number from 0"))
        self._queue.idle()
        simulated = self.wait(self.edge.describe()).simulated
        if simulated and self.recording is not None:
            text = f"run {self.recording} is being recorded: simulated time passes only by what it does"
            raise PicoError(error("recording", text, hint="pause before its block, or after it"))
        if simulated:
            self.sim.wait(seconds)
        else:
            time.sleep(seconds)

    def record(self, name: str) -> Recording:
        """Return what makes one run of all that is done on the bench while it is entered.

        >>> with bench.record("scan") as run:
        ...     for angle in (10, 20, 30):
        ...         bench["p1"].angle = angle
        ...         bench.measure("cam.power")
        """
        return Recording(self, name)

    def apply(self, what: Plan | str | None = None) -> RunReport:
        """Run a plan, or the plan to a revision (the manifest for None), and return what became of it."""
        self._queue.idle()
        if what is not None and not isinstance(what, Plan):
            _require_revision(what)
        return super().apply(what)

    def plan(self, revision: str | None = None, **options: Any) -> Plan:
        """Return the plan to a revision, or to the manifest; see `Plans.plan`. Raises PicoError."""
        if revision is not None:
            _require_revision(revision)
        return super().plan(revision, **options)

    def do_plan(self, planning: Callable[[], Plan]) -> RunReport:
        """Make a plan once nothing is under way, run it and return the report; raises PicoError where it fails."""
        self._queue.idle()
        plan = require_possible(planning())
        return require_done(super().apply(plan))

    def ask(self, what: str, work: Callable[[], T]) -> Status[T]:
        """Have something done after what was asked for before, and return at once with the status of that."""
        self.thread.require_here()
        _ = self.edge  # made in the thread of who asks
        return Status(self._queue.ask(work), what, self.halt)

    def halt(self) -> None:
        """Bring what was asked for and is not over to its safe end; nothing where nothing is under way."""
        if self._queue.busy:
            self.wait(self.edge.halt())

    def commit(self, message: str | None = None, mode: CommitMode = "strict", **options: Any) -> Committed:
        """Capture and commit the manifests, with the runs that led to them; see `Commits.commit`. Raises PicoError
        while a run is recorded, which a commit can't carry before it is over."""
        if self.recording is not None:
            text = f"run {self.recording} is still being recorded, and a commit carries runs that are over"
            raise PicoError(error("recording", text, hint="commit after the block of `bench.record`"))
        return super().commit(message, mode, **options)

    def documents(self, run: str | None = None) -> Iterator[tuple[str, dict[str, Any]]]:
        """Return the documents of bluesky's event model of a run (the last one without it), each with its kind's name;
        raises PicoError for a run that there is not."""
        found, _ = self.history.recorded_run(run)
        return documents(found, units_of(self.setup))

    def table(self, run: str | None = None) -> Table:
        """Return what was measured in a run (the last one without it), a row each, beside the tunables that the run
        changed; raises PicoError for a run that there is not.

        >>> bench.table().plot(x="p1.angle", y="cam.centroid.x")
        """
        return Table(self.setup, self.history.recorded_run(run)[0])

    def metadata(self) -> dict[str, Any]:
        """Return what a scan of another tool should say of this bench: `pico_lab`, `pico_commit`, whether the manifests
        were edited since (`pico_dirty`), `pico_state`: the digest of the live state; while a run is recorded `pico_run`
        and the digest of its plan, `pico_plan`."""
        head = self.folder.head()
        committed = self.folder.committed()
        found: dict[str, Any] = {
            "pico_lab": self.setup.lab.name, "pico_lab_digest": self.setup.digest(),
            "pico_commit": head.commit if head and head.commit else "",
            "pico_dirty": committed is None or committed.digest() != self.state.digest(),
            "pico_state": self.live().digest(),
        }  # fmt: skip
        memory = self.edge.memory if self.recording is not None else None
        last = memory.last() if memory is not None else None
        return found | ({"pico_run": last.run, "pico_plan": last.plan} if last is not None else {})

    def close(self) -> None:
        """Let go of the bench, once what was asked for is over."""
        self._queue.close()
        super().close()

    def _tunable(self, address: str) -> Tunable:
        found = self._found(address)
        if not isinstance(found, Tunable):
            raise PicoError(error("unknown-tunable", f"{address} is no tunable", hint="such as `p1.angle`"))
        return found

    def _found(self, address: str) -> Any:
        try:
            return self[address]
        except KeyError as exc:
            raise PicoError(error("unknown", str(exc.args[0]))) from None

    def _place(self, name: str, place: str | Mapping[str, float]) -> str | Mapping[str, float]:
        self._found(name)
        part = self.setup.lab.inventory[name]
        if isinstance(place, str):
            slot = part.home if place == "home" and part.home else place
            if slot not in self.setup.lab.slots:
                hint = did_you_mean(slot, self.setup.lab.slots)
                raise PicoError(error("unknown-slot", f"there is no slot `{slot}`", hint=hint, address=name))
            return slot
        if not isinstance(place, Mapping) or not place or (wrong := place.keys() - AXES.keys()):
            shaped = isinstance(place, Mapping) and place
            text = f"move of {name} takes no `{sorted(map(str, wrong))[0]}`" if shaped else f"where to move {name}?"
            raise PicoError(error("request", text, hint="`x`, `y` [mm] and `yaw` [deg], or a slot", address=name))
        return {axis: _length(name, axis, value) for axis, value in place.items()}


def _require_entries(what: object, done: str, hint: str) -> None:
    if not isinstance(what, Mapping) or not what:
        raise PicoError(error("request", f"what is to be {done}?", hint=hint))


def _require_revision(what: object) -> None:
    if not isinstance(what, str):
        hint = "a plan, or the name of a commit, branch or tag; nothing for the manifest"
        raise PicoError(error("request", f"{what!r:.60} is no revision", hint=hint))


def _length(name: str, axis: str, value: object) -> float:
    """Return where a part is to go along an axis, in its unit; raises PicoError for what is no finite number."""
    unit, text = AXES[axis], written(value)
    try:
        number = _in_unit(text, unit)
        if not math.isfinite(number):
            raise QuantityError(f"`{text}` is no finite number; expected {example(unit)}")
    except QuantityError as exc:
        raise PicoError(error("request", f"{axis} of {name}: {exc}", address=name)) from exc
    return number


def _in_unit(text: str, unit: str) -> float:
    try:
        return float(text)
    except ValueError:
        return float(convert(text, unit))
