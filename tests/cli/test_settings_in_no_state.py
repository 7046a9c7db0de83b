"""What was set on the bench and no state names: nothing says that all is equal, and a capture writes it down."""

from __future__ import annotations

import time
from contextlib import chdir
from pathlib import Path

import pytest
from commanding import Brought, Pico, edit, succeed


def bare_lab(folder: Path) -> None:
    """Make a new lab whose state does not name the camera, applied and committed."""
    lab = folder / "v"
    succeed("init", str(lab))
    edit(lab / "state/table.yaml", "  camera:\n    exposure: 5             # ms\n", "")
    with chdir(lab):
        succeed("apply", "-y")
        succeed("commit", "-m", "one")


@pytest.fixture
def bare(brought: Brought, shel: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    brought(bare_lab)
    monkeypatch.chdir(shel / "v")
    return shel / "v"


def test_a_setting_that_no_state_names_is_listed_captured_and_named_on_the_way_back(bare: Path, pico: Pico) -> None:
    assert "equal" in pico("status").out
    assert pico("set", "camera.exposure=7", "-y").code == 0
    status = pico("status")
    assert "equal" not in status.out and "7 ms  set, but in no state" in status.out, status.out
    assert "`pico capture camera.exposure`" in status.out
    row = next(r for r in pico("status", "--json").data["rows"] if r["tunable"] == "exposure")
    assert (row["live"], row["unstated"]) == (7, True)
    said = "Set on the bench, but in no state: camera.exposure 7 ms; `pico capture camera.exposure` writes it"
    for words in (("drift",), ("verify",), ("verify", "HEAD")):
        shown, written = pico(*words), pico(*words, "--json")
        assert said in " ".join(shown.out.split()), (words, shown)
        assert written.data["unstated"] == [{"address": "camera.exposure", "value": 7, "unit": "ms"}], written.data
    assert "exposure: 7" in pico("capture", "--dry-run").out
    made = pico("commit", "-m", "two")
    assert made.code == 0 and "camera.exposure" in made.out, made
    assert "exposure: 7" in (bare / "state/table.yaml").read_text()
    assert "set, but" not in pico("status").out
    assert all("in no state" not in pico(word).out for word in ("drift", "verify"))

    back = pico("checkout", "HEAD~1", "-y")
    assert back.code == 0 and "camera.exposure 7 ms stays as set" in back.out + back.err, back
    assert "set, but in no state" in pico("status").out
    assert pico("set", "camera.exposure=4.47", "-y").code == 0  # as it was before anything set it
    assert "set, but" not in pico("status").out and "Nothing to capture" in pico("capture").out


def test_a_line_that_was_removed_and_committed_does_not_come_back_by_itself(
    bare: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert pico("set", "camera.exposure=7", "-y").code == 0 and pico("commit", "-m", "two").code == 0
    table = bare / "state/table.yaml"
    table.write_text("".join(t for t in table.read_text().splitlines(True) if "camera:" not in t and "7" not in t))
    for date in ("GIT_COMMITTER_DATE", "GIT_AUTHOR_DATE"):
        monkeypatch.setenv(date, f"{int(time.time()) + 60} +0000")
    assert pico("commit", "-m", "three").code == 0
    made = pico("commit", "-m", "four", "--allow-empty")
    assert made.code == 0 and "exposure" not in table.read_text(), made
    assert "in no state: camera.exposure 7 ms" in made.out + made.err
    assert pico("capture", "camera").code == 0 and "exposure: 7" in table.read_text()
