"""The light that the samples of a bench have had: counted by the edge from operation to operation, by the name of the
sample, in `dose.json` beside its journal."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.backends.device import Began
from pico.base.state_files import DOSE, JOURNAL
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult
from pico.model.setup import Setup
from pico.model.trace.dose import Dose
from pico.places.bench import BenchPlace
from pico.policy import dose

if TYPE_CHECKING:
    from pico.edge.attempts import Executing


@dataclass(frozen=True)
class Ledger:
    """What samples had at a time of the bench's clock (`at` [s]): `spent` [mJ], and the `power` [mW] on them, by their
    names. `least`: samples that had at least that, for they were counted again from the journal, or light fell on them
    that was not followed to its end. `unknown`: why more than `power` may fall on some now."""

    at: float | None = None
    spent: dict[str, float] = field(default_factory=dict)
    power: dict[str, float] = field(default_factory=dict)
    least: frozenset[str] = frozenset()
    unknown: Mapping[str, str] = field(default_factory=dict)

    def until(self, setup: Setup, seen: Observation) -> Ledger:
        """Return it brought up to what is seen now: since then each sample had the greater of both powers. A clock that
        began anew, with another simulated world, counts nothing."""
        held = dose.samples(setup)
        falling, beyond = dose.falling(setup, seen)
        now = {held[part]: power for part, power in falling.items()}
        unknown = {held[part]: why for part, why in beyond.items()}
        seconds = max(0.0, seen.time - self.at) if self.at is not None else 0.0
        more = {name: max(power, self.power.get(name, 0.0)) * seconds for name, power in now.items()}
        spent = {**self.spent, **{name: self.spent.get(name, 0.0) + one for name, one in more.items()}}
        return Ledger(seen.time, spent, now, self.least | unknown.keys(), unknown)

    def doses(self, setup: Setup) -> tuple[Dose, ...]:
        """Return what each sample of a bench has had, and gets."""
        return tuple(
            Dose(sample=sample, component=part, spent=self.spent.get(sample, 0.0), power=self.power.get(sample, 0.0),
                 budget=setup.lab.inventory[part].dose_budget, at_least=sample in self.least or None,
                 unknown=self.unknown.get(sample))
            for part, sample in dose.samples(setup).items()
        )  # fmt: skip


def read(place: BenchPlace) -> Ledger:
    """Return what the bench at `place` has counted; if its file is gone, what the results in its journal add up to.
    Raises PicoError for a file that can't be read: no sample may count as new for that."""
    return DOSE.read(DOSE.path(place.folder), _ledger) or _recounted(JOURNAL.path(place.folder))


def _recounted(path: Path) -> Ledger:
    """Return what samples had by the results in the journal at `path`; nothing if there is none. The light between
    operations is in no result."""
    if not path.is_file():
        return Ledger()
    from pico.runs.journal import Journal

    spent = dict[str, float]()
    with closing(Journal(path, looking=True)) as journal:
        for record in journal.records():
            had = (record.data.get("data") or {}).get("dose") or {}
            for sample, one in had.items():
                spent[sample] = spent.get(sample, 0.0) + float(one)
    return Ledger(spent=spent, least=frozenset(spent))


def _ledger(found: Mapping[str, Any]) -> Ledger:
    at, spent, power = float(found["at"]), found["spent"], found["power"]
    least = frozenset(map(str, found.get("least", ())))
    return Ledger(at, {str(k): float(v) for k, v in spent.items()}, {str(k): float(v) for k, v in power.items()}, least)


def counted(setup: Setup, place: BenchPlace, seen: Observation) -> Ledger:
    """Count until now, write that down, and return it; raises PicoError."""
    ledger = read(place).until(setup, seen)
    least = {"least": sorted(ledger.least)} if ledger.least else {}
    made = {"at": ledger.at, "spent": ledger.spent, "power": ledger.power, **least}
    DOSE.write(DOSE.path(place.folder), made, indent=1)
    return ledger


class Dosing:
    """A device that counts the light on samples, and does nothing that would give one more than its budget. What they
    had in an operation stands in its result (`dose`, [mJ] by sample)."""

    def __init__(
        self, setup: Setup, place: BenchPlace, inner: Executing, look: Callable[[], Awaitable[Observation]]
    ) -> None:
        self._setup, self._place, self._inner, self._look = setup, place, inner, look

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Execute an operation; one that gives a sample too much fails, and nothing is done."""
        seen = await self._look()
        before = counted(self._setup, self._place, seen)
        alone: Any = replace(operation, start=0.0)
        if wrong := dose.refused(self._setup, seen, before.doses(self._setup), [alone]):
            return OperationResult(key=key, outcome="failed", error=wrong[0], ended=seen.time)
        result = await self._inner.execute(operation, key, began)
        after = counted(self._setup, self._place, await self._look())
        had = {n: mj - before.spent.get(n, 0.0) for n, mj in after.spent.items() if mj > before.spent.get(n, 0.0)}
        return replace(result, data={**result.data, "dose": had}) if had else result
