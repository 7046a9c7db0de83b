"""What a watch heals: what drifted is brought back each time that it drifts, a part so often in a while and no more."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, field

from pico.bench.drifting.drift import Drift, Drifted
from pico.diagnostics import PicoError
from pico.model.lab import HealLimit
from pico.model.trace.report import RunReport

Heal = Callable[[Drifted, Collection[str]], RunReport | None]
"""Brings back what drifted of all components but some; returns None if there was nothing that an operation could do."""


@dataclass(eq=False)
class Healing:
    """What one watch has healed and said. `clock`: seconds, from any time on."""

    heal: Heal
    limit: HealLimit
    clock: Callable[[], float]
    _times: dict[str, list[float]] = field(default_factory=dict)
    _stopped: set[str] = field(default_factory=set)
    _failed: set[str] = field(default_factory=set)
    _said: set[str] = field(default_factory=set)

    def after(self, found: Drifted) -> str:
        """Bring back what one look found and may be healed; return what became of it and what is left as it is, empty
        where there is nothing new to say."""
        mine = [d for d in found.beyond if d.by != "operation"]
        self._failed &= {_key(d) for d in mine}
        notes = [
            f"left as it is: {d.address}, set by {d.how or 'an operation'}" for d in found.beyond if d.by == "operation"
        ]
        if found.held:
            notes += [f"not healed: {found.held}"] if mine else []
            return self._new(notes)
        notes += self._limited({d.change.component for d in mine})
        now = [d for d in mine if d.change.component not in self._stopped and _key(d) not in self._failed]
        if not now:
            return self._new(notes)
        names = sorted({d.change.component for d in now})
        leave = {d.change.component for d in mine} - set(names)
        said = self._new(notes)
        return "; ".join(one for one in (said, self._healed(found, now, names, leave)) if one)

    def _healed(self, found: Drifted, now: Iterable[Drift], names: list[str], leave: Collection[str]) -> str:
        """Heal some components and return what became of it; what failed is tried again only after it drifts on."""
        keys = {_key(d) for d in now}
        try:
            report = self.heal(found, leave)
        except PicoError as exc:
            self._failed |= keys
            return f"not healed: {exc.diagnostics[0].summary}"
        if report is None:
            self._failed |= keys
            return f"not healed: no operation brings back {', '.join(names)}"
        if report.exit_code:
            self._failed |= keys
            return f"healing {report.outcome}: run {report.run}"
        for name in names:
            self._times.setdefault(name, []).append(self.clock())
        return f"healed: {', '.join(names)}, {report.done} {'operation' if report.done == 1 else 'operations'}"

    def _limited(self, names: Collection[str]) -> list[str]:
        """Return which components are not healed any more, and why, after they drifted once more."""
        since, told = self.clock() - 60 * self.limit.minutes, []
        for name in sorted(names):
            recent = [at for at in self._times.get(name, ()) if at >= since]
            if len(recent) >= self.limit.times:
                self._stopped.add(name)
            if name in self._stopped:
                often = f"healed {name} {self.limit.times} times in {self.limit.minutes:g} min"
                told.append(f"{often}; stopped healing it: find what moves it, then start the watch again")
        return told

    def _new(self, notes: list[str]) -> str:
        """Return notes that were not said at the look before."""
        fresh, self._said = [n for n in notes if n not in self._said], set(notes)
        return "; ".join(fresh)


def _key(one: Drift) -> str:
    return f"{one.address} {one.change.text}"
