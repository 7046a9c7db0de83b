"""The example of a primitive that an arm does with a tool: a key turns a knob that nobody reads."""

from __future__ import annotations

import json
import shutil
import tomllib
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from commanding import Pico

from pico.backends.emulated.bench import PACE
from pico.model import primitive
from pico.planning import routines

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
KNOB = EXAMPLES / "knob"
EMULATED = ("--backend", "hardware", "--emulate")
PARTS = """  m1: {type: knob_mount, marker: 47, home: storage/b4}
  knob_key: {type: knob_key, marker: 48, home: storage/c1}
"""


@pytest.fixture
def knob(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The example, as it is installed."""
    about = tmp_path / "site" / "turn_knob-1.0.dist-info"
    about.mkdir(parents=True)
    project = tomllib.loads((KNOB / "pyproject.toml").read_text())["project"]
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: 1.0\n")
    groups = project["entry-points"].items()
    lines = [line for g, own in groups for line in (f"[{g}]", *(f"{name} = {at}" for name, at in own.items()))]
    (about / "entry_points.txt").write_text("\n".join(lines) + "\n")
    shutil.copy(KNOB / "turn_knob.py", tmp_path / "site")
    monkeypatch.syspath_prepend(tmp_path / "site")
    for found in (primitive.plugged_in, routines.plugged_in):
        found.cache_clear()
    yield
    monkeypatch.undo()
    for found in (primitive.plugged_in, routines.plugged_in):
        found.cache_clear()


@pytest.fixture
def lab(shel: Path) -> Path:
    """The case study's bench with a knob and its key."""
    for name in ("knob_mount.yaml", "knob_key.yaml"):
        shutil.copy(KNOB / name, shel)
    shutil.copy(EXAMPLES / "devices.yaml", shel)
    text = (shel / "lab.yaml").read_text()
    at = text.index("inventory:\n") + len("inventory:\n")
    (shel / "lab.yaml").write_text(f"{text[:at]}{PARTS}{text[at:]}")
    return shel


def knob_of(pico: Pico, *how: str) -> Any:
    return pico(*how, "get", "m1.knob", "--json").data["values"]["knob"]


def last(pico: Pico, *how: str) -> Any:
    run = pico(*how, "runs", "list", "--all", "--json").data["runs"][0]
    return [
        (o["primitive"], o["component"], o["outcome"])
        for o in pico(*how, "runs", "show", run["document"]["id"], "--json").data["operations"]
    ]


@pytest.mark.parametrize("fidelity", ["kinematic", pytest.param("physics", marks=pytest.mark.slow)])
def test_a_key_turns_a_knob_and_is_put_back(knob: None, lab: Path, pico: Pico, fidelity: str) -> None:
    answer = pico("do", "m1", "turn_knob", "by=90", "-y", "--fidelity", fidelity)
    assert answer.code == 0, answer.out + answer.err
    assert ("turn_knob", "m1", "done") in last(pico)
    assert knob_of(pico) == {**knob_of(pico), "value": 90, "status": "commanded"}
    world = json.loads((lab / ".pico/benches/sim" / "world.json").read_text())
    assert world["components"]["knob_key"]["presence"] == "seen" and world["robots"]["arm1"].get("holding") is None


def test_what_it_requires_is_asked_first(knob: None, lab: Path, pico: Pico) -> None:
    answer = pico("do", "m1", "turn_knob", "by=400", "-y")
    assert answer.code == 1 and "abs(args.by) <= 300" in answer.err
    assert pico("do", "knob_key", "move", "slot=storage/c3", "-y").code == 0


@pytest.mark.slow
@pytest.mark.skipif(not (find_spec("xarm") and find_spec("ElliptecBus")), reason="the extras xarm and thorlabs")
def test_it_is_done_at_an_emulated_bench(knob: None, lab: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    """The arm goes there over its wire; two turns add up, though nobody reads them."""
    monkeypatch.setenv(PACE, "10")
    assert knob_of(pico, *EMULATED)["status"] == "unknown"
    for turned in (90, 60):
        answer = pico(*EMULATED, "do", "m1", "turn_knob", f"by={turned}", "-y")
        assert answer.code == 0, answer.out + answer.err
    assert ("turn_knob", "m1", "done") in last(pico, *EMULATED)
    assert knob_of(pico, *EMULATED) == {**knob_of(pico, *EMULATED), "value": 150, "status": "commanded"}
