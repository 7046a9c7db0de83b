"""Looking at a bench again and again: what leaves HEAD, what is right again, and what was brought back."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator

from pico.bench.drift import Drift, Drifted, news
from pico.diagnostics import PicoError
from pico.model.record import record
from pico.model.report import RunReport

Heal = Callable[[Drifted], RunReport | None]


@record
class Told:
    """One look: what has drifted, or drifted on, since the one before it (`fresh`), the addresses of what is `right`
    again, and a `note` on what was healed, or why it was not. `first`: nothing was looked at before."""

    found: Drifted
    fresh: tuple[Drift, ...]
    right: tuple[str, ...]
    note: str = ""
    first: bool = False

    @property
    def new(self) -> bool:
        """Whether there is anything to tell."""
        return bool(self.fresh or self.right or self.note)


def watch(look: Callable[[], Drifted], heal: Heal | None, interval: float, looks: int | None) -> Iterator[Told]:
    """Yield every look, `interval` seconds apart, without an end where `looks` is None; raises PicoError as they do.

    `heal`: brings back what drifted, once for each thing that happens.
    """
    before: tuple[Drift, ...] = ()
    tried: set[str] = set()
    for number in itertools.count() if looks is None else range(looks):
        if number:
            time.sleep(interval)
        found = look()
        note = _healed(heal, found, tried) if heal else ""
        fresh, right = news(before, found.beyond)
        before = found.beyond
        yield Told(found=found, fresh=tuple(fresh), right=tuple(right), note=note, first=not number)


def _healed(heal: Heal, found: Drifted, tried: set[str]) -> str:
    """Bring back what drifted and was not `tried` yet; return what became of it."""
    now = {f"{d.address} {d.change.text}" for d in found.beyond if d.by != "operation"}
    if not now - tried:
        return ""
    if found.held:
        key = f"held: {found.held}"
        said = "" if key in tried else f"not healed: {found.held}"
        tried.add(key)
        return said
    tried.clear()
    tried |= now
    try:
        report = heal(found)
    except PicoError as exc:
        return f"not healed: {exc.diagnostics[0].summary}"
    if report is None:
        return ""
    if report.exit_code:
        return f"healing {report.outcome}: run {report.run}"
    return f"healed: {report.done} operations"
