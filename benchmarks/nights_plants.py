"""Faults that are planted into a morning, to see that `nights.py` reports them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

Change = Callable[[Any], Any]


def _first_only(found: Any) -> Any:
    return replace(found, causes=found.causes[:1], repairs=found.repairs[:1])


def _nothing_if_moved(found: Any) -> Any:
    return replace(found, readings=(), causes=(), repairs=(), suspects=()) if found.moved else found


def _one_more(found: Any) -> Any:
    if not found.causes:
        return found
    like = replace(found.causes[0][0], part=_free(found), kind="dirt", probability=0.95, like=())
    return replace(found, causes=(*found.causes, (like,)), repairs=(*found.repairs, f"clean {like.part}"))


def _free(found: Any) -> str:
    """Return a part that the morning does not tell of."""
    told = {s.part for group in found.causes for s in group} | {p for g in found.causes for s in g for p in s.like}
    told |= {m.change.component for m in found.moved}
    return next(p for p in ("l3", "l2", "m1", "flip", "lx_100", "ly_200", "ref", "pick") if p not in told)


def _everything(found: Any) -> Any:
    parts = ("laser", "iso", "hwp", "l1", "l2", "m1", "m2", "iris", "pbs", "qwp", "flip", "fc", "pm")
    return replace(found, causes=tuple(tuple(replace(s, probability=0.5, like=parts) for s in g) for g in found.causes))


def _unlisted(found: Any) -> Any:
    kept = tuple(r for r in found.readings if r.name != "laser.monitor")
    return replace(found, readings=kept)


def _moved_unsaid(found: Any) -> Any:
    return replace(found, moved=found.moved[1:])


CHANGES: dict[str, tuple[str, Change]] = {
    "first-only": ("missed", _first_only),
    "nothing-if-moved": ("missed", _nothing_if_moved),
    "one-moved-unsaid": ("missed", _moved_unsaid),
    "one-more": ("false", _one_more),
    "everything": ("useless", _everything),
    "unlisted": ("unlisted", _unlisted),
    "overwrite": ("reference", lambda found: found),
}
"""By name: the sort of what must be reported, and what is done to the answer."""


def plant(name: str) -> Callable[[], None]:
    """Return what plants a fault into the program of this process; nothing for an empty name."""
    if not name:
        return lambda: None

    def planted() -> None:
        from pico.bench.mornings import Mornings

        judged, change = Mornings.judged, CHANGES[name][1]

        def other(self: Any, survey: Any, *rest: Any, **more: Any) -> Any:
            if name == "overwrite":
                survey = replace(survey, accept=True)
            return change(judged(self, survey, *rest, **more))

        Mornings.judged = other  # type: ignore[method-assign]

    return planted
