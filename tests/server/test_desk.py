"""Commands at a desk of the coordinator: what somebody without a checkout sees and does, as whom, and no more."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from desks import Desked, desked, pushed

from pico.history.examples.example import make_example
from pico.server.desk.words import COMMANDS


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Desked]:
    folder = tmp_path_factory.mktemp("desk")
    root = make_example("shel", folder / "shel").root
    with desked(folder / "books", root) as found:
        yield found


def test_who_has_no_checkout_looks_plans_edits_commits_and_applies(desk: Desked) -> None:
    anna = desk.served.person("anna", "operator")
    assert desk.said(anna, "plan", "e1")[0]["operations"]
    desk.said(anna, "set", "p1.angle", "3", "-y")
    rows = {f"{r['component']}.{r['tunable']}": r for r in desk.said(anna, "status")[0]["rows"]}
    assert rows["p1.angle"]["live"] == 3.0
    documents = desk.said(anna, "apply", "e1", "-y")
    assert [d for d in documents if d.get("kind") == "operation_done"]
    desk.said(anna, "set", "p1.angle", "3", "-y")
    desk.said(anna, "capture")
    assert any(r["edited"] for r in desk.said(anna, "status")[0]["rows"])
    made = desk.said(anna, "commit", "-m", "three degrees")[0]
    assert made["evidence"] == "kinematic"
    assert desk.git("log", "-1", "--format=%an <%ae> %s", "web/anna") == "anna <anna@pico.invalid> three degrees"
    assert desk.git("rev-parse", "main") == desk.git("rev-parse", "web/anna~1")
    _, runs = desk.served.ask("GET", "/api/labs/shel/desk/runs", anna)
    latest = runs["runs"][0]
    assert (latest["command"], latest["exit"], latest["who"], len(latest["runs"])) == ("set", 0, "anna", 1)
    entries = desk.served.ask("GET", "/api/audit", desk.served.person("root", "admin"))[1]["entries"]
    assert {entry["who"] for entry in entries if entry["session"]} == {"anna"}


def test_who_may_not_change_the_lab_looks_at_its_main_branch(desk: Desked) -> None:
    vera, ben = desk.served.person("vera", "viewer"), desk.served.person("ben", "operator")
    desk.said(ben, "set", "p1.angle", "7", "-y")
    desk.said(ben, "capture")
    edited = [row["edited"] for row in desk.said(vera, "status")[0]["rows"]]
    assert edited and not any(edited)
    assert "web/vera" not in desk.git("branch")
    assert desk.at(vera, "set", "p1.angle", "1", "-y")[0] == 403
    desired = {r["component"]: r["desired"] for r in desk.said(vera, "status", at="e1")[0]["rows"]}
    assert desired != {r["component"]: r["desired"] for r in desk.said(vera, "status")[0]["rows"]}


def test_a_picture_that_lies_at_the_edge_is_seen_at_a_desk_and_by_who_only_looks(desk: Desked) -> None:
    carl, nora = desk.served.person("carl", "operator"), desk.served.person("nora", "viewer")
    run = next(d["run"] for d in desk.said(carl, "measure", "cam.image", "-y") if d["schema"] == "pico.measurement/v1")
    (seen,) = desk.said(carl, "runs pictures", run, "--width", "160")
    assert seen["schema"] == "pico.still/v1" and 0 < seen["width"] <= 160 and len(seen["png"]) > 100
    desk.said(carl, "commit", "-m", "a picture", "--capture")
    (later,) = desk.said(nora, "runs pictures", run, "--width", "160", at="web/carl")
    assert all(later[key] == seen[key] for key in ("component", "measurable", "sha256", "png", "marks"))
    assert desk.at(nora, "runs pictures", run, "--out", "here")[0] == 400


def test_a_branch_and_a_tag_are_made_and_what_only_says_what_it_would_do_is_no_run(desk: Desked) -> None:
    anna = desk.served.person("anna", "operator")
    assert desk.said(anna, "git branch", "tilted", "e1")[0]["commit"] == desk.git("rev-parse", "tilted")
    desk.said(anna, "git tag", "E1-9", "e1")
    assert desk.git("rev-parse", "tilted") == desk.git("rev-parse", "e1") == desk.git("rev-parse", "E1-9")
    assert desk.at(anna, "git branch", "tilted", "e2")[1][-1]["exit"] != 0
    _, before = desk.served.ask("GET", "/api/labs/shel/desk/runs", anna)
    written = desk.said(anna, "move", "lx_100", "x=800", "y=600", "yaw=0", "--manifest", "--dry-run")[0]
    assert written["changes"] and not any(r["edited"] for r in desk.said(anna, "status")[0]["rows"])
    assert desk.served.ask("GET", "/api/labs/shel/desk/runs", anna)[1] == before


def test_what_is_no_word_of_a_command_is_refused_before_anything_starts(desk: Desked) -> None:
    anna = desk.served.person("anna", "operator")
    refused = {
        "plan": (["-C", "/"], ["--out", "x"], ["--out=x"], ["--picture=x.png"], ["--bench", "local"], ["--debug"],
                 ["/etc/passwd"], ["../x"], ["a/../../x"], ["~root/x"], [".git/config"], ["e1", "--", "../x"],
                 ["--exclude", "--out=x"], ["--exact=--out=x"], ["--ex"], ["--backend=hardware"], ["\x00"],
                 ["\x1b[2J"]),
        "commit": (["-F", "/etc/passwd"], ["-mx"], ["-m=x"], ["-e"], ["-m"], ["--message", "-C"]),
        "run": (["/etc/passwd"], ["--junit=x"], ["--detach"], ["x/../../y"]),
        "log": (["--output=x"], ["--format=x"], ["-nx"]),
        "git branch": (["web/ben"], ["detached/x"], ["-d", "main"], ["--", "../x"]),
        "validate": (["/etc/passwd"], ["..\\x"]),
    }  # fmt: skip
    for command, wordings in refused.items():
        for words in wordings:
            status, documents = desk.at(anna, command, *words)
            assert status == 400 and documents[0]["error"][0]["code"] == "usage", (command, words, documents)
    assert desk.at(anna, "commit", "-m", "-5 mm")[1][0]["error"][0]["hint"] == "`--message=VALUE` where it begins so"
    assert desk.at(anna, "plan", *["x"] * 201)[0] == 422 and desk.at(anna, "plan", "x" * 10_001)[0] == 400
    for path in ("serve", "token", "git", "push", "pull", "init", "test", "edge", "..%2fruns"):
        assert desk.served.ask("POST", f"/api/labs/shel/desk/{path}", anna, {"words": []})[0] in (404, 405), path
    for at in ("-C", "--output=x", "/etc", "a b", "../x", "x:y", "@{-1}", ""):
        assert desk.at(anna, "plan", at=at)[0] in (400, 422), at
    assert desk.at(anna, "plan", at="nothing")[0] == 400 and desk.at(anna, "commit", "-m", "x", at="main")[0] == 400
    assert desk.at(anna, "plan", session="../x")[0] == 400 and desk.at(anna, "plan", bench="other")[0] == 404


def test_options_of_desks_are_options_of_the_command_and_none_names_a_file() -> None:
    from pico_cli.app import build

    for name, command in COMMANDS.items():
        found = build()
        for word in name.split():
            found = found.get_command(None, word)
        there = {
            f"{option}{'' if parameter.is_flag else '='}": str(parameter.metavar)
            for parameter in found.params if parameter.param_type_name == "option"
            for option in parameter.opts
        }  # fmt: skip
        assert command.options <= set(there), (name, command.options - set(there))
        named = {option: there[option] for option in command.options}
        files = ("FILE", "PNG", "DIR", "HTML", "PDF")
        assert not [o for o, metavar in named.items() if any(word in metavar for word in files)], name


def test_a_repository_that_somebody_pushed_reaches_nothing_outside_of_the_desk(desk: Desked, tmp_path: Path) -> None:
    secret = tmp_path / "secret.yaml"
    secret.write_text("apiVersion: pico/v1\nkind: Recipe\ntreasure: pico_token_of_somebody\n")
    clone, mallory = tmp_path / "clone", desk.served.person("mallory", "operator")
    subprocess.run(["git", "clone", "-q", desk.bare, clone], check=True)
    hook = clone / ".git-hooks" / "post-checkout"
    hook.parent.mkdir()
    hook.write_text(f"#!/bin/sh\ntouch {tmp_path}/hooked\n")
    hook.chmod(0o755)
    (clone / ".gitattributes").write_text("*.yaml filter=evil merge=evil diff=evil\n")
    for name, path in (("reader", secret), ("away", f"{'../' * 12}{str(secret).lstrip('/')}")):
        (clone / "recipes" / f"{name}.yaml").write_text(
            f"apiVersion: pico/v1\nkind: Recipe\nmetadata: {{name: {name}}}\nsteps:\n  - call: {path}\n"
        )

    def committed(branch: str) -> None:
        for words in (["add", "-A"], ["-c", "user.name=m", "-c", "user.email=m@x", "commit", "-qm", branch]):
            subprocess.run(["git", "-C", clone, *words], check=True)
        pushed(clone, desk.bare, f"HEAD:{branch}")

    committed("calls")
    (clone / "state" / "stolen.yaml").symlink_to(secret)
    (clone / "recipes" / "theft.yaml").symlink_to(secret)
    (clone / "inside").symlink_to(tmp_path)
    committed("links")
    for branch, command, *words in (
        ("calls", "validate"), ("calls", "recipe check", "reader"), ("calls", "recipe check", "away"),
        ("calls", "run", "reader", "-y"), ("calls", "recipe list"), ("links", "validate"), ("links", "status"),
        ("links", "validate", "inside/secret.yaml"), ("links", "recipe check", "theft"), ("links", "blame", "p1"),
        ("links", "plan", "inside/secret.yaml"), ("main", "diff", "main", "links"), ("main", "show", "links"),
        ("main", "plan", "links"), ("main", "checkout", "links", "--files-only", "-y"),
    ):  # fmt: skip
        status, documents = desk.at(mallory, command, *words, at=branch)
        said = json.dumps(documents)
        assert status == 200 and "treasure" not in said and "pico_token" not in said, (command, words, said[-2000:])
        assert '"internal"' not in said, (command, words, said[-2000:])
        if "reader" in words or "away" in words:
            assert "can't be read" in said, said[-2000:]
    assert not (tmp_path / "hooked").exists()


def test_a_commit_that_comes_from_elsewhere_meets_the_desk(desk: Desked, tmp_path: Path) -> None:
    dora = desk.served.person("dora", "operator")
    assert not any(row["edited"] for row in desk.said(dora, "status")[0]["rows"])
    text = desk.git("show", "main:state/table.yaml")
    edit = {
        "base": "web/dora",
        "message": "eleven",
        "files": {"state/table.yaml": text.replace("angle: 90", "angle: 11")},
    }
    assert desk.served.ask("POST", "/api/labs/shel/edits", dora, edit)[0] == 200
    rows = {f"{r['component']}.{r['tunable']}": r for r in desk.said(dora, "status")[0]["rows"]}
    assert rows["p1.angle"]["desired"] == 11.0 and not rows["p1.angle"]["edited"]
    clone = tmp_path / "clone"
    subprocess.run(["git", "clone", "-q", "-b", "web/dora", desk.bare, clone], check=True)
    (clone / "state" / "table.yaml").write_text(text.replace("angle: 90", "angle: 12"))
    subprocess.run(
        ["git", "-C", clone, "-c", "user.name=d", "-c", "user.email=d@x", "commit", "-qam", "twelve"], check=True
    )
    pushed(clone, desk.bare, "HEAD:web/dora")
    rows = {f"{r['component']}.{r['tunable']}": r for r in desk.said(dora, "status")[0]["rows"]}
    assert rows["p1.angle"]["desired"] == 12.0 and not rows["p1.angle"]["edited"]


def test_a_small_push_that_names_very_many_files_is_not_checked_out(desk: Desked, tmp_path: Path) -> None:
    def made(*words: str, said: str = "") -> str:
        done = subprocess.run(["git", "--git-dir", desk.bare, *words], input=said, text=True, capture_output=True,
                              check=False)  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()

    tree = made("hash-object", "-w", "--stdin", said="x")
    mode = "100644 blob"
    for _ in range(6):
        tree = made("mktree", said="".join(f"{mode} {tree}\tn{n}\n" for n in range(10)))
        mode = "040000 tree"
    bomb = made("-c", "user.name=m", "-c", "user.email=m@x", "commit-tree", tree, "-m", "many")
    status, documents = desk.at(desk.served.person("mallory", "operator"), "plan", at=bomb)
    assert status == 413 and "20000 files" in documents[0]["error"][0]["summary"], (status, documents)


def test_tokens_of_commands_carry_no_more_than_the_one_that_asked_and_are_over_with_them(desk: Desked) -> None:
    from pico.server.access.principal import right

    desk.served.person("carla", "operator@shel", "lease:steal")
    people = desk.served.books.people
    narrow = people.issued("carla", 3600.0, by="carla", scope=[right("operator@shel")]).secret
    desk.said(narrow, "validate")
    desk.said(narrow, "note", "p1", "looks dusty")
    left = [one for one in people.tokens("carla") if one["label"].startswith("desk")]
    assert [one["label"] for one in left] == ["desk"] and left[0]["scope"] == ["operator@shel"]
    assert left[0]["expires_at"] - left[0]["created_at"] < 600


def test_what_others_did_at_the_bench_is_listed_beside_ones_own_runs(desk: Desked) -> None:
    anna, ben = desk.served.person("anna", "operator"), desk.served.person("ben", "operator")
    desk.said(ben, "set", "p1", "angle=7", "-y")
    (mine,) = (one["document"] for one in desk.said(ben, "runs list", "--others")[0]["runs"][:1])
    found = desk.said(anna, "runs list", "--all", "--others")[0]
    theirs = found["others"][0]["document"]
    assert (theirs["id"], theirs["operator"]) == (mine["id"], "ben")
    assert mine["id"] not in [one["document"]["id"] for one in found["runs"]]
    assert desk.said(anna, "runs show", mine["id"][-6:])[0]["document"]["id"] == mine["id"]
    assert desk.said(anna, "runs list")[0]["others"] == []
    assert mine["id"] not in [o["document"]["id"] for o in desk.said(ben, "runs list", "--others")[0]["others"]]
