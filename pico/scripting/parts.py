"""One part of a bench: its tunables and measurables as attributes, and what is done with it."""

from __future__ import annotations

from typing import Any, cast

from pico.diagnostics import PicoError, did_you_mean, error
from pico.model.observation import slot_at
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.shown.html import number, table
from pico.model.trace.report import RunReport
from pico.scripting.protocol import Scripted
from pico.scripting.readings import Measurable
from pico.scripting.tunables import Tunable


class Part:
    """`bench["p1"]`.

    >>> p1 = bench["p1"]
    >>> p1.angle = 10              # degrees, its unit; blocks until it is there
    >>> p1.angle += 5              # from where it is
    >>> p1.move(x=300, yaw=5)      # mm, deg; what is not named stays
    >>> p1.move("storage/b1")
    """

    name: str

    def __init__(self, bench: Scripted, name: str) -> None:
        object.__setattr__(self, "_bench", bench)
        object.__setattr__(self, "name", name)

    _bench: Scripted

    def __repr__(self) -> str:
        values = [f"{k} {number(v)}" for k, v in self._known().items()]
        return f"<{self.name}: {', '.join([self.type, str(self.slot or self.pose or 'not seen'), *values])}>"

    def _repr_html_(self) -> str:
        known = self._known()
        rows = [("pose", str(self.slot or self.pose or "not seen"), "mm, mm, deg")]
        rows += [(t.tunable, number(known.get(t.tunable, "unknown")), t.unit) for t in self.tunables.values()]
        return table(f"{self.name}: {self.type}", ("tunable", "value", "unit"), rows)

    @property
    def type(self) -> str:
        """The name of its component type."""
        return self._bench.setup.lab.inventory[self.name].type

    @property
    def tunables(self) -> dict[str, Tunable]:
        """Its tunables by name."""
        return {t: Tunable(self._bench, self.name, t) for t in self._bench.setup.type_of(self.name).tunables}

    @property
    def measurables(self) -> dict[str, Measurable]:
        """What can be measured of it, by name."""
        own = self._bench.setup.type_of(self.name).measurables
        return {m: Measurable(self._bench, f"{self.name}.{m}") for m in own}

    @property
    def pose(self) -> Pose | None:
        """Where it is seen to stand: x, y [mm], yaw [deg]; None where nobody sees it stand."""
        part = self._bench.seen().components.get(self.name)
        return part.pose if part is not None and part.presence == "seen" else None

    @property
    def slot(self) -> str | None:
        """The slot that it is in; None where it is in none."""
        pose = self.pose
        return slot_at(self._bench.setup, pose) if pose and self._bench.setup.movable(self.name) else None

    def move(self, slot: str | None = None, **pose: float) -> RunReport:
        """Have an arm take it to a slot, or to `x`, `y` [mm] and `yaw` [deg]; what is not named stays as it is. Raises
        PicoError where that can't be, and where it failed."""
        if slot is not None and pose:
            text = f"move of {self.name}: a slot, or a pose, not both"
            raise PicoError(
                error("request", text, hint='`move("storage/b1")`, or `move(x=300, yaw=5)`', address=self.name)
            )
        return self._bench.move({self.name: slot if slot is not None else pose})

    def do(self, primitive: str, **arguments: Value) -> RunReport:
        """Have another primitive done with it: `cam.do("auto_range")`, `p1.do("home", tunable="angle")`. Raises
        PicoError."""
        return self._bench.do(self.name, primitive, **arguments)

    def measure(self, measurable: str) -> Any:
        """Measure something of it, also by kernels (`image | centroid`), and return the reading; raises PicoError."""
        return self._bench.measure(f"{self.name}.{measurable}")

    def read(self) -> dict[str, dict[str, Any]]:
        """Return all its tunables as ophyd has them: value and time by name."""
        return {k: v for t in self.tunables.values() for k, v in t.read().items()}

    def describe(self) -> dict[str, dict[str, Any]]:
        """Return what `read` gives: where each is from, its type, unit and limits."""
        return {k: v for t in self.tunables.values() for k, v in t.describe().items()}

    @property
    def parent(self) -> None:
        """None: a part is of no other."""
        return None

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_"):
            kind = self._bench.setup.type_of(self.name)
            if name in kind.tunables:
                return Tunable(self._bench, self.name, name)
            if name in kind.measurables:
                return Measurable(self._bench, f"{self.name}.{name}")
        raise AttributeError(self._unknown(name))

    def __setattr__(self, name: str, value: Value | Tunable) -> None:
        """Set a tunable, and return when it is there; raises PicoError."""
        kind = self._bench.setup.type_of(self.name)
        if isinstance(value, Tunable) and value.address == f"{self.name}.{name}":
            return  # `p1.angle += 5` has set it, and assigns the tunable to its own name
        if name not in kind.tunables:
            if name in ("pose", "slot"):
                raise AttributeError(f"{self.name} goes to another {name} by `move`")
            if name in kind.measurables:
                raise AttributeError(f"{name} of {self.name} is measured, and can't be set")
            raise AttributeError(self._unknown(name))
        self._bench.set({f"{self.name}.{name}": cast("Value", value)})

    def __dir__(self) -> list[str]:
        kind = self._bench.setup.type_of(self.name)
        return sorted({*super().__dir__(), *kind.tunables, *kind.measurables})

    def _unknown(self, name: str) -> str:
        kind = self._bench.setup.type_of(self.name)
        known = [*kind.tunables, *kind.measurables]
        hint = did_you_mean(name, known) or f"it has {', '.join(known) or 'nothing'}"
        return f"{self.name} has no `{name}`: {hint}"

    def _known(self) -> dict[str, Value]:
        return self._bench.seen().known_values.get(self.name, {})
