"""Somebody steers a component by the keys of a terminal: each key that is pressed is a frame to the edge, and one that
is held is a frame each time that the terminal says that it is still there."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError
from pico.model.record import as_json
from pico.teleop.steps import ladder

from ..session import Session, standing
from ..terminal.keys import Key, Keys
from ..terminal.output import write
from ..views import teleop as view

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.bench.teleoperation import Teleoperation
    from pico.model.measurement import Measurement

READ = 0.01
"""Longest wait for a key [s]."""
OFTEN, SELDOM = 0.03, 0.1
"""Seconds between two questions to the terminal whether it is there: while something may move, and else."""
DRAWN, PEEKED = 0.1, 0.5
"""Seconds between two times that the line is drawn, and between two looks at what it shows."""
_LONGEST_FIRST = 3
"""The step that is chosen first is so many below the longest one."""
_IN_PLANE = {
    "left": ("x", -1), "right": ("x", 1), "down": ("y", -1), "up": ("y", 1), "pgup": ("yaw", 1), "pgdn": ("yaw", -1),
    "h": ("x", -1), "l": ("x", 1), "j": ("y", -1), "k": ("y", 1),
}  # fmt: skip
_ALONG = {"left": -1, "down": -1, "pgdn": -1, "h": -1, "j": -1, "right": 1, "up": 1, "pgup": 1, "l": 1, "k": 1}
_ENDS = ("q", "esc", "ctrl-c", "ctrl-d")


class Steering:
    """A person at the keys. `shown`: a measurable that stands beside the values, by component and name."""

    def __init__(
        self, session: Session, bench: Bench, jog: Teleoperation, keys: Keys, step: float | None,
        shown: tuple[str, str] | None,
    ) -> None:  # fmt: skip
        self.session, self.bench, self.jog, self.keys = session, bench, jog, keys
        self.in_hand = jog.operation.robot is not None
        self.rungs = {name: ladder(one.longest) for name, one in jog.known.items()}
        self.steps = {name: _first(rungs, step) for name, rungs in self.rungs.items()}
        self.chosen = next(iter(jog.known))
        self.held: tuple[str, str, float] | None = None
        self.press, self.missed, self.ending, self.stopped, self.told = 0, 0, False, False, 0
        self.asked = self.drawn = self.peeked = 0.0
        self.waits, self.line = False, ""
        self.shown, self.peek = shown, None
        self.seen: str = ""
        self.terminal = sys.stdout.isatty() and not session.json

    peek: Future[Measurement] | None

    def run(self) -> None:
        """Steer until it is over; raises PicoError where it can't be begun, or was cut short."""
        with _signals() as came:
            self.jog.begin()
            while not self.jog.over:
                for key in self.keys.read(READ):
                    self.heard(key)
                while came:
                    (self.end if came.pop() == signal.SIGINT else self.lost)()
                self.beat()
                self.news()
                self.draw()
        if self.terminal:
            write(sys.stdout, "", end="", over=True)

    # the end

    def end(self) -> None:
        """End in order; asked again, stop at once."""
        if self.ending and not self.stopped:
            self.stop()
        self.ending, self.held = True, None

    def lost(self) -> None:
        """Nobody is there any more: an arm stays where it is, with what it holds."""
        if self.in_hand and not self.stopped:
            self.stop()
        self.ending, self.held = True, None

    def stop(self) -> None:
        """Stop all motion now."""
        self.stopped = True
        self.jog.run.stop()

    # what is heard

    def heard(self, key: Key) -> None:
        """Do what a key says."""
        if key.kind == "lost":
            self.lost()
            time.sleep(READ)
        elif key.kind == "alive":
            self.waits = False
            self.frame()
        elif key.kind == "unfocused" or (key.kind == "release" and self.held and key.name == self.held[0]):
            self.release()
        elif key.kind == "press" and key.name in _ENDS:
            self.end()
        elif key.kind != "release" and key.name in ("+", "=", "-", "_"):
            self.size(1 if key.name in "+=" else -1)
        elif key.kind == "press":
            self.pressed(key)

    def pressed(self, key: Key) -> None:
        """Choose, tell the keys, or make a step."""
        if key.name == "tab":
            names = list(self.jog.known)
            self.chosen = names[(names.index(self.chosen) + 1) % len(names)]
        elif key.name in ("?", "/"):
            self.help()
        elif self.jog.ready and not self.ending and (to := self.motion(key.name)):
            self.chosen = to[0]
            self.press, self.missed = self.jog.press(), self.jog.answer.missed
            self.held = (key.name, to[0], to[1] * self.steps[to[0]])
            self.frame()
            if not self.keys.releases:  # one step, and no more until it is pressed again
                self.held = None

    def motion(self, key: str) -> tuple[str, float] | None:
        """Return what a key moves, and which way."""
        if self.in_hand:
            return _IN_PLANE.get(key)
        return (self.chosen, _ALONG[key]) if key in _ALONG else None

    def size(self, way: int) -> None:
        """Take the next larger, or smaller, step."""
        rungs = self.rungs[self.chosen]
        near = min(range(len(rungs)), key=lambda n: abs(rungs[n] - self.steps[self.chosen]))
        self.steps[self.chosen] = rungs[min(max(near + way, 0), len(rungs) - 1)]

    def release(self) -> None:
        """Say that no key is down any more."""
        self.held = None
        self.jog.hear(release=True)

    def frame(self) -> None:
        """Say what is wanted, or only that somebody is there."""
        if self.held is None or self.ending:
            self.jog.hear(end=self.ending)
            return
        _, tunable, by = self.held
        answer = self.jog.hear(tunable=tunable, by=by, press=self.press)
        if answer.refused or answer.missed > self.missed:
            self.held = None  # going on takes a fresh press

    # what is said

    def beat(self) -> None:
        """Ask the terminal whether it is there; where it never says so, or is gone, only say that somebody is."""
        now = time.monotonic()
        every = OFTEN if self.held or not self.jog.ready else SELDOM
        if now - self.asked < every or (self.waits and not self.ending):
            return
        self.asked = now
        if self.keys.answers and not self.ending:
            self.waits = True
            self.keys.ask()
        else:
            self.frame()

    def news(self) -> None:
        """Tell the events since the last time."""
        new, self.told = self.jog.events[self.told :], len(self.jog.events)
        for event in new:
            for before in standing:
                before.begun |= bool(event.operation)
            if self.session.json:
                self.session.document(as_json(event))

    def help(self) -> None:
        """Tell what the keys do."""
        if self.terminal:
            write(sys.stdout, "", end="", over=True)
        for text in view.help_lines(self.in_hand, self.keys.releases):
            self.session.say(text)
        self.line = ""

    def draw(self) -> None:
        """Draw the line anew where it changed."""
        now = time.monotonic()
        if not self.terminal or now - self.drawn < DRAWN:
            return
        self.drawn = now
        self.look(now)
        line = self.now()
        if line != self.line:
            self.line = line
            write(sys.stdout, line, end="", over=True)

    def now(self) -> str:
        """Return the line."""
        name, jog = self.jog.operation.component, self.jog
        if not jog.ready:
            doing = "setting it down" if self.ending else "taking it in hand"
            return f"{name}: {doing} ..." if self.in_hand else f"{name}: ..."
        return view.line(name, jog.known, jog.values, self.chosen, self.steps, jog.limit, self.seen)

    def look(self, now: float) -> None:
        """Look at what is shown beside, in a while; it is not waited for."""
        if self.peek is not None and self.peek.done():
            wrong = self.peek.exception()
            self.seen = view.shown(None, str(wrong).partition("\n")[0]) if wrong else view.shown(self.peek.result())
            self.peek, self.peeked = None, now
        elif self.peek is None and self.shown is not None and now - self.peeked > PEEKED:
            self.peek = self.bench.thread.submit(self.bench.edge.peek(*self.shown))


def steer(
    session: Session, bench: Bench, jog: Teleoperation, step: float | None, shown: tuple[str, str] | None
) -> None:  # fmt: skip
    """Let somebody steer until it is over; the terminal is then as it was, whatever happens."""
    with Keys() as keys:
        steering = Steering(session, bench, jog, keys, step, shown)
        steering.help()
        try:
            steering.run()
        except BaseException as exc:
            if not isinstance(exc, PicoError) and not jog.over:
                steering.lost()
            raise


def _first(rungs: list[float], wanted: float | None) -> float:
    """Return the step to begin with: the one that was asked for, at most the longest."""
    if wanted is not None:
        return min(wanted, rungs[-1])
    return rungs[max(0, len(rungs) - 1 - _LONGEST_FIRST)]


@contextmanager
def _signals() -> Iterator[list[int]]:
    """While it goes on, yield the signals that came and that would end the process otherwise. SIGINT ends it in order;
    where the terminal is closed, or the process is to end, nobody may look at the arm any more."""
    came: list[int] = []
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
    before = {number: signal.signal(number, lambda n, _: came.append(n)) for number in numbers}
    try:
        yield came
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
