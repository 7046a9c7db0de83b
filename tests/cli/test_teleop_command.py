"""`pico teleop`: keys as terminals write them, a terminal that is left as it was, and nobody at the keys."""

from __future__ import annotations

import os
import pty
import select
import sys
import termios
import time
from pathlib import Path

import pytest
from commanding import Pico
from pico_cli.terminal.keys import Key, decoded


@pytest.mark.parametrize(
    ("data", "keys"),
    [
        (b"\x1b[C", [Key("press", "right")]),
        (b"\x1bOA", [Key("press", "up")]),
        (b"\x1b[1;1:1C\x1b[1;1:2C\x1b[1;1:3C", [Key(k, "right") for k in ("press", "repeat", "release")]),  # type: ignore[arg-type]
        (b"\x1b[5~\x1b[6;1:3~", [Key("press", "pgup"), Key("release", "pgdn")]),
        (b"\x1b[113;1:1u\x1b[113;1:3u", [Key("press", "q"), Key("release", "q")]),
        (b"\x1b[61:43;2u", [Key("press", "+")]),  # shift and =
        (b"\x1b[99;5u", [Key("press", "ctrl-c")]),
        (b"\x1b[27u", [Key("press", "esc")]),
        (b"\x1b[57441;2u", []),  # shift alone
        (b"\x1b[0n\x1b[O\x1b[I", [Key("alive"), Key("unfocused")]),
        (b"\x1b[?62;4c\x1b[?0u", []),
        (b"+q\x03\t", [Key("press", name) for name in ("+", "q", "ctrl-c", "tab")]),
        (b"\xff\x00", []),
    ],
)
def test_keys_as_terminals_write_them(data: bytes, keys: list[Key]) -> None:
    assert decoded(data, stale=False) == (keys, b"")
    one_by_one, left = list[Key](), b""
    for byte in data:
        found, left = decoded(left + bytes([byte]), stale=False)
        one_by_one += found
    assert (one_by_one, left) == (keys, b"")


def test_an_escape_is_a_key_once_nothing_follows_it() -> None:
    assert decoded(b"\x1b", stale=False) == ([], b"\x1b")
    assert decoded(b"\x1b", stale=True) == ([Key("press", "esc")], b"")


def test_without_a_terminal_nobody_steers(shel: Path, pico: Pico) -> None:
    answer = pico("teleop", "p2")
    assert answer.code == 1
    assert "nobody can press a key here" in answer.err and "bench.teleop" in answer.err


def in_a_terminal(words: tuple[str, ...], typed: list[tuple[bytes, bytes]]) -> tuple[int, bytes, bool]:
    """Run a command in a terminal that knows no more than the oldest do, and type once something is shown; return the
    exit code, what was shown, and whether the terminal was left as it had been."""
    child, link = pty.fork()
    if child == 0:
        code = 1
        try:
            from pico_cli.main import main

            sys.stdin, sys.stdout, sys.stderr = os.fdopen(0, "r"), os.fdopen(1, "w"), os.fdopen(2, "w")
            before = termios.tcgetattr(0)
            code = main([*words])
            os.write(1, b"[as it was]" if termios.tcgetattr(0) == before else b"[changed]")
        finally:
            os._exit(code)
    shown, until = b"", time.monotonic() + 60
    while time.monotonic() < until:
        if typed and typed[0][0] in shown:
            os.write(link, typed.pop(0)[1])
        if not select.select([link], [], [], 0.02)[0]:
            continue
        try:
            data = os.read(link, 65536)
        except OSError:
            break
        if not data:
            break
        shown += data
        if b"\x1b[c" in data:
            os.write(link, b"\x1b[?6c")
        for _ in range(data.count(b"\x1b[5n")):
            os.write(link, b"\x1b[0n")
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    os.close(link)
    return code, shown, b"[as it was]" in shown


def test_a_press_is_one_step_where_releases_are_not_told(shel: Path) -> None:
    typed = [(b"| step 2 deg", b"\x1b[C"), (b"angle 2 deg", b"-\x1b[C"), (b"angle 3 deg", b"q")]
    code, shown, as_it_was = in_a_terminal(("teleop", "p2.angle", "--step", "2 deg"), typed)
    assert (code, as_it_was) == (0, True)
    assert b"this terminal reports no releases" in shown
    assert b"2 steps" in shown and b"pico undo" in shown and not typed


def test_a_mistake_leaves_the_terminal_as_it_was(shel: Path) -> None:
    code, shown, as_it_was = in_a_terminal(("teleop", "p2.angle", "--step", "2 kg"), [])
    assert (code, as_it_was) == (1, True) and b"--step" in shown
    code, shown, as_it_was = in_a_terminal(("teleop", "p2.angle", "--show", "cam.centroidd"), [])
    assert (code, as_it_was) == (1, True) and b"did you mean" in shown
