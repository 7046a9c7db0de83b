"""`pico runs export`: a revision as an RO-Crate that is complete, honest about its evidence, and the same each time."""

from __future__ import annotations

import hashlib
import json
import shutil
import time
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import pytest
from commanding import Brought, Pico, succeed
from data_labs import git

from pico.bench.publishing import publish
from pico.history.data.lab import LabData


@pytest.fixture
def lab(shel: Path, brought: Brought) -> Path:
    brought(licensed_run)
    return shel


def licensed_run(folder: Path) -> None:
    """A lab whose last commit carries a run, with a license."""
    (folder / "LICENSE").write_text("Creative Commons Attribution 4.0 International\n\nYou are free to share.\n")
    git("add", "LICENSE")
    git("commit", "-q", "-m", "a license")
    succeed("set", "p1", "angle=12", "-y")
    succeed("commit", "-m", "p1 a little", "--capture")


def run_of(lab: Path) -> Path:
    (found,) = lab.glob("runs/*/*/*")
    return found


def crate(pico: Pico, *words: str, out: Path) -> dict[str, dict[str, Any]]:
    """Publish into a folder, without pictures, and return the entities of the crate by id."""
    answer = pico("runs", "export", *words, "--out", str(out), "--pictures", "none")
    assert answer.code == 0, answer
    return entities(out)


def entities(folder: Path) -> dict[str, dict[str, Any]]:
    graph = json.loads((folder / "ro-crate-metadata.json").read_text())["@graph"]
    found = {e["@id"]: e for e in graph}
    assert len(found) == len(graph)
    return found


def refs(value: Any) -> list[str]:
    """Return the ids that a property refers to."""
    several = value if isinstance(value, list) else [value]
    return [v["@id"] for v in several if isinstance(v, Mapping)]


def rewrite_run(lab: Path, **changed: Any) -> None:
    """Let the commit carry another document of its run, as if things had been otherwise."""
    path = run_of(lab) / "run.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | changed))
    git("commit", "-q", "--amend", "--no-edit", "-a", at=lab)


def artifact(data: bytes, name: str = "frame.bin") -> dict[str, Any]:
    return {"name": name, "sha256": hashlib.sha256(data).hexdigest(), "size": len(data), "media_type": "image/tiff"}


def test_a_crate_lists_every_file_once_with_its_hash_and_nothing_that_is_not_there(
    lab: Path, tmp_path: Path, pico: Pico
) -> None:
    found = crate(pico, out=tmp_path / "crate")
    listed = {unquote(e["@id"]): e for e in found.values() if "File" in e["@type"]}
    there = {p.relative_to(tmp_path / "crate").as_posix() for p in (tmp_path / "crate").rglob("*") if p.is_file()}
    assert there == {*listed, "ro-crate-metadata.json"}
    for path, entity in listed.items():
        data = (tmp_path / "crate" / path).read_bytes()
        assert (entity["contentSize"], entity["sha256"]) == (str(len(data)), hashlib.sha256(data).hexdigest())
    parts, waiting = set[str](), ["./"]
    while waiting:
        inside = refs(found[waiting.pop()].get("hasPart", []))
        parts |= set(inside)
        waiting += [i for i in inside if i.endswith("/")]
    assert {p for p in parts if not p.endswith("/")} == {e["@id"] for e in listed.values()}


def test_a_crate_meets_what_the_specification_demands(lab: Path, tmp_path: Path, pico: Pico) -> None:
    found = crate(pico, out=tmp_path / "crate")
    document = json.loads((tmp_path / "crate" / "ro-crate-metadata.json").read_text())
    assert document["@context"][0] == "https://w3id.org/ro/crate/1.1/context"
    descriptor, root = found["ro-crate-metadata.json"], found["./"]
    assert refs(descriptor["conformsTo"]) == ["https://w3id.org/ro/crate/1.1"]
    assert refs(descriptor["about"]) == ["./"]
    assert root["@type"] == "Dataset"
    assert root["name"] == "Spin Hall effect of light at a tilted polarizer: p1 a little"
    assert "p1.angle" in root["description"]
    assert "Pico-" not in root["description"]
    assert root["datePublished"][:4].isdigit()
    assert found[refs(root["license"])[0]]["name"] == "Creative Commons Attribution 4.0 International"
    assert found[refs(root["author"])[0]]["name"] == "A Physicist"
    for entity in found.values():
        for name, value in entity.items():
            for target in refs(value):
                known = target in found or target.startswith(("https://", "http://"))
                assert known, f"{entity['@id']} {name} refers to {target}, which is not there"


