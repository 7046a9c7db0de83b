"""`pico do COMPONENT measure`: planned, recorded, carried by commits, compared; `pico get` peeks."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from commanding import Answer, Pico, edit

from pico.history.data.lab import LabData
from pico.resources import catalog_dir


def measured(answer: Answer) -> dict[str, object]:
    """Return what a run brought, from its report."""
    assert answer.code == 0, answer
    report = json.loads(answer.out.splitlines()[-1])
    (found,) = report["measurements"].values()
    return dict(found)


def test_a_set_point_is_measured_and_shown_with_its_run(shel: Path, pico: Pico) -> None:
    answer = pico("do", "p1", "measure", "angle", "-y")
    assert answer.code == 0 and "1 measurement" in answer.out and "0 deg" in answer.out
    assert "9 components of 9 stay as is" in answer.out
    shown = pico("runs", "show")
    assert "measure p1.angle  done: 0 deg, assured: settled, arm parked" in shown.out
    assert "It changed nothing beyond tolerance." in shown.out
    (one,) = [m for m in pico("runs", "show", "--json").data["measurements"] if m["kind"] == "measurement"]
    assert (one["component"], one["operation"], one["t"]) == ("p1", "op1", 0.5)
    assert (one["data"]["schema"], one["data"]["value"]) == ("pico.measurement/v1", 0)
    assert one["data"]["assured"] == ["settled", "arm parked"] and not one["data"]["not_assured"]


def test_a_frame_goes_to_the_store_and_its_hash_into_the_commit(shel: Path, pico: Pico) -> None:
    array = measured(pico("do", "left", "measure", "--json", "-y"))["array"]
    assert isinstance(array, dict) and array["dtype"] == "uint8"
    assert list(np.load(shel / opened(pico)).shape) == array["shape"]
    own = pico("runs", "show", "--json").data["document"]["id"]
    early = pico("runs", "export", "--run", own)
    assert early.code == 1 and f"no commit has the run {own} yet" in early.err and "did you mean" not in early.err
    assert pico("commit", "--capture", "-m", "the table from the left").code == 0
    (document,) = [json.loads(p.read_bytes()) for p in shel.glob("runs/*/*/*/run.json")]
    (artifact,) = document["artifacts"]
    assert (artifact["sha256"], artifact["name"]) == (array["sha256"], "op1-left-frame.npy")
    assert (artifact["shape"], artifact["component"], artifact["seq"]) == (array["shape"], "left", 3)
    (line,) = [m for m in lines(shel, "measurements") if m["kind"] == "measurement"]
    assert line["data"]["array"]["sha256"] == array["sha256"]
    assert sum(len(p.read_bytes()) for p in shel.glob("runs/*/*/*/*")) < 20_000
    data = LabData.discover(shel)
    assert data.store.size(array["sha256"]) == artifact["size"] and not data.check().missing
    assert not data.garbage(0).removable
    shown = pico("runs", "show", document["id"])
    assert f"artifact      op1-left-frame.npy {artifact['size']} bytes, here: {opened(pico)}\n" in shown.out
    crate = pico("runs", "export", "--run", document["id"][-6:], "--out", "x.zip", "--pictures", "none", "--json")
    assert (crate.data["runs"], crate.data["evidence"]) == ([document["id"]], "kinematic")
    (other,) = pico("runs", "export", "HEAD~1", "--run", document["id"], "--json").data["diagnostics"]
    assert "carries the run" in other["summary"] and "`pico runs export " in other["hint"]


def opened(pico: Pico) -> str:
    """Return where the one artifact of the last run is, in the lab."""
    (artifact,) = pico("runs", "show", "--json").data["artifacts"]
    return str(artifact["path"])


def lines(lab: Path, name: str) -> list[dict[str, object]]:
    (path,) = lab.glob(f"runs/*/*/*/{name}.jsonl")
    return [json.loads(line) for line in path.read_text().splitlines()]


def test_a_frame_that_no_commit_has_yet_is_no_garbage(shel: Path, pico: Pico) -> None:
    pico("do", "left", "measure", "frame", "-y")
    assert not LabData.discover(shel).garbage(0).removable
    assert pico("get", "left.frame").code == 0  # the same picture, which a run needs


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("cam", "measure", "pose"), "cam.pose can't be measured: no camera over the bench sees it"),
        (("cam", "measure", "spectrum"), "cam has no measurable `spectrum`"),
        (("p1", "measure"), "what of p1 is to be measured?"),
        (("p1", "measure", "angel"), "did you mean `angle`?"),
        (("p1", "measure", "measurable=angle", "exposure=3"), "takes no `exposure`"),
        (("lefd", "measure", "frame"), "there is no component `lefd`"),
        (("hwp", "measure", "pose", "more"), "is no `key=value`"),
    ],
)
def test_what_cannot_be_measured_is_said_before_anything_moves(
    shel: Path, pico: Pico, words: tuple[str, ...], said: str
) -> None:
    answer = pico("do", *words, "-y")
    assert answer.code == 1 and said in answer.err
    assert not pico("runs", "list", "--all", "--json").data["runs"]


def test_get_peeks_without_lease_or_record(shel: Path, pico: Pico) -> None:
    answer = pico("get", "left.frame")
    assert answer.code == 0 and "peeked at: nothing of it is assured" in answer.out
    (found,) = pico("get", "left.frame", "--json").data["values"].values()
    assert found["status"] == "peeked" and not found["measurement"]["assured"]
    assert set(found["measurement"]["not_assured"]) == {"settled", "arm parked", "not saturated"}
    assert not pico("runs", "list", "--all", "--json").data["runs"]
    assert "array 2048 x 2448 uint16" in pico("get", "cam.image").out


def test_the_camera_on_an_arm_is_told_apart_from_those_over_the_bench(shel: Path, pico: Pico) -> None:
    for words in (("get", "hand"), ("get", "hand.frame"), ("do", "hand", "measure", "frame")):
        told = " ".join(pico(*words).err.split())
        assert "`hand` is the camera on arm1, through which only runs look" in told
        assert "`pico get left.frame`" in told and "hand.frame" not in told


def test_two_runs_that_measured_the_same_are_compared_only_where_that_means_something(shel: Path, pico: Pico) -> None:
    for words in (("do", "left", "measure"), ("do", "left", "measure"), ("do", "p1", "measure", "pose")):
        assert pico(*words).code == 0
    pico("set", "p1", "angle=5", "-y")
    pico("do", "p1", "measure", "pose", "-y")
    runs = [r["document"]["id"] for r in pico("runs", "list", "--all", "--json").data["runs"]]
    later, _, pose, second, first = runs
    (same,) = pico("runs", "compare", first, second, "--json").data["measured"]
    assert same["address"] == "left.frame" and not same["incomparable"]
    (other,) = pico("runs", "compare", pose, later, "--json").data["measured"]
    assert other["incomparable"] == ["angle: 0, then 5"]
    assert "not comparable: angle: 0, then 5" in pico("runs", "compare", pose, later).out


@pytest.fixture
def needing(shel: Path) -> Path:
    """The example, with a camera whose exposure is measured with the laser's shutter open."""
    own = shel / "own_camera.yaml"
    shutil.copy(catalog_dir() / "beam_camera.yaml", own)
    edit(own, "name: beam_camera", "name: own_camera")
    edit(own, "measurables:\n", "measurables:\n  exposure: {datatype: setpoint, unit: ms, needs: {shutter: open}}\n")
    edit(shel / "lab.yaml", "type: beam_camera", "type: own_camera")
    return shel


