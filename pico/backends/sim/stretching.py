"""Operations that take longer, or shorter, than the plan reckons: by what the twin learned from the bench."""

from __future__ import annotations

from collections.abc import Generator
from typing import TypeVar

from pico.backends.attempt import Failed

T = TypeVar("T")


def stretched(work: Generator[float, None, T], factor: float) -> Generator[float, None, T]:
    """Do `work`, each wait of which takes `factor` times as long; what is raised into this is raised into that."""
    if factor == 1.0:
        return (yield from work)
    try:
        wait = next(work)
        while True:
            try:
                yield factor * wait
            except Failed as exc:
                wait = work.throw(exc)
            else:
                wait = next(work)
    except StopIteration as stop:
        found: T = stop.value
        return found
    finally:
        work.close()
