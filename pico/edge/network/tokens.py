"""What a user is known by to coordinators: a token each, in a file that only that user may read; and by what the user
knows those that signed their certificate themselves.

`PICO_TOKEN` comes before it, for what runs by itself. No token lies in a checkout: a commit could carry it.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

from pico.diagnostics import PicoError, error
from pico.disk import write_whole

VARIABLE = "PICO_TOKEN"


def token_of(url: str) -> str | None:
    """Return the token for the coordinator at `url`, None where there is none; raises PicoError where the file can't be
    read, or others may read it."""
    given = os.environ.get(VARIABLE, "").strip()
    if not all("!" <= letter <= "~" for letter in given):
        raise PicoError(error("token", f"{VARIABLE} holds no token", hint="one word, as `pico token add` shows it"))
    return given or _read().get(url.rstrip("/"))


def keep_token(url: str, token: str) -> None:
    """Keep a token for the coordinator at `url`, for this user alone; raises PicoError."""
    _write({**_read(), url.rstrip("/"): token})


def forget_token(url: str) -> None:
    """Keep no token for the coordinator at `url` any more; raises PicoError."""
    _write({where: token for where, token in _read().items() if where != url.rstrip("/")})


def keep_certificate(url: str, certificate: str) -> None:
    """Keep the certificate (PEM) of the coordinator at `url`, which no authority signed; raises PicoError."""
    kept = {**_certificates(), url.rstrip("/"): certificate}
    write_whole(_certificates_file(), (json.dumps(kept, indent=1) + "\n").encode(), folders=True)


def certificate_of(url: str) -> str:
    """Return the certificate (PEM) that was kept of the coordinator at `url`; empty where there is none."""
    return _certificates().get(url.rstrip("/"), "")


def places() -> tuple[str, ...]:
    """Return the addresses of the coordinators that there are tokens for; raises PicoError."""
    return tuple(_read())


def tokens_file() -> Path:
    """Return where the tokens of this user are."""
    base = os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config"
    return Path(base) / "pico" / "tokens.json"


def _certificates_file() -> Path:
    return tokens_file().with_name("certificates.json")


def _certificates() -> dict[str, str]:
    path = _certificates_file()
    try:
        return {str(url): str(text) for url, text in json.loads(path.read_bytes()).items()}
    except FileNotFoundError:
        return {}
    except (OSError, ValueError, AttributeError) as exc:
        hint = "delete it, then `pico login URL --certificate FILE`"
        raise PicoError(error("certificate", f"{path} can't be read: {exc}", hint=hint)) from exc


def _read() -> dict[str, str]:
    path = tokens_file()
    try:
        if path.stat().st_mode & 0o077:
            raise PicoError(error("token", f"others may read {path}", hint=f"`chmod 600 {path}`, and get new tokens"))
        return {str(url): str(token) for url, token in json.loads(path.read_bytes()).items()}
    except FileNotFoundError:
        return {}
    except (OSError, ValueError, AttributeError) as exc:
        raise PicoError(
            error("token", f"{path} can't be read: {exc}", hint="delete it, then `pico login URL`")
        ) from exc


def _write(tokens: dict[str, str]) -> None:
    path, mask = tokens_file(), os.umask(0o077)
    try:
        write_whole(path, (json.dumps(tokens, indent=1) + "\n").encode(), folders=True)
        path.chmod(0o600)
    finally:
        os.umask(mask)