def test_another_reader_finds_runs_files_and_people(lab: Path, tmp_path: Path, pico: Pico) -> None:
    from rocrate.rocrate import ROCrate

    crate(pico, out=tmp_path / "crate")
    read = ROCrate(tmp_path / "crate")
    (action,) = [e for e in read.contextual_entities if e.type == "CreateAction"]
    assert action["agent"].type == "Person"
    assert {i["name"] for i in action["instrument"]} == {"pico", "bench shel, simulated"}
    assert action["additionalProperty"]["value"] == "kinematic"
    results = {e.id.rpartition("/")[2] for e in action["result"]}
    assert {"run.json", "trace.jsonl", "measurements.jsonl"} <= results
    assert read.root_dataset["mentions"] == action or action in read.root_dataset["mentions"]
    written = tmp_path / "again"
    read.write(written)
    assert (written / "state.json").read_bytes() == (tmp_path / "crate" / "state.json").read_bytes()


def test_the_state_in_a_crate_has_the_digest_that_the_commit_names(lab: Path, tmp_path: Path, pico: Pico) -> None:
    from pico.model.plan import plan_from_json

    crate(pico, out=tmp_path / "crate")
    digest = hashlib.sha256((tmp_path / "crate" / "state.json").read_bytes()).hexdigest()
    assert f"Pico-State: sha256:{digest}" in git("log", "-1", "--format=%B")
    plan = plan_from_json((tmp_path / "crate" / "plan.json").read_bytes())
    changes = json.loads((tmp_path / "crate" / "diff.json").read_text())
    assert [(c.component, c.tunable) for c in plan.changes] == [(c["component"], c["tunable"]) for c in changes]
    assert "p1.angle" in (tmp_path / "crate" / "diff.txt").read_text()
    assert (tmp_path / "crate" / "lab" / "state" / "table.yaml").read_bytes() == (lab / "state/table.yaml").read_bytes()
    assert (tmp_path / "crate" / "catalog" / "linear_polarizer.yaml").is_file()


def test_the_same_commit_gives_the_same_bytes_by_any_name_and_in_any_clone(
    lab: Path, tmp_path: Path, pico: Pico
) -> None:
    git("clone", "-q", str(lab), "clone", at=tmp_path)
    git("tag", "e9")
    none = ("--pictures", "none", "--out")
    assert pico("runs", "export", *none, "first.zip").code == 0
    assert pico("runs", "export", "e9", *none, "second.zip").code == 0
    time.sleep(1.1)  # times are told by the second
    assert pico("-C", str(tmp_path / "clone"), "runs", "export", *none, "third.zip").code == 0
    first = (lab / "first.zip").read_bytes()
    assert (lab / "second.zip").read_bytes() == first
    assert (tmp_path / "clone" / "third.zip").read_bytes() == first


@pytest.mark.slow
def test_a_zip_file_holds_pictures_of_the_table(lab: Path, pico: Pico) -> None:
    assert pico("runs", "export", "--out", "crate.zip").code == 0
    with zipfile.ZipFile(lab / "crate.zip") as archive:
        assert archive.testzip() is None
        assert archive.read("pictures/top.png").startswith(b"\x89PNG")
        assert archive.read("pictures/perspective.png").startswith(b"\x89PNG")


