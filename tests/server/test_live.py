"""A bench as pages see it: its scene, then what changes, by one stream from the edge however many watch."""

from __future__ import annotations

import json
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from coordinators import BENCH, Served
from edges import Connected, client, connected
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from pico.backends.hardware.guard.ending import Closing, LightEnd
from pico.backends.hardware.guard.note import Ended, Note, write
from pico.drawing.scene.frames import Frame, decoded
from pico.edge.live import following
from pico.history.examples.example import make_example
from pico.model.operation import Operation, Reason
from pico.server.live import watching
from pico.server.live.shown import Shown
from pico.server.live.watcher import MOST, Watcher

SCENE, LIVE = f"/api/benches/{BENCH}/scene", f"/api/benches/{BENCH}/live"


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_example("shel", tmp_path_factory.mktemp("live") / "shel").root


@pytest.fixture
def edge(coordinator: Served, example: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Connected]:
    monkeypatch.setattr(watching, "LINGERS", 0.2)
    shutil.copytree(example, tmp_path / "shel")
    with connected(coordinator, tmp_path / "shel") as found:
        yield found


class Page:
    """What a page knows: the scene, frames by their number, events."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket, self.frames, self.events = socket, list[Frame](), list[dict[str, Any]]()
        self.hello = json.loads(socket.recv(timeout=30))["hello"]
        self.known = self.hello["seq"]

    def hear(self) -> None:
        said = self.socket.recv(timeout=30)
        if isinstance(said, bytes):
            self.frames.append(decoded(said))
        else:
            self.events.append(json.loads(said))

    def until_event(self, kind: str) -> dict[str, Any]:
        """Return the next event of a kind after the one that this returned last."""
        while not (found := [event for event in self.events if event["kind"] == kind and event["seq"] > self.known]):
            self.hear()
        self.known = found[0]["seq"]
        return found[0]

    def until_at(self, index: int, x: float) -> Frame:
        """Return the next frame in which a body is at x [mm]."""
        while True:
            known = len(self.frames)
            self.hear()
            for frame in self.frames[known:]:
                if index in frame.bodies and abs(frame.bodies[index][0] - x) < 1e-3:
                    return frame


@contextmanager
def watched(coordinator: Served, token: str) -> Iterator[Page]:
    with coordinator.watch(LIVE, token) as socket:
        yield Page(socket)


def until(condition: Any) -> None:
    while not condition():
        time.sleep(0.01)


def turn(angle: float) -> Operation:
    return Operation(
        id="op1", primitive="set", component="p1", arguments={"tunable": "angle", "to": angle},
        reason=Reason(kind="asked"),
    )  # fmt: skip


def test_a_page_sees_what_is_pushed_turned_and_run_in_order(coordinator: Served, edge: Connected) -> None:
    anna, ben = coordinator.person("anna", "operator@shel"), coordinator.person("ben", "viewer@shel")
    status, scene = coordinator.ask("GET", SCENE, ben)
    assert status == 200 and scene["schema"] == "pico.scene/v1" and scene["arms"][0]["name"] == "arm1"
    part = next(part for part in scene["components"] if part["name"] == "p1")
    with watched(coordinator, ben) as page, client(coordinator, anna) as working:
        assert (page.hello["epoch"], page.hello["rev"]) == (scene["epoch"], scene["rev"])
        page.hear()
        assert set(page.frames[0].bodies) == {p["index"] for p in scene["components"] if p["position"]}
        pushed = part["position"][0] + 3
        working.ask("world.nudge", "p1", 3.0, 0.0, 0.0)
        page.until_at(part["index"], pushed)
        page.until_event("beams")
        lease = working.ask("acquire", "anna", 10.0)
        working.ask("execute", turn(33.0), "r0/op1/1", lease)
        stands = page.until_event("component")["data"]
        assert (stands["name"], stands["values"]["angle"]["value"]) == ("p1", 33.0)
        numbers = [event["seq"] for event in page.events]
        assert numbers == list(range(page.hello["seq"] + 1, page.hello["seq"] + 1 + len(numbers)))
        assert [event["rev"] for event in page.events] == sorted(event["rev"] for event in page.events)
        assert any(event["kind"] == "lease" and event["data"]["who"] == "anna" for event in page.events)
    now = coordinator.ask("GET", SCENE, ben)[1]
    after = next(part for part in now["components"] if part["name"] == "p1")
    assert after["position"][0] == pytest.approx(pushed) and after["values"]["angle"]["value"] == 33.0
    assert after["pose"]["x"] == pytest.approx(pushed) and now["epoch"] == scene["epoch"]


def test_a_page_hears_what_the_guard_ended_and_one_opened_later_reads_it(
    coordinator: Served, edge: Connected, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(following, "LightGuarded", object)  # the simulated bench has no light to guard
    ben = coordinator.person("ben", "viewer@shel")
    dark = LightEnd(laser="laser", closings=(Closing(address="laser.shutter", dark=True),))
    with watched(coordinator, ben) as page:
        page.until_event("scene") if page.hello["epoch"] is None else page.hear()
        before = coordinator.ask("GET", SCENE, ben)[1]
        assert "guard" not in before
        note = Note(ended=Ended(at="2026-11-24T12:00:00Z", why="door_box (door) is not safe", ends=(dark,)))
        write(edge.edge.place, note)
        event = page.until_event("guard")
        (said,) = event["data"]["notices"]
        assert "light of laser was ended" in said["summary"] and "door_box (door) is not safe" in said["summary"]
        assert "laser.shutter" in said["detail"] and said["hint"] == "make the table safe, then let light out anew"
        assert event["rev"] > before["rev"], "pages pass over what is not newer than their scene"
    later = coordinator.ask("GET", SCENE, ben)[1]
    assert later["guard"] == [said] and later["rev"] >= event["rev"]


def test_many_watch_by_one_stream_which_ends_with_the_last(coordinator: Served, edge: Connected) -> None:
    token = coordinator.person("ben", "viewer@shel")
    with watched(coordinator, token) as one, watched(coordinator, token) as two, watched(coordinator, token) as three:
        for page in (one, two, three):
            while not page.frames:
                page.hear()
        assert len({page.frames[-1].epoch for page in (one, two, three)}) == 1
        assert len(edge.edge.runs._listeners) == 1
    until(lambda: not edge.edge.runs._listeners)


def test_a_page_hears_that_the_edge_is_away_and_that_another_scene_begins(coordinator: Served, edge: Connected) -> None:
    token = coordinator.person("ben", "viewer@shel")
    with watched(coordinator, token) as page:
        page.until_event("scene") if page.hello["epoch"] is None else page.hear()
        edge.cut()
        assert page.until_event("away")["epoch"] is None
        again = page.until_event("scene")
        assert again["epoch"] not in (None, page.hello["epoch"])
        assert coordinator.ask("GET", SCENE, token)[1]["epoch"] == again["epoch"]


def test_where_no_edge_is_there_is_no_scene(coordinator: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watching, "AWAY", 0.1)
    coordinator.bench()
    token = coordinator.person("ben", "viewer@shel")
    status, said = coordinator.ask("GET", SCENE, token)
    assert status == 503 and "not connected" in said["error"][0]["summary"]
    assert coordinator.ask("GET", "/api/benches/shel/none/scene", token)[0] == 404
    with watched(coordinator, token) as page:
        assert page.hello["epoch"] is None


def test_a_page_whose_token_is_revoked_sees_nothing_more(coordinator: Served, edge: Connected) -> None:
    token = coordinator.person("ben", "viewer@shel")
    with watched(coordinator, token) as page:
        coordinator.books.people.settled("ben", [], by="root", disabled=True)
        with pytest.raises(ConnectionClosed) as over:
            while True:
                page.socket.recv(timeout=30)
    assert over.value.rcvd is not None and over.value.rcvd.code == 4401


def test_who_is_slow_skips_frames_and_leaves_out_no_event() -> None:
    slow, quick = Watcher(), Watcher()
    for number in range(3):
        slow.show(b"%d" % number, lambda: b"all of it")
        quick.show(b"%d" % number, lambda: b"all of it")
        slow.tell(f"event {number}")
        assert quick.taken() == [b"%d" % number]
    assert slow.taken() == ["event 0", "event 1", "event 2", b"all of it"] and slow.taken() == []
    for number in range(MOST):
        slow.tell(str(number))
    assert not slow.lost
    slow.tell("one too many")
    assert slow.lost and len(slow.taken()) == MOST


def test_what_was_moved_before_somebody_came_is_in_the_first_frame() -> None:
    place: dict[str, Any] = {"position": [1, 2, 3], "quaternion": [1, 0, 0, 0]}
    shown = Shown({
        "epoch": 7, "rev": 0, "time": 0.0, "beams": [], "components": [{"index": 0, "name": "p1", **place}],
        "arms": [{"index": 0, "name": "a", "known": True, "joints": [0.5], "width": 4.0}],
    })  # fmt: skip
    first = decoded(shown.moved({"time": 1.0, "arms": [], "bodies": [[0, 5, 6, 7, 0, 0, 0, 1]]}))
    assert not first.arms and first.bodies == {0: (5, 6, 7, 0, 0, 0, 1)}
    shown.told("component", 3, {"index": 1, "name": "new", **place})
    whole = decoded(shown.whole())
    assert (whole.epoch, whole.rev, whole.time) == (7, 3, 1.0) and whole.bodies[1][:3] == (1, 2, 3)
    assert decoded(shown.moved({"time": 2.0, "arms": [], "bodies": []})).bodies.keys() == {0, 1}, "nothing moves: all"
    shown.told("component", 4, {"index": 0, "name": "p1", "position": None, "quaternion": None})
    assert decoded(shown.whole()).bodies.keys() == {1} and shown.scene()["components"][0]["position"] is None
