from __future__ import annotations

from collections.abc import Iterator

import pytest
from coordinators import Served, served


@pytest.fixture
def coordinator(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with served(tmp_path_factory.mktemp("coordinator")) as found:
        yield found
