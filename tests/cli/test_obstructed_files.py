"""Something other than a file in the place of a state file: nothing waits for it, it is named with a command that
works, and it never keeps light on."""

from __future__ import annotations

import errno
import json
import os
import re
import signal
import socket
import subprocess
from collections.abc import Iterator
from contextlib import chdir, closing, contextmanager
from pathlib import Path
from types import FrameType

import pytest
from commanding import Brought, Pico, apply_manifest
from pico_cli.session import lost_warning

from pico.base.state_files import JOURNAL, OWN_LAB, WORLD
from pico.diagnostics import PicoError
from pico.model.operation import Operation, OperationResult, Reason
from pico.places.bench import BenchPlace
from pico.runs.journal import Journal
from pico.runs.storage.change_count import ChangeCount

KINDS = ("folder", "pipe", "socket", "link")
OF_BENCH = (
    "journal.sqlite", "journal.sqlite-wal", "journal.sqlite-shm", "armed/laser.json", "unattended.json",
    "unattended.lock", "lock", "holder.json", "settings.json", "devices.json", "lab.json", "changes", "run",
    "called.json", "dose.json", "enrolment.json", "edge.json", "world.json",
)  # fmt: skip
OF_GIT = ("bench.json", "bench.lock", "labs.json", "write.lock", "remotes.json")
CASES = [(f".pico/benches/sim/{name}", KINDS[n % 3]) for n, name in enumerate(OF_BENCH)]
CASES += [(f".git/pico/{name}", KINDS[(n + 1) % 4]) for n, name in enumerate(OF_GIT)]
CASES += [(".pico/benches/sim/armed/laser.json", "link"), (".pico/benches/sim/lock", "link"),
          (".pico/benches/sim/unattended.json", "folder")]  # fmt: skip
MORE = {
    "journal.sqlite": "doctor --journal --yes", "journal.sqlite-wal": "doctor --journal --yes",
    "lab.json": "bench update --yes", "world.json": "sim reset",
}  # fmt: skip
"""What is called after the command that moves the obstacle away, where the content is lost, too."""


TABLE = "world.json"
"""The simulated table itself: while it can't be read, there is nothing that emits."""


@pytest.fixture
def lit(brought: Brought, shel: Path) -> Path:
    """A lab whose laser emits."""
    brought(apply_manifest)
    assert emits(shel)
    return shel


def emits(lab: Path) -> bool:
    world = json.loads((lab / ".pico/benches/sim/world.json").read_text())
    return bool(world["components"]["laser"]["values"]["shutter"]["value"] == "open")


