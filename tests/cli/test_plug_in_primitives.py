"""A primitive is added by one file with its entry points: known to types, planned, executed, recorded, recovered."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from commanding import Pico, edit

from pico.backends.sim import plugins
from pico.edge.recovery import repeatable
from pico.model import primitive
from pico.model.operation import Operation, Reason
from pico.resources import catalog_dir

RINSE = """
from dataclasses import replace
from pico.model.observation import ObservedValue
from pico.model.primitive import Primitive

PRIMITIVE = Primitive(name="rinse", changes="anything", arguments={"volume": "mm", "with": None}, seconds=12.5,
                      counted=("rinsing", "rinsings"))

def simulated(world, operation):
    return world.with_value(operation.component, "level", ObservedValue(value=operation.arguments["volume"]))

KNOB = Primitive(name="turn_knob", changes="anything", arguments={"to": "mm"}, seconds=4.0,
                 counted=("turn of a knob", "turns of knobs"),
                 requires=("it.slot == 'storage/b4'", "args.to <= 15"), ensures=("abs(it.pose.yaw) < 5",))
READ = Primitive(name="read_knob", changes="anything", ensures=("it.level > 0",))

def turned(world, operation):  # what the knob sits on turns with it, a degree a millimetre
    name, to = operation.component, operation.arguments["to"]
    world = world.with_value(name, "level", ObservedValue(value=to, status="commanded"))
    return world.with_body(name, pose=replace(world.components[name].pose, yaw=to))

def left(world, operation):
    return world
"""
ENTRIES = """[pico.primitives]
rinse = rinse:PRIMITIVE
turn_knob = rinse:KNOB
read_knob = rinse:READ
[pico.sim.primitives]
rinse = rinse:simulated
turn_knob = rinse:turned
read_knob = rinse:left
"""


@pytest.fixture
def rinse(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A plug-in that brings the primitive `rinse`."""
    about = tmp_path / "site" / "rinse-1.0.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: rinse\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(ENTRIES)
    (tmp_path / "site" / "rinse.py").write_text(RINSE)
    monkeypatch.syspath_prepend(tmp_path / "site")
    for found in (primitive.plugged_in, plugins.plugged_in):
        found.cache_clear()
    yield
    monkeypatch.undo()
    for found in (primitive.plugged_in, plugins.plugged_in):
        found.cache_clear()


@pytest.fixture
def cuvette(shel: Path) -> Path:
    """The example with a part of a type of its own, that can be rinsed."""
    own = shel / "cuvette.yaml"
    shutil.copy(catalog_dir() / "sample_holder.yaml", own)
    edit(own, "name: sample_holder", "name: cuvette")
    edit(
        own,
        "primitives: [move, stow]",
        "tunables: {level: {unit: mm, range: [0, 20]}}\nprimitives: [move, stow, rinse, turn_knob, read_knob]",
    )
    lab = (shel / "lab.yaml").read_text()
    at = lab.index("inventory:\n") + len("inventory:\n")
    (shel / "lab.yaml").write_text(f"{lab[:at]}  cell: {{type: cuvette, marker: 47, home: storage/b4}}\n{lab[at:]}")
    return shel


def test_a_plug_in_brings_a_primitive(rinse: None, cuvette: Path, pico: Pico) -> None:
    answer = pico("do", "cell", "rinse", "volume=0.5 cm", "with=water", "-y")
    assert answer.code == 0, answer
    assert "1 rinsing" in answer.out and "12.5 s" in answer.out
    assert pico("get", "cell.level", "--json").data["values"]["level"]["value"] == 5
    (run,) = pico("runs", "list", "--all", "--json").data["runs"]
    (did,) = pico("runs", "show", run["document"]["id"], "--json").data["operations"]
    assert (did["primitive"], did["arguments"], did["outcome"]) == ("rinse", {"volume": 5, "with": "water"}, "done")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("with=water",), "rinse of cell wants `volume`"),
        (("volume=3", "wiht=water"), "did you mean `with`"),
        (("volume=3 s", "with=water"), "volume of cell"),
    ],
)
def test_its_arguments_are_checked(rinse: None, cuvette: Path, pico: Pico, words: tuple[str, ...], said: str) -> None:
    answer = pico("do", "cell", "rinse", *words, "-y")
    assert answer.code == 1 and said in answer.err


def test_what_a_primitive_requires_must_hold_before_it(rinse: None, cuvette: Path, pico: Pico) -> None:
    for words in (("turn_knob", "to=20"), ("turn_knob", "to=20", "--dry-run")):
        answer = pico("do", "cell", *words, "-y")
        assert answer.code == 1 and "turn_knob of cell wants `args.to <= 15`: args.to is 20" in answer.err
    assert pico("do", "cell", "move", "slot=storage/c3", "-y").code == 0
    answer = pico("do", "cell", "turn_knob", "to=3", "-y")
    assert answer.code == 1 and "wants `cell.slot == 'storage/b4'`: cell.slot is `storage/c3`" in answer.err


def test_what_nothing_reads_is_commanded_and_what_is_ensured_must_hold_after_it(
    rinse: None, cuvette: Path, pico: Pico
) -> None:
    assert pico("do", "cell", "turn_knob", "to=3", "-y").code == 0
    assert pico("get", "cell.level", "--json").data["values"]["level"]["status"] == "commanded"
    answer = pico("do", "cell", "turn_knob", "to=12", "-y")
    said = "turn_knob of cell was done, and does not hold: `abs(cell.pose.yaw) < 5`: cell.pose.yaw is 12"
    assert answer.code == 1 and said in answer.err
    run = pico("runs", "list", "--all", "--json").data["runs"][0]
    (did,) = pico("runs", "show", run["document"]["id"], "--json").data["operations"]
    assert did["outcome"] == "failed" and did["error"]["code"] == "ensures"


def test_what_is_ensured_and_nobody_can_tell_is_unknown(rinse: None, cuvette: Path, pico: Pico) -> None:
    assert pico("do", "cell", "turn_knob", "to=3", "-y").code == 0
    answer = pico("do", "cell", "read_knob", "-y")
    assert answer.code == 1 and "cell.level was commanded, and never read back" in answer.err


def test_without_the_plug_in_the_type_says_what_it_lacks(cuvette: Path, pico: Pico) -> None:
    answer = pico("validate")
    assert answer.code == 1
    assert (
        "there is no primitive `rinse`" in answer.err and "cuvette.yaml:" in answer.err and "move, stow" in answer.err
    )


def test_what_nobody_here_knows_is_never_done_again() -> None:
    def one(name: str, **arguments: object) -> Operation:
        return Operation(id="op1", primitive=name, component="cell", arguments=arguments, reason=Reason(kind="asked"))

    assert [repeatable(one(name)) for name in ("move", "set", "measure", "operator", "glue")] == [True] * 3 + [
        False
    ] * 2
    assert not repeatable(one("move", irreversible=True))
