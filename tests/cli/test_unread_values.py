"""Values that no device of a bench reads are never called equal."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from commanding import Brought, Pico, apply_manifest

from pico.bench.opened import Opened
from pico.model.observation import Observation

UNREAD = ["cam.exposure", "p1.angle"]


@pytest.fixture
def wired_in_part(shel: Path, brought: Brought, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A bench as its manifest says, on which no device is wired for two of its tunables."""
    brought(apply_manifest)
    look = Opened.observe

    def observe(self: Opened) -> Observation:
        seen = look(self)
        parts = {
            name: replace(part, values={t: v for t, v in part.values.items() if f"{name}.{t}" not in UNREAD})
            for name, part in seen.components.items()
        }
        return replace(seen, components=parts)

    monkeypatch.setattr(Opened, "observe", observe)
    return shel


TOLD = "2 values are unknown, because no device of this bench reads them: cam.exposure, p1.angle."


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("status", "Committed, desired and live are equal in all known values."),
        ("drift", "No drift: the bench `sim` is as C3 says in all known values."),
        ("verify", "The bench equals the manifest in all known values."),
        ("plan", "Nothing to do: the bench equals the manifest in all known values."),
    ],
)
def test_what_no_device_reads_is_counted_and_named_and_not_called_equal(
    wired_in_part: Path, pico: Pico, command: str, said: str
) -> None:
    answer = pico(command)
    words = " ".join(answer.out.split())
    assert answer.code == 0, answer.err
    assert said in words and TOLD in words


def test_as_json_each_unknown_value_is_marked(wired_in_part: Path, pico: Pico) -> None:
    rows = pico("status", "--json").data["rows"]
    assert [f"{r['component']}.{r['tunable']}" for r in rows if r["unread"]] == UNREAD
    assert not any(r["exact"] for r in rows if r["unread"])
    for command in ("plan", "drift", "verify"):
        assert pico(command, "--json").data["unread"] == UNREAD


def test_a_bench_that_reads_all_of_them_is_equal(shel: Path, brought: Brought, pico: Pico) -> None:
    brought(apply_manifest)
    assert "Committed, desired and live are equal." in pico("status").out
    for command in ("plan", "verify"):
        assert "unread" not in pico(command, "--json").data