def put(path: Path, kind: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.unlink(missing_ok=True)
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "link":
        path.symlink_to("nowhere")
    else:
        with chdir(path.parent), socket.socket(socket.AF_UNIX) as one:  # a name of its own: paths of sockets are short
            one.bind(path.name)


@contextmanager
def within(seconds: int) -> Iterator[None]:
    def hangs(signum: int, frame: FrameType | None) -> None:
        raise TimeoutError("it waits for something that is no file")

    before = signal.signal(signal.SIGALRM, hangs)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


@pytest.mark.parametrize(("name", "kind"), CASES)
def test_what_is_no_file_is_named_with_what_moves_it_away_and_keeps_no_light_on(
    lit: Path, pico: Pico, name: str, kind: str
) -> None:
    path = lit / name
    put(path, kind)
    with within(60):
        looked = pico("status")
        doctor = pico("doctor")
        assert doctor.code == 1 or "warning" in doctor.err, doctor
        assert str(path) in doctor.err and "internal" not in looked.err + doctor.err
        shut = pico("laser", "disarm", "laser")
    assert "internal" not in shut.err and "read-only" not in looked.err + doctor.err
    if path.name != TABLE and not (kind == "link" and path.parent.name == "sim"):  # nothing is written through a link
        assert shut.code == 0 and not emits(lit), shut
    if os.path.lexists(path) and not path.is_file():  # else the command has moved it away itself
        said = " ".join(doctor.err.split())
        commands = [one for one in re.findall(r"`((?:mv|rm) [^`]*)`", said) if str(path) in one]
        assert len(set(commands)) == 1, said
        subprocess.run(commands[0], shell=True, check=True)
    if path.name in MORE:
        assert pico(*MORE[path.name].split()).code == 0
    after = pico("doctor")
    assert after.code == 0, after
    assert pico("set", "p1", "angle=4", "--yes").code == 0
    assert path.name == TABLE or pico("laser", "disarm", "laser").code == 0


@pytest.mark.parametrize("name", [
    "old", "choice.json", "benches/old", "benches/sim/seen.json", "benches/sim/table-lock.json", "benches/sim/more",
    *(f"benches/sim/{name}" for name in OF_BENCH if "/" not in name and name != TABLE),
])  # fmt: skip
def test_no_symbolic_link_keeps_light_on_and_nothing_is_written_through_it(lit: Path, pico: Pico, name: str) -> None:
    beyond, path = lit.parent / "beyond", lit / ".pico" / name
    beyond.write_text("as it was")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.unlink(missing_ok=True)
    path.symlink_to(beyond)
    moved = pico("set", "p1", "angle=4", "--yes")
    assert moved.code != 0 and "symlink" in moved.err and emits(lit), moved
    stopped, shut = pico("stop", "--now"), pico("laser", "disarm", "laser")
    assert stopped.code == 0 and not emits(lit), (stopped, shut)
    assert "symlink" not in shut.err and beyond.read_text() == "as it was", shut


@pytest.mark.parametrize(
    "name", [".git/pico/bench.json", ".git/pico/remotes.json", ".pico/benches/sim/table-lock.json"]
)
def test_a_person_locks_the_bench_and_stops_it_whatever_lies_in_the_place_of_a_file(
    shel: Path, pico: Pico, name: str
) -> None:
    subprocess.run(["git", "config", "user.name", "Ada Lovelace"], cwd=shel, check=True)
    put(shel / name, "folder")
    with within(60):
        locked, stopped = pico("lease", "lock", "--reason", "mirrors"), pico("stop", "--now")
    assert locked.code == 0 and "Ada Lovelace locked the bench" in locked.out, locked
    assert stopped.code == 0, stopped
    assert (shel / ".pico/benches/sim/table-lock.json").is_file()


def test_an_enrolled_bench_that_nothing_serves_is_shut_by_hand(lit: Path, pico: Pico) -> None:
    note = {"url": "https://lab.example.org", "bench": "shel/bench1", "key": "00" * 32, "pin": ""}
    (lit / ".pico/benches/sim/enrolment.json").write_text(json.dumps(note))
    assert pico("set", "p1", "angle=4", "--yes").code == 5, "only its coordinator grants it"
    assert pico("laser", "disarm", "laser").code == 0 and not emits(lit)


def test_a_count_that_is_deleted_while_the_journal_is_open_is_written_again(tmp_path: Path) -> None:
    count = ChangeCount(tmp_path / JOURNAL.name)
    count.note(3, durable=True)
    (tmp_path / "changes").unlink()
    count.note(4, durable=True)
    assert ChangeCount(tmp_path / JOURNAL.name).least() == 4
    count.close()
    (tmp_path / "changes").unlink()
    (tmp_path / "changes").mkdir()
    count.note(5, durable=True)
    assert ChangeCount(tmp_path / JOURNAL.name).least() == 5 and (tmp_path / "changes.damaged").is_dir()
    count.close()


def test_what_is_in_the_way_is_set_aside_under_a_name_that_is_free(tmp_path: Path) -> None:
    path = tmp_path / "lab.json"
    (tmp_path / "lab.json.damaged").write_text("kept")
    path.mkdir()
    with pytest.raises(PicoError, match="it is a folder") as refused:
        OWN_LAB.read(path, dict)
    assert f"`mv {path} {path}.damaged-2`" in refused.value.diagnostics[0].hint
    OWN_LAB.write(path, {"a": 1})
    assert path.is_file() and (tmp_path / "lab.json.damaged-2").is_dir()
    assert (tmp_path / "lab.json.damaged").read_text() == "kept"


def test_permissions_that_keep_a_file_from_being_read_are_named_with_what_gives_them(tmp_path: Path) -> None:
    path = tmp_path / "lab.json"
    path.write_text("{}")
    said = OWN_LAB.unusable(path, PermissionError(13, "Permission denied"))
    assert "permission denied" in said.summary and f"`chmod u+rw {path}`" in said.hint


def test_a_journal_or_a_table_that_is_gone_is_missed_by_doctor(lit: Path, pico: Pico) -> None:
    folder = lit / ".pico/benches/sim"
    (folder / "world.json").unlink()
    said = pico("doctor")
    assert said.code == 1 and str(folder / "world.json") in said.err and "`pico --bench sim sim reset`" in said.err
    (folder / "journal.sqlite").unlink()
    (folder / "changes").unlink()
    assert str(folder / "journal.sqlite") in pico("doctor").err


def test_a_laser_is_shut_though_the_journal_cannot_be_used(lit: Path, pico: Pico) -> None:
    (lit / ".pico/benches/sim/journal.sqlite").write_bytes(b"no database" * 1000)
    assert pico("apply", "--yes").code != 0
    assert pico("laser", "disarm", "laser").code == 0 and not emits(lit)


def test_a_table_of_emulated_devices_that_begins_anew_is_reported(lit: Path, pico: Pico) -> None:
    place = BenchPlace(lit, "emulated")
    with closing(Journal(JOURNAL.path(place.own))) as journal:
        journal.begin_run("r1", "plan", "test", about={"environment": {"backend": "emulated"}})
        assert lost_warning(place) == (), "nothing was moved"
        reason = Reason(kind="changed")
        journal.intend("r1/a/1", Operation(id="a", primitive="set", component="p1", reason=reason), 1)
        journal.started("r1/a/1", None, 1)
        journal.ended(OperationResult(key="r1/a/1", outcome="done"), 1)
    (said,) = lost_warning(place)
    assert said.severity == "warning" and str(WORLD.path(place.own)) in said.summary
    assert "it begins anew" in said.summary and "every part stands at its home" in said.hint
    assert str(WORLD.path(place.own)) in pico("doctor").err
    WORLD.path(place.own).write_text("{}")
    assert lost_warning(place) == ()


def test_a_file_in_the_place_of_the_folder_of_all_is_named_with_what_moves_it_away(
    shel: Path, pico: Pico, tmp_path: Path
) -> None:
    subprocess.run(["rm", "-rf", ".pico"], check=True)
    Path(".pico").write_text("mine")
    for command in ("status", "doctor"):
        said = pico(command).err
        assert f"`mv {shel}/.pico {shel}/.pico.damaged`" in said and "ls -ld" not in said, said


def test_an_emptied_lab_of_a_bench_is_called_empty_and_once(lit: Path, pico: Pico) -> None:
    (lit / ".pico/benches/sim/lab.json").write_text("")
    said = pico("status").err
    assert "the file is empty" in said and "commit may" not in said and "bench update" in said, said
    assert pico("doctor").err.count("error[bench-lab]") == 1


def test_a_full_disk_leaves_no_half_of_the_command_that_was_approved(
    lit: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from pico.bench.undo import intention

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, "no space left on device")

    place = BenchPlace(lit, "sim")
    monkeypatch.setattr(intention.os, "fsync", full)
    intention.keep(place, "apply")()
    assert not (place.folder / "called.json").exists()


def test_doctor_names_a_disk_that_is_full(shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    from pico import disk

    assert "disk-full" not in pico("doctor").err
    monkeypatch.setattr(disk, "LEAST", 1 << 62)
    full = pico("doctor")
    assert full.code == 1 and "error[disk-full]" in full.err and "make room there" in full.err, full.err