def test_what_a_measurable_needs_is_set_first_and_set_back_afterwards(needing: Path, pico: Pico) -> None:
    plan = pico("do", "cam", "measure", "exposure", "--dry-run", "--json").data
    did = [(o["id"], o["primitive"], o["component"], o["arguments"].get("to"), o["after"]) for o in plan["operations"]]
    assert did == [
        ("op1", "set", "laser", "open", []),
        ("op2", "measure", "cam", None, ["op1"]),
        ("op3", "set", "laser", "closed", ["op2"]),
    ]
    found = measured(pico("do", "cam", "measure", "exposure", "--json", "-y"))
    assert found["assured"] == ["settled", "arm parked", "in range", "shutter"]
    assert pico("get", "laser.shutter", "--json").data["values"]["shutter"]["value"] == "closed"


def test_a_shutter_that_was_opened_to_measure_closes_also_where_that_failed(needing: Path, pico: Pico) -> None:
    pico("set", "cam", "exposure=3", "-y")
    world = needing / ".pico/benches/sim/world.json"
    there = json.loads(world.read_text())
    del there["sha256"]  # edited, as an earlier version wrote it
    there["components"]["cam"]["values"]["exposure"] = {"status": "unknown"}
    world.write_text(json.dumps(there))
    answer = pico("do", "cam", "measure", "exposure", "-y")
    assert answer.code == 1 and "cam.exposure can't be read back" in answer.err
    assert "laser.shutter open → closed" in answer.out and "2 of 3 operations done, 1 failed" in answer.out
    assert pico("get", "laser.shutter", "--json").data["values"]["shutter"]["value"] == "closed"


