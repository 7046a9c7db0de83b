"""The interface of a coordinator as OpenAPI tells it: what the types of the page are made of."""

from __future__ import annotations

import hashlib
import json
from typing import Any

from fastapi import FastAPI


def described(app: FastAPI) -> dict[str, Any]:
    """Return the interface, its paths by name, without what differs from version to version."""
    said = dict(app.openapi())
    return {**said, "paths": dict(sorted(said["paths"].items())), "info": {**said["info"], "version": ""}}


def digest(said: dict[str, Any]) -> str:
    """Return the SHA-256 of an interface."""
    return hashlib.sha256(json.dumps(said, sort_keys=True, separators=(",", ":")).encode()).hexdigest()
