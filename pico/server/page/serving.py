"""The files of the page, told to anybody: they say nothing of any lab.

They are read once. What a browser may do with them says the policy beside them: nothing leaves this host, nothing else
may show the page in a frame, and no text of a lab can become a script.
"""

from __future__ import annotations

import mimetypes
from collections.abc import Awaitable, Callable
from pathlib import Path

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from pico.diagnostics import PicoError, error
from pico.resources import page_dir

POLICY = "; ".join((
    "default-src 'none'", "script-src 'self'", "style-src 'self'", "img-src 'self' blob: data:", "connect-src 'self'",
    "font-src 'self'", "base-uri 'none'", "form-action 'none'", "frame-ancestors 'none'",
))  # fmt: skip
_FOREVER = "public, max-age=31536000, immutable"
"""For files whose names tell their content."""


def page() -> list[Route]:
    """Return what serves the page; where none was built, its address says so."""
    files = _files(page_dir())
    return [
        Route("/" if name == "index.html" else f"/{name}", _answer(name, files.get(name)), methods=["GET"])
        for name in files or ("index.html",)
    ]


def _files(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()
    }


def _answer(name: str, data: bytes | None) -> Callable[[Request], Awaitable[Response]]:
    kind = mimetypes.guess_type(name)[0] or "text/plain"
    kind = "text/javascript" if name.endswith(".js") else kind
    headers = {
        "content-security-policy": POLICY, "cross-origin-opener-policy": "same-origin",
        "cache-control": _FOREVER if name.startswith("assets/") else "no-cache",
    }  # fmt: skip

    async def answer(_: Request) -> Response:
        if data is None:
            raise PicoError(error("no-page", "the page was not built", hint="`make ui` builds it; it needs Node"))
        return Response(data, headers=headers, media_type=kind)

    return answer
