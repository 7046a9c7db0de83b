"""Pictures of a recipe's run: where things are drawn, for numbers nobody thought of."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from pico.drawing.plots import curves, lineage, timeline
from pico.drawing.plots.axes import COLORS, FAINT

numbers = st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=6)


@settings(max_examples=15)
@given(numbers, st.floats(0, 100))
def test_any_numbers_are_drawn(values: list[float], sigma: float) -> None:
    """All points lie in the picture, and in their color."""
    sigmas = (sigma,) * len(values)
    one = curves.Curve("a", tuple(values), tuple(values), sigmas, tuple(reversed(values)))
    image = curves.picture("t", "x", "y", [one], ["a note " * 40])
    assert (image == COLORS[0]).all(axis=2).sum() > 64 + 20  # more than its mark in the legend
    assert image.shape[1] == 860


def test_agreement_is_told() -> None:
    one = curves.Curve("a", (0.0, 1.0), (0.0, 3.0), (1.0, 1.0), (1.0, 0.0))
    assert one.off == (-1.0, 3.0)
    assert one.said == "a: 1 of 2 within 2 sigma, chi2/n 5.00"
    assert curves.Curve("a", (0.0,), (0.0,)).said == "a"


def test_a_branch_has_its_own_row_and_what_went_back_an_arc() -> None:
    """The second child of a commit goes below; an arc is drawn only between commits that are."""
    nodes = [lineage.Node(one, (parent,), (one,)) for one, parent in (("a", ""), ("b", "a"), ("c", "a"), ("d", "c"))]
    plain, arced = (lineage.picture("t", nodes, back) for back in ((), (("b", "a"),)))
    assert [(plain == COLORS[n]).all(axis=2).any() for n in range(3)] == [True, True, False]
    assert (lineage.picture("t", nodes, [("b", "elsewhere")]) == plain).all()
    changed = np.argwhere((plain != arced).any(axis=2))
    assert len(changed) and (arced[tuple(changed[len(changed) // 2])] != plain[tuple(changed[len(changed) // 2])]).any()
    assert (arced == FAINT).all(axis=2).sum() > (plain == FAINT).all(axis=2).sum()


def test_a_lane_is_as_long_as_its_work() -> None:
    """Half of the time is half of the width between the edges."""
    spans = [timeline.Span("moving", 0.0, 50.0), timeline.Span("measuring", 50.0, 100.0)]
    image = timeline.picture("t", spans, {0.0: "a", 0.1: "b", 100.0: "c"})
    widths = [(image == color).all(axis=2).any(axis=0).sum() for color in COLORS[:2]]
    assert abs(widths[0] - widths[1]) <= 1 and widths[0] == round((1200 - 110 - 30) / 2)