def test_an_arm_that_was_stopped_on_its_way_parks_with_the_beam_closed(needing: Path, pico: Pico) -> None:
    world = needing / ".pico/benches/sim/world.json"
    pico("set", "laser", "shutter=open", "-y")
    there = json.loads(world.read_text())
    del there["sha256"]  # edited, as an earlier version wrote it
    there["robots"]["arm1"]["joints"] = [q + 0.3 for q in there["robots"]["arm1"]["joints"]]
    world.write_text(json.dumps(there))
    plan = pico("do", "cam", "measure", "exposure", "--dry-run", "--json").data
    did = [(o["primitive"], o["component"], o["arguments"].get("to")) for o in plan["operations"]]
    assert did == [
        ("set", "laser", "closed"),
        ("park", "arm1", None),
        ("set", "laser", "open"),
        ("measure", "cam", None),
    ]
    found = measured(pico("do", "cam", "measure", "exposure", "--json", "-y"))
    assert found["assured"] == ["settled", "arm parked", "in range", "shutter"]


def expecting(lab: Path, *those: str) -> None:
    listed = "".join(f"  - {{that: '{that}'}}\n" for that in those)
    head = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\n"
    (lab / "state/expected.yaml").write_text(f"{head}expect:\n{listed}")


def test_verify_measures_what_expectations_speak_of(shel: Path, pico: Pico) -> None:
    expecting(shel, "left.peak > 200 && left.mean < 250", "cam.peak > 200", "p2.pose.x > 0")
    assert pico("apply", "--auto-approve").code == 0
    plain = {e["that"]: e for e in pico("verify", "--json").data["expectations"]}
    assert [e.get("holds") for e in plain.values()] == [None, None, True]
    assert [e.get("why", "") for e in plain.values()] == [
        "left.peak was not measured now: `pico verify --measure` does it",
        "cam.peak was not measured now: `pico verify --measure` does it", "",
    ]  # fmt: skip
    answer = pico("verify", "--measure", "--auto-approve", "--json")
    assert answer.code == 0, answer
    told = [json.loads(line) for line in answer.out.splitlines()]
    done = [(op["primitive"], op["component"]) for op in told[0]["operations"]]
    assert done == [("measure", "cam"), ("measure", "left")]
    measured = {e["that"]: e for e in told[-1]["expectations"]}
    assert [e.get("holds") for e in measured.values()] == [True, None, True]
    assert "not saturated: 4" in measured["cam.peak > 200"]["why"]  # parallel polarizers, 10 ms
    expecting(shel, "left.peak < 100")
    assert pico("verify").code == 0
    failed = pico("verify", "--measure", "--auto-approve")
    assert failed.code == 6 and "`left.peak < 100` fails: left.peak is" in failed.out


def test_verify_with_nothing_to_measure_takes_no_bench(shel: Path, pico: Pico) -> None:
    expecting(shel, "p2.pose.x > 0")
    pico("apply", "--auto-approve")
    before = len(pico("runs", "list", "--all", "--json").data["runs"])
    assert pico("verify", "--measure", "--json").code == 0
    assert len(pico("runs", "list", "--all", "--json").data["runs"]) == before


def test_a_rule_that_speaks_of_what_nobody_measured_denies(shel: Path, pico: Pico) -> None:
    rule = "policy:\n  rules:\n    - {name: seen, that: left.mean > 1}\n"
    lab = (shel / "lab.yaml").read_text()
    assert "policy:" in lab
    (shel / "lab.yaml").write_text(re.sub(r"policy:\n(  .*\n)+", rule, lab))
    answer = pico("set", "p1", "angle=3", "-y")
    assert answer.code == 7 and "can't be told: nobody measured left.mean" in " ".join(answer.out.split())
