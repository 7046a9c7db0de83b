"""`pico swap`: another specimen in a housing: shown, asked about, refused at its line, undone, and never half done."""

from __future__ import annotations

from pathlib import Path

import forking
import pytest
from commanding import Brought, Pico, Typed, a_run_goes_on, apply_manifest, edit

from pico import open as pico_open

KILLED = """\
import os, sys
import pico.edge.own_lab as own_lab
own_lab.write = lambda *_: os._exit(9)
from pico_cli.main import main
sys.exit(main())
"""


@pytest.fixture
def kept(shel: Path, brought: Brought) -> Path:
    """The example whose bench keeps its Lab."""
    brought(apply_manifest)
    return shel


def focal(folder: Path) -> float | None:
    """The focal length that the bench goes by."""
    with pico_open(folder) as bench:
        return bench.setup.type_of("lx_100").number("focal_length", "mm")


def test_the_specimen_is_shown_first_and_taken_into_bench_and_lab(kept: Path, pico: Pico) -> None:
    before = (kept / "lab.yaml").read_text()
    words = ("swap", "lx_100", "--serial", "B7", "--focal-length", "100.3 mm")
    shown = pico(*words, "--dry-run")
    assert shown.code == 0 and "+    serial: B7" in shown.out and (kept / "lab.yaml").read_text() == before
    done = pico(*words, "-y", "--json").data
    assert done["done"] and (done["before"], done["after"]) == ("", "B7") and focal(kept) == pytest.approx(100.3)
    assert not pico("plan").err, "bench and lab.yaml are one"
    assert "nothing changes" in pico(*words, "-y").out
    back = pico("swap", "lx_100", "--serial", "A1", "--focal-length", "100 mm", "-y")
    assert back.code == 0 and focal(kept) == pytest.approx(100.0)


def test_what_can_not_be_is_refused_where_it_would_stand(kept: Path, pico: Pico) -> None:
    before = (kept / "lab.yaml").read_bytes()
    for words, said in (
        (("lx_10", "--serial", "B7"), "no component `lx_10`"),
        (("lx_100", "--serial", "B7", "--focal-length", "3 s"), "lab.yaml:129:21"),
        (("lx_100", "--serial", "B7", "--type", "plano_conv"), "plano_conv"),
        (("lx_100", "--serial", "B7", "--parameter", "hue=3"), "has no parameter `hue`"),
        (("lx_100", "--serial", "B7", "--parameter", "hue"), "is not KEY=VALUE"),
        (("lx_100", "--serial", "B7\nC8"), "`B7?C8` is no serial number"),
        (("lx_100", "--serial", "B" * 500), "is no serial number"),
    ):
        answer = pico("swap", *words, "-y")
        assert answer.code == 1 and said in answer.err and "Traceback" not in answer.err, answer.err
    assert (kept / "lab.yaml").read_bytes() == before and not pico("plan").err
    (kept / "lab.yaml").write_bytes(before + b"garbage: [\n")  # a broken file is no missing lab
    answer = pico("swap", "lx_100", "--serial", "B7", "-y")
    assert answer.code == 1 and "pico init" not in answer.err and "lab.yaml:" in answer.err


def test_another_type_that_the_state_does_not_go_with_is_refused_at_its_line(kept: Path, pico: Pico) -> None:
    before = (kept / "lab.yaml").read_bytes()
    for more in ((), ("--dry-run",)):
        answer = pico("swap", "p2", "--serial", "B7", "--type", "plano_convex_100", "-y", *more)
        assert answer.code == 1 and "p2 (plano_convex_100) has no tunable `angle`" in answer.err
        assert "does not go with another specimen" in answer.err and "state/table.yaml:" in answer.err
    assert (kept / "lab.yaml").read_bytes() == before and not pico("plan").err
    assert pico("validate").code == 0


def test_who_says_no_or_is_not_there_swaps_nothing(kept: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    before = (kept / "lab.yaml").read_bytes()
    monkeypatch.setattr("sys.stdin", Typed("n\n"))
    answer = pico("swap", "lx_100", "--serial", "B7")
    assert answer.code == 1 and "Nothing was swapped." in answer.out and (kept / "lab.yaml").read_bytes() == before


def test_what_is_edited_while_it_asks_is_not_lost(kept: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    class Editing(Typed):
        def readline(self, *_: object) -> str:
            edit(kept / "lab.yaml", "seed: 1", "seed: 2")
            return "y\n"

    monkeypatch.setattr("sys.stdin", Editing())
    answer = pico("swap", "lx_100", "--serial", "B7")
    assert answer.code == 1 and "changed meanwhile, so nothing was swapped" in answer.err
    text = (kept / "lab.yaml").read_text()
    assert "seed: 2" in text and "B7" not in text
    monkeypatch.setattr("sys.stdin", Typed("y\n"))
    assert pico("swap", "lx_100", "--serial", "B7").code == 0
    text = (kept / "lab.yaml").read_text()
    assert "seed: 2" in text and "serial: B7" in text
    waiting = pico("plan").err
    assert "sim.seed 1 → 2" in waiting and "B7" not in waiting, "the bench has the specimen, and not the other edit"


def test_while_somebody_has_the_bench_nothing_changes(kept: Path, pico: Pico) -> None:
    before = (kept / "lab.yaml").read_bytes()
    with a_run_goes_on(kept, "pico apply"):
        answer = pico("swap", "lx_100", "--serial", "B7", "-y")
    assert answer.code == 5 and (kept / "lab.yaml").read_bytes() == before and not pico("plan").err


def test_killed_in_between_the_lab_proposes_the_specimen_and_nothing_is_lost(kept: Path, pico: Pico) -> None:
    words = ("swap", "lx_100", "--serial", "B7", "--focal-length", "100.3 mm", "-y")
    assert forking.started(KILLED, *words, cwd=kept).wait(60) == 9
    assert "serial: B7" in (kept / "lab.yaml").read_text() and focal(kept) == 100.0
    told = pico("plan")
    assert "warning[bench-lab]" in told.err and "pico bench update" in told.err and "lx_100" in told.err
    assert pico("bench", "update", "-y").code == 0
    assert focal(kept) == pytest.approx(100.3) and not pico("plan").err


def test_how_well_the_glass_is_known_is_kept_told_in_the_light_and_gets_old(kept: Path, pico: Pico) -> None:
    assert pico("apply", "e1", "-y").code == 0
    assert " ± " not in pico("beam").out
    words = ("swap", "ly_150", "--serial", "B7", "--focal-length", "150.4 mm")
    assert pico(*words, "--sigma", "1.5 mm", "--measured", "2026-01-20", "--valid-for", "3650 d", "-y").code == 0
    assert 'at: "2026-01-20"' in (kept / "lab.yaml").read_text()
    assert " ± " in pico("beam").out and "expired" not in pico("plan").err
    assert pico(*words, "--measured", "2020-01-20", "--valid-for", "365 d", "-y").code == 0
    told = pico("plan").err
    assert told.count("warning[expired]") == 1 and "focal_length of ly_150 (2020-01-20, valid for 365 d)" in told
    assert pico(*words, "-y").code == 0 and "expired" not in pico("plan").err, "nobody says how well that is known"
    for more, said in (
        (("--sigma", "1 mm"), "say how a number was measured"),
        (("--focal-length", "150 mm", "--measured", "monday"), "`monday` is no date"),
        (("--focal-length", "150 mm", "--sigma", "1 s"), "is a time, not a length"),
    ):
        answer = pico("swap", "ly_150", "--serial", "C1", *more, "-y")
        assert answer.code == 1 and said in answer.err, answer.err
