"""What is asked of a coordinator once: its benches, who has them, who one is there."""

from __future__ import annotations

import http.client
import json
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from typing import Any

from pico.diagnostics import PicoError
from pico.edge.network.remotes import Remote
from pico.edge.network.socket import OPENING, context, headers, opening_trouble
from pico.edge.network.trouble import away, refused

ANSWER = 40.0
"""Seconds that a request may wait for a bench, and a little more."""
QUIET = 60.0
"""Seconds in which an answer that goes on may say nothing, before it is asked for again."""
PATIENCE, PAUSE = 30.0, 0.25
"""Seconds in which a coordinator may come back meanwhile, and between two attempts to reach it."""


def ask(
    remote: Remote, method: str, path: str, body: Any = None, *, token: str | None = None, wait: float = OPENING
) -> Any:  # fmt: skip
    """Return what a coordinator answers, as JSON; `token`: instead of the one that is kept. Raises PicoError."""
    try:
        with _opened(remote, method, path, body, token, wait) as answer:
            return json.loads(answer.read())
    except (OSError, ValueError) as exc:
        raise away(remote.url, exc) from exc


def lines(remote: Remote, path: str) -> Iterator[dict[str, Any]]:
    """Yield the JSON lines of an answer that goes on, up to the one that says how that ended (`exit`); asked again for
    those after the last one (`?since=`) where the line was cut meanwhile. Raises PicoError."""
    since, until = 0, time.monotonic() + PATIENCE
    while True:
        try:
            with _opened(remote, "GET", f"{path}?since={since}", None, None, QUIET) as answer:
                for line in answer:
                    document = json.loads(line)
                    yield document
                    if "exit" in document and "schema" not in document:
                        return
                    since, until = since + 1, time.monotonic() + PATIENCE
        except TimeoutError:
            until = time.monotonic() + PATIENCE  # it only said nothing
        except (OSError, ValueError, http.client.HTTPException) as exc:
            if time.monotonic() > until:
                raise away(remote.url, exc) from exc
        except PicoError as exc:
            if exc.diagnostics[0].code != "away" or time.monotonic() > until:
                raise
        time.sleep(PAUSE)


def _opened(remote: Remote, method: str, path: str, body: Any, token: str | None, wait: float) -> Any:
    carried = {"Authorization": f"Bearer {token}"} if token else headers(remote)
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(
        f"{remote.url}/api{path}", data, {**carried, "Content-Type": "application/json"}, method=method
    )
    handlers = [urllib.request.ProxyHandler({}), urllib.request.HTTPSHandler(context=context(remote))]
    try:
        return urllib.request.build_opener(*handlers).open(request, timeout=wait)
    except urllib.error.HTTPError as exc:
        raise refused(exc.code, exc.read(), remote.url) from exc
    except urllib.error.URLError as exc:
        raise opening_trouble(remote.url, exc.reason) from exc
    except (OSError, ValueError) as exc:
        raise away(remote.url, exc) from exc
