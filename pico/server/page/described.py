"""The interface of a coordinator as OpenAPI tells it: what the types of the page are made of."""

from __future__ import annotations

import hashlib
import json
from typing import Any

from fastapi import FastAPI


def described(app: FastAPI) -> dict[str, Any]:
    """Return the interface without what is another one in each version."""
    said = dict(app.openapi())
    return {**said, "info": {**said["info"], "version": ""}}


def digest(said: dict[str, Any]) -> str:
    """Return the SHA-256 of an interface."""
    return hashlib.sha256(json.dumps(said, sort_keys=True, separators=(",", ":")).encode()).hexdigest()
