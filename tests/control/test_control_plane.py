"""The control plane under a simulated network: see `plane.py`. Bugs are planted by `benchmarks/control_plane.py`."""

from __future__ import annotations

from plane import histories


def test_no_history_breaks_an_invariant() -> None:
    found = [one for _, one in histories(50_000, 120)]
    assert not [one for one in found if isinstance(one, Exception)]
    assert sum(sim.crashes for sim in found) > 1000 and sum(sim.cuts for sim in found) > 500  # type: ignore[union-attr]
