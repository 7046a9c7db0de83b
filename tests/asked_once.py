"""What the arms of a bench answer is remembered from test to test: hundreds of tests work on the same few labs, and two
thirds of the time of a move goes into its path, found and checked twice. A path hangs on nothing but what is asked."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pytest

ASKING = frozenset(
    {"backends", "bench", "cli", "edge", "execution", "history", "recipes", "releases", "scripting", "server"}
)
"""Folders of tests that ask arms for paths and test something else."""
_answers: dict[Hashable, Any] = {}
_benches: dict[int, tuple[Any, str]] = {}


def once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have arms answer from what they have answered, until the test ends."""
    from pico.motion.arms import ArmMotion

    for name in ("move", "park", "set_down"):
        monkeypatch.setattr(ArmMotion, name, _remembering(name, getattr(ArmMotion, name)))


def _remembering(name: str, ask: Callable[..., Any]) -> Callable[..., Any]:
    def answer(arms: Any, *given: Any, **more: Any) -> Any:
        key = (name, _bench(arms.setup), arms.second_check, *map(_fixed, given), _fixed(more))
        if key not in _answers:
            _answers[key] = ask(arms, *given, **more)
        return _answers[key]

    return answer


def _bench(setup: Any) -> str:
    """Return all that is in a lab and its types, as text."""
    from pico.model.record import canonical

    known = _benches.get(id(setup))
    if known is None or known[0] is not setup:
        known = _benches[id(setup)] = (setup, canonical({"lab": setup.lab, "types": setup.catalog}))
        if len(_benches) > 20:
            del _benches[next(iter(_benches))]
    return known[1]


def _fixed(given: Any) -> Hashable:
    if isinstance(given, Mapping):
        return tuple(sorted((name, _fixed(value)) for name, value in given.items()))
    return tuple(given) if isinstance(given, list) else given