def test_without_out_the_file_is_named_after_lab_and_commit(lab: Path, pico: Pico) -> None:
    commit = git("rev-parse", "HEAD").strip()
    answer = pico("runs", "export", "--pictures", "none")
    assert f"Wrote shel-{commit[:7]}.zip: commit {commit[:7]}" in answer.out
    assert (lab / f"shel-{commit[:7]}.zip").is_file()
    assert pico("runs", "export", "--pictures", "none", "--json", "--out", "x.zip").data["commit"] == commit


def test_artifacts_come_along_under_harmless_names(lab: Path, tmp_path: Path, pico: Pico) -> None:
    for data in (b"frame a", b"frame b"):
        LabData.discover(lab).store.put(data)
    rewrite_run(lab, artifacts=[artifact(b"frame a", "../../../etc/x y"), artifact(b"frame b", "../../../etc/x y")])
    found = crate(pico, out=tmp_path / "crate")
    paths = sorted((tmp_path / "crate").rglob("artifacts/*"))
    assert {p.read_bytes() for p in paths} == {b"frame a", b"frame b"}
    assert all(p.name.endswith("_.._.._etc_x_y") for p in paths)
    kinds = [e["encodingFormat"] for e in found.values() if "/artifacts/" in e["@id"] and e["@type"] == "File"]
    assert kinds == ["image/tiff", "image/tiff"]


def test_an_artifact_that_is_not_here_is_named_and_nothing_is_written(lab: Path, tmp_path: Path, pico: Pico) -> None:
    rewrite_run(lab, artifacts=[artifact(b"frame a"), artifact(b"frame b", "other.bin")])
    answer = pico("runs", "export", "--out", str(tmp_path / "crate.zip"))
    assert answer.code == 1
    assert f"frame.bin of run {run_of(lab).name} is not here" in answer.err
    assert f"other.bin of run {run_of(lab).name} is not here" in answer.err
    assert "`pico data pull`" in answer.err
    assert not list(tmp_path.glob("*crate*"))


def test_an_artifact_that_is_damaged_stops_it_and_leaves_nothing_half(lab: Path, tmp_path: Path, pico: Pico) -> None:
    store = LabData.discover(lab).store
    path = store.path(store.put(b"frame a"))
    path.chmod(0o644)
    path.write_bytes(b"Frame a")
    rewrite_run(lab, artifacts=[artifact(b"frame a")])
    answer = pico("runs", "export", "--out", str(tmp_path / "crate.zip"), "--pictures", "none")
    assert answer.code == 1
    assert "is damaged" in answer.err
    assert not list(tmp_path.glob("*crate*"))


def test_a_trace_that_was_changed_afterwards_is_not_published(lab: Path, tmp_path: Path, pico: Pico) -> None:
    trace = run_of(lab) / "trace.jsonl"
    trace.write_text(trace.read_text() + "{}\n")
    git("commit", "-q", "-a", "--amend", "--no-edit")
    answer = pico("runs", "export", "--out", str(tmp_path / "crate"))
    assert answer.code == 1
    assert "error[run-file]" in answer.err
    assert "trace.jsonl is not what run.json beside it says" in answer.err


def test_a_run_of_the_real_table_says_so_and_a_failed_one_says_why(lab: Path, tmp_path: Path, pico: Pico) -> None:
    rewrite_run(lab, evidence="hardware", outcome="interrupted")
    found = crate(pico, out=tmp_path / "crate")
    (action,) = [e for e in found.values() if e["@type"] == "CreateAction"]
    assert action["actionStatus"] == "http://schema.org/FailedActionStatus"
    assert action["error"] == "it ended interrupted"
    assert found[refs(action["additionalProperty"])[0]]["value"] == "hardware"
    assert "IndividualProduct" in {found[name]["@type"] for name in refs(action["instrument"])}
    assert refs(found["./"]["additionalProperty"]) == ["#evidence-planned"]  # the state was not reached by it


