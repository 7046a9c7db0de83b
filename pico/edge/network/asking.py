"""What is asked of a coordinator once: its benches, who has them, who one is there."""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from typing import Any

from pico.edge.network.remotes import Remote
from pico.edge.network.socket import OPENING, context, headers, opening_trouble
from pico.edge.network.trouble import away, refused

ANSWER = 40.0
"""Seconds that a request may wait for a bench, and a little more."""


def ask(
    remote: Remote, method: str, path: str, body: Any = None, *, token: str | None = None, wait: float = OPENING
) -> Any:  # fmt: skip
    """Return what a coordinator answers, as JSON; `token`: instead of the one that is kept. Raises PicoError."""
    carried = {"Authorization": f"Bearer {token}"} if token else headers(remote)
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(
        f"{remote.url}/api{path}", data, {**carried, "Content-Type": "application/json"}, method=method
    )
    handlers = [urllib.request.ProxyHandler({}), urllib.request.HTTPSHandler(context=context(remote))]
    try:
        with urllib.request.build_opener(*handlers).open(request, timeout=wait) as answer:
            return json.loads(answer.read())
    except urllib.error.HTTPError as exc:
        raise refused(exc.code, exc.read(), remote.url) from exc
    except urllib.error.URLError as exc:
        raise opening_trouble(remote.url, exc.reason) from exc
    except (OSError, ValueError) as exc:
        raise away(remote.url, exc) from exc
