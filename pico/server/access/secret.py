"""The secrets that prove who somebody is: 256 random bits. What is kept is their SHA-256, which tells nobody what they
were."""

from __future__ import annotations

import base64
import hashlib
import secrets

LONGEST = 366 * 86400.0
"""The longest that a token lasts [s]."""
SESSION_LASTS = 7 * 86400.0
"""The longest that a browser is let in without its token being shown again [s]."""
CODE_LASTS = 2 * 86400.0
"""The longest in which a code is to be exchanged for a token [s]."""


SAFELY = 60.0
"""How long the token of a run at a desk lasts beyond the one that it was made with [s]: what moves comes to its safe
end."""


def fingerprint(secret: str) -> bytes:
    """Return what is kept of a secret."""
    return hashlib.sha256(secret.encode("utf-8", "surrogatepass")).digest()


def new_secret(kind: str) -> str:
    """Return a secret of 256 bits that tells what it is for."""
    return f"pico_{kind}_{secrets.token_urlsafe(32)}"


def bearer(header: str | None) -> str:
    """Return the token of an Authorization header, empty where there is none; of git it is the password."""
    scheme, _, token = (header or "").partition(" ")
    if scheme.lower() == "basic":
        try:
            return base64.b64decode(token.strip(), validate=True).decode().partition(":")[2]
        except ValueError:
            return ""
    return token.strip() if scheme.lower() == "bearer" else ""