def test_a_state_that_no_run_led_to_says_so(shel: Path, tmp_path: Path, pico: Pico) -> None:
    answer = pico("runs", "export", "E1-3", "--out", str(tmp_path / "crate"), "--pictures", "none")
    assert answer.code == 0
    assert "warning[evidence]: no run is known that led to this state" in answer.err
    assert "warning[license]" in answer.err
    found = entities(tmp_path / "crate")
    assert found["#evidence-planned"]["value"] == "planned"
    assert refs(found["./"]["license"]) == ["#no-license"]
    assert "mentions" not in found["./"]


def test_runs_can_be_chosen_among_those_of_the_revision(lab: Path, tmp_path: Path, pico: Pico) -> None:
    first = run_of(lab).name
    pico("set", "p1", "angle=13", "-y")
    pico("commit", "-m", "p1 more")
    made = pico("runs", "export", "--out", str(tmp_path / "a"), "--pictures", "none", "--json").data
    assert len(made["runs"]) == 1
    assert first not in made["runs"]
    made = pico("runs", "export", "--run", first, "--out", str(tmp_path / "b"), "--pictures", "none", "--json").data
    assert made["runs"] == [first] and made["evidence"] == "kinematic"  # another run of it led to the state
    answer = pico("runs", "export", "HEAD~1", "--run", f"{first}x", "--out", str(tmp_path / "c"))
    assert answer.code == 1
    assert f"did you mean `{first}`?" in answer.err


def test_nothing_is_overwritten(lab: Path, tmp_path: Path, pico: Pico) -> None:
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine").write_text("mine")
    (tmp_path / "old.zip").write_text("mine")
    for out in ("full", "old.zip"):
        answer = pico("runs", "export", "--pictures", "none", "--out", str(tmp_path / out))
        assert answer.code == 1
        assert "exists already" in answer.err
    assert (tmp_path / "old.zip").read_text() == (tmp_path / "full" / "mine").read_text() == "mine"
    (tmp_path / "empty").mkdir()
    crate(pico, out=tmp_path / "empty")


def test_nobodys_address_is_published(lab: Path, tmp_path: Path, pico: Pico) -> None:
    crate(pico, out=tmp_path / "crate")
    assert "physicist@localhost" not in (tmp_path / "crate" / "ro-crate-metadata.json").read_text()


def test_a_lab_in_a_folder_of_a_repository_takes_the_license_at_its_top(
    shel: Path, tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    top = tmp_path / "top"
    shutil.copytree(shel, top / "benches" / "my shel", ignore=shutil.ignore_patterns(".git", ".pico"))
    (top / "LICENSE.md").write_text("# CC0\n")
    git("init", "-q", "-b", "main", at=top)
    git("add", "-A", at=top)
    git("commit", "-q", "-m", "all", at=top)
    monkeypatch.chdir(top / "benches" / "my shel")
    found = crate(pico, out=tmp_path / "crate")
    assert found[refs(found["./"]["license"])[0]]["name"] == "# CC0"
    assert "lab/state/table.yaml" in found


def test_pictures_is_all_or_none(lab: Path, pico: Pico) -> None:
    answer = pico("runs", "export", "--pictures", "non")
    assert answer.code == 1
    assert "did you mean `none`?" in answer.err


def test_a_script_publishes_too(lab: Path, tmp_path: Path) -> None:
    import pico

    with pico.open(lab) as bench:
        made = publish(bench.folder, "HEAD", tmp_path / "crate", pictures=False)
        assert bench.history.data.status().absent == ()
    assert made.evidence == "kinematic"
    assert entities(tmp_path / "crate")["./"]["identifier"] == made.commit


def test_a_folder_in_the_lab_is_refused_for_its_manifests_would_be_read(lab: Path, pico: Pico) -> None:
    answer = pico("runs", "export", "--pictures", "none", "--out", "crate")
    assert answer.code == 1 and "is in the lab" in answer.err
    assert not (lab / "crate").exists() and pico("validate").code == 0
    assert pico("runs", "export", "--pictures", "none", "--out", "../crate").code == 0
