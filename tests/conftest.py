"""Properties draw the same examples in every CI run, and new ones on a developer's machine. The command line in
process: `pico("plan", "e1")` gives exit code, output and errors."""

import os

os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # a process that a test starts does not compile everything anew

import pytest
from commanding import Answer, Pico
from hypothesis import settings

settings.register_profile("ci", derandomize=True)
if os.environ.get("CI"):
    settings.load_profile("ci")


@pytest.fixture
def pico(capsys: pytest.CaptureFixture[str]) -> Pico:
    from pico_cli.main import main

    def call(*words: str) -> Answer:
        capsys.readouterr()
        code = main(words)
        captured = capsys.readouterr()
        return Answer(int(code), captured.out, captured.err)

    return call
