"""What the coordinator's disk looks like is told to nobody; a lab may have any name."""

from __future__ import annotations

import json
import socket
import subprocess
from pathlib import Path

import pytest
from coordinators import served
from desks import WARM

from pico.diagnostics import PicoError, error
from pico.server.desk.desks import Desking
from pico.server.desk.hiding import Hiding
from pico.server.git.hosting import git, repository
from pico.server.relay import dispatch


@pytest.mark.parametrize("name", ["books", "bücher", 'a "b" c'])
def test_paths_of_desks_begin_at_the_desk_and_others_in_the_books(tmp_path: Path, name: str) -> None:
    folder = tmp_path / name
    hiding = Hiding(folder)
    texts = {
        f"{folder}/desks/shel/at/{'a' * 40}/lab/x.yaml:3": "lab/x.yaml:3",
        f"{folder}/desks/shel/of/anna is a bare repository": ". is a bare repository",
        f"`git clone {folder}/desks/shel/on/run%anna%abc DIR`": "`git clone . DIR`",
        f"{folder}/git/shel.git/HEAD": "git/shel.git/HEAD",
        f"{folder}: no": ".: no",
        f"{folder}.old/x {folder}2/x": f"{folder}.old/x {folder}2/x",
        "elsewhere/desks/shel": "elsewhere/desks/shel",
    }
    for text, hidden in texts.items():
        assert hiding.of(text.encode()).decode() == hidden
        for ascii in (True, False):
            line = json.dumps({"text": text}, ensure_ascii=ascii).encode()
            assert json.loads(hiding.of(line)) == {"text": hidden}
        told = hiding.error(PicoError(error("git", text, hint=text))).diagnostics[0]
        assert (told.summary, told.hint) == (hidden, hidden)


def test_a_lab_that_is_a_bare_repository_is_told_of_without_the_coordinators_folders(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dispatch, "AWAY", 0.2)  # no edge will ever come
    with served(tmp_path / "books", desks=Desking(WARM)) as serving:
        serving.bench("port/bench1")
        vera = serving.person("vera", "viewer")
        bare = repository(serving.books.folder, "port")
        work = tmp_path / "work"
        subprocess.run(["git", "clone", "-q", bare, work], check=True, capture_output=True)
        for path in ("lab/HEAD", "lab/objects/x", "lab/refs/x", "lab/lab.yaml"):  # as git takes a bare one to be
            (work / path).parent.mkdir(exist_ok=True, parents=True)
            (work / path).write_text("ref: refs/heads/main\n")
        (work / "lab" / "lab.yaml").write_text("kind: Lab\n")
        who = ["-c", "user.name=x", "-c", "user.email=x@y"]
        for words in (["add", "-A"], [*who, "commit", "-qm", "x"], ["push", "-q", bare, "HEAD:main"]):
            subprocess.run(["git", "-C", work, *words], check=True, capture_output=True)
        for command in ("validate", "status", "plan", "log", "diff"):
            status, body = serving.ask("POST", f"/api/labs/port/desk/{command}", vera, {"words": []})
            assert status == 200 and str(tmp_path) not in body.decode(), (command, body)
        git("--git-dir", str(bare), "update-ref", "-d", "refs/heads/main")
        status, body = serving.ask("POST", "/api/labs/port/desk/plan", vera, {"words": []})
        assert status == 400 and str(tmp_path) not in json.dumps(body)
        assert (serving.books.folder / "desks" / "port" / "at").is_dir(), "a lab called `port` has its desks"


def test_the_door_of_desks_stays_at_its_port_which_is_kept_apart_from_the_labs(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as found:
        port = found.getsockname()[1]
    (tmp_path / "desks").mkdir()
    (tmp_path / "desks" / "port").write_text(str(port))
    with served(tmp_path, desks=Desking(WARM)):
        assert (tmp_path / "port").read_text() == str(port) and not (tmp_path / "desks" / "port").exists()
        socket.create_connection(("127.0.0.1", port), 10).close()
