"""A plug-in of pytest that lists the tests and the files that cost most processor time: `make slowest`.

Processor time of the process of the tests and of the processes that it waited for; unlike the time of the clock it
hardly depends on what else the machine does.
"""

from __future__ import annotations

import resource
from collections import Counter
from collections.abc import Generator

import pytest

MOST = 30
"""How many tests and files are listed."""
PROPERTY = "processor seconds"


def spent() -> float:
    """Return the processor time so far, in seconds."""
    uses = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(use.ru_utime + use.ru_stime for use in uses)


class Slowest:
    def __init__(self) -> None:
        self.started = 0.0
        self.seconds: dict[str, float] = {}

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self) -> Generator[None, object, object]:
        self.started = spent()
        return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, call: pytest.CallInfo[None]
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        report = yield
        if call.when == "teardown":
            report.user_properties.append((PROPERTY, spent() - self.started))
        return report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "teardown":
            self.seconds[report.nodeid] = float(dict(report.user_properties).get(PROPERTY, 0.0))

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        files: Counter[str] = Counter()
        for name, seconds in self.seconds.items():
            files[name.partition("::")[0]] += seconds  # type: ignore[assignment]
        terminalreporter.section(f"processor time: {sum(self.seconds.values()):.0f} s in {len(self.seconds)} tests")
        for what, found in (("tests", Counter(self.seconds)), ("files", files)):
            terminalreporter.write_line(f"the {MOST} {what} that cost most, in seconds:")
            for name, seconds in found.most_common(MOST):
                terminalreporter.write_line(f"  {seconds:6.1f}  {name}")


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(Slowest())
