"""What a recipe asks at a terminal is asked again until it is answered; a command that nobody follows asks nobody."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any, cast

import pytest
from pico_cli.runs import asking
from pico_cli.session import Session

from pico.diagnostics import Diagnostic, PicoError
from pico.model.trace.question import Answer, Question

POWER = Question("1", "Read the meter.", "number", "power", "mW", default=3.0, low=0.0, high=5.0)


def said(words: Iterator[str], told: list[Diagnostic]) -> Any:
    def read() -> str:
        try:
            return next(words)
        except StopIteration as exc:
            raise EOFError from exc

    return SimpleNamespace(report=told.extend), read


def test_a_wrong_answer_is_told_and_asked_again(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    told: list[Diagnostic] = []
    session, read = said(iter(["6", "400 uW", ""]), told)
    monkeypatch.setattr("builtins.input", read)
    terminal = asking.Terminal(cast(Session, session))
    assert terminal.ask(POWER) == Answer(pytest.approx(0.4)) and terminal.ask(POWER) == Answer(3.0)
    assert [one.summary for one in told] == ["power is out of range: 6 mW, and it may be 0 to 5 mW"]
    assert capsys.readouterr().out.startswith("Read the meter. [a number in mW from 0 to 5; without a word 3] ")
    with pytest.raises(PicoError, match="nothing was answered"):
        terminal.ask(POWER)


def test_without_a_terminal_only_a_desk_asks(monkeypatch: pytest.MonkeyPatch) -> None:
    for folder, json, found in (("", True, False), ("/there", True, True), ("/there", False, False)):
        monkeypatch.setenv(asking.FOLDER, folder)
        session = cast(Session, SimpleNamespace(json=json))
        assert (asking.asker(session) is not None) is found and not asking.attended(session)
    monkeypatch.setenv(asking.ATTENDED, "yes")
    assert asking.attended(cast(Session, SimpleNamespace(json=True)))
    assert not asking.attended(cast(Session, SimpleNamespace(json=False)))
