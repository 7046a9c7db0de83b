"""Suspects on the case study's bench: what is changed in the ray model is what is suspected, with its size."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from pico.diagnosis.causes import causes
from pico.diagnosis.choosing import Chosen, chosen, darks
from pico.diagnosis.nominal import Nominal, Step
from pico.diagnosis.quantities import Got
from pico.diagnosis.suspects import NOTHING, Compared, Verdict, suspects


@pytest.fixture(scope="module")
def what(nominal: Nominal) -> Chosen:
    return chosen(nominal)


def judged(nominal: Nominal, what: Chosen, steps: Sequence[Step], seed: int = 1) -> Verdict:
    """Return what is suspected after some changes, with noise as instruments have it."""
    draw = np.random.default_rng(seed)
    compared = []
    for one in (*what.quantities, *darks(nominal, ("cam",))):
        then, now = nominal.quantity(one), nominal.quantity(one, steps)
        if then is not None and now is not None:
            sigma = max(then.sigma, {"um": 0.1, "count": 0.01}.get(one.unit, 0.002))
            noise = sigma * draw.standard_normal(2)
            compared.append(Compared(one, Got(then.value + noise[0], sigma), Got(now.value + noise[1], sigma)))
    return suspects(nominal, compared, causes(nominal.setup, what.parts))


def test_each_polarizer_and_the_wave_plate_has_its_null(what: Chosen) -> None:
    assert {"p1 null", "p2 null", "hwp null", "cam.power", "cam.centroid.x"} <= {q.name for q in what.quantities}


def test_a_bench_says_what_it_lacks_to_tell_more(what: Chosen) -> None:
    assert len(what.lacks) == 2 and "pick-off" in what.lacks[0] and "second camera" in what.lacks[1]


@pytest.mark.parametrize("seed", range(3))
def test_nothing_is_suspected_where_nothing_happened(nominal: Nominal, what: Chosen, seed: int) -> None:
    found = judged(nominal, what, (), seed)
    assert found.suspects[0].kind == NOTHING and found.quiet > 0.9
    assert max(abs(c) for c in found.changes) < 4


@pytest.mark.parametrize(
    ("part", "what_of", "size", "kind"),
    [
        ("p1", "zero:angle", 0.4, "zero of angle"),
        ("p2", "zero:angle", -0.4, "zero of angle"),
        ("hwp", "zero:angle", 0.3, "zero of angle"),
        ("p1", "zero:angle", -1.4, "zero of angle"),
        ("p2", "zero:angle", 1.9, "zero of angle"),
        ("hwp", "zero:angle", -1.8, "zero of angle"),
        ("p1", "leak", 3.3, "extinction"),
        ("p2", "leak", 4.5, "extinction"),
        ("cam", "gain", -0.1, "gain"),
        ("cam", "dark", 150.0, "dark level"),
        ("lx_125", "up", 0.1, "moved across"),
    ],
)
def test_what_happened_is_suspected_first_with_its_size(
    nominal: Nominal, what: Chosen, part: str, what_of: str, size: float, kind: str
) -> None:
    first = judged(nominal, what, (Step(part, what_of, size),)).suspects[0]
    alike = {first.part, *first.like}
    assert (first.part, first.kind) == (part, kind) or part in alike
    if first.part == part:
        assert first.size[what_of] == pytest.approx(size, abs=max(6 * first.sigma[what_of], 0.05 * abs(size)))


def test_dirt_on_one_optic_looks_like_dirt_on_another_and_says_so(nominal: Nominal, what: Chosen) -> None:
    first = next(s for s in judged(nominal, what, (Step("ly_150", "loss", 0.2),)).suspects if s.kind == "dirt")
    assert {"lx_125", "p2", "ly_150"} <= {first.part, *first.like}


def test_probabilities_add_up(nominal: Nominal, what: Chosen) -> None:
    found = judged(nominal, what, (Step("p1", "zero:angle", 0.1),))
    assert sum(s.probability for s in found.suspects) == pytest.approx(1.0)
    assert [s.probability for s in found.suspects] == sorted((s.probability for s in found.suspects), reverse=True)
