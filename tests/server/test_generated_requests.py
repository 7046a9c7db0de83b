"""Requests that OpenAPI allows and some that it does not, of every route: none makes the coordinator fail."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
import schemathesis
from coordinators import BENCH, Served, served
from hypothesis import HealthCheck, given, settings
from hypothesis.errors import Unsatisfiable
from schemathesis.generation import GenerationMode

from pico.server.access.principal import ROLES
from pico.server.live import watching
from pico.server.relay import dispatch

EXAMPLES = 60
"""Requests of each route, half of them not as OpenAPI wants them."""


@pytest.fixture(scope="module")
def coordinator(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with served(tmp_path_factory.mktemp("coordinator")) as found:
        yield found


@pytest.mark.slow
def test_no_request_makes_the_coordinator_fail(coordinator: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("AWAY", "LASTING_AWAY", "FENCES", "HEARTBEAT"):  # there is no edge, nor will there be one
        monkeypatch.setattr(dispatch, name, 0.02)
    monkeypatch.setattr(watching, "AWAY", 0.02)
    coordinator.bench(BENCH)
    coordinator.loosen()
    root = coordinator.person("root", *ROLES)
    schema = schemathesis.openapi.from_url(f"http://127.0.0.1:{coordinator.port}/api/openapi.json")
    statuses: dict[str, set[int]] = {}
    for operation in [found.ok() for found in schema.get_all_operations()]:
        for mode in (GenerationMode.POSITIVE, GenerationMode.NEGATIVE):
            try:
                ask(operation, mode, root, statuses.setdefault(operation.label, set()))
            except Unsatisfiable:  # a route without anything that could be wrong
                assert mode is GenerationMode.NEGATIVE
    assert len(statuses) > 15 and {200, 422} <= set().union(*statuses.values())


def ask(operation: Any, mode: GenerationMode, token: str, statuses: set[int]) -> None:
    """Ask for an operation in many ways; what is answered is added to `statuses`."""

    @given(case=operation.as_strategy(generation_mode=mode))
    @settings(
        max_examples=EXAMPLES // (12 if "/calls/" in operation.label or "/desk/" in operation.label else 2),
        deadline=None,
        suppress_health_check=list(HealthCheck),
        database=None,
    )
    def asked(case: schemathesis.Case) -> None:
        if case.path_parameters and "lab" in case.path_parameters and len(str(case.path_parameters["lab"])) % 2:
            case.path_parameters |= dict(zip(("lab", "bench"), BENCH.split("/"), strict=True))
        if isinstance(case.body, dict) and isinstance(case.body.get("wait"), int | float):
            case.body["wait"] = min(case.body["wait"], 0)  # nobody will give the bench back
        answer = case.call(headers={"authorization": f"Bearer {token}"})
        statuses.add(answer.status_code)
        away = answer.status_code == 503 and answer.json()["error"][0]["code"] == "away"
        assert answer.status_code < 500 or away, (operation.label, answer.status_code, answer.content[:500])

    asked()
