"""Tokens, people and codes of a coordinator."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pico.base import clock

from .style import columns, paint

Row = Mapping[str, Any]


def text(
    *, tokens: Sequence[Row] | None = None, people: Sequence[Row] | None = None, made: Row | None = None,
    enrolment: Row | None = None, audit: Row | None = None, url: str = "",
) -> str:  # fmt: skip
    """Return what was asked for: a list, or what was made, with what to do with it."""
    if tokens is not None:
        return "\n".join(columns([_token(row) for row in tokens])) or "There are no tokens."
    if people is not None:
        return "\n".join(columns([_person(row) for row in people]))
    if audit is not None:
        return "\n".join([*columns([_entry(row) for row in audit["entries"]]), _intact(audit)])
    if enrolment is not None:
        line = f"pico edge enrol {url} --code {enrolment['code']}"
        return f"In the lab's folder beside the table, until {_when(enrolment['expires_at'])}:\n  {line}"
    assert made is not None
    if str(made["secret"]).startswith("pico_code_"):
        line = f"pico login {url} --code {made['secret']}"
        return f"Good for one login, until {_when(made['expires_at'])}:\n  {line}"
    last = f"It lasts until {_when(made['expires_at'])} and is shown once; `pico token revoke {made['id']}` ends it."
    return f"{made['secret']}\n{last}"


def _token(row: Row) -> list[str]:
    scope = "all that they may" if row["scope"] is None else ", ".join(row["scope"]) or "nothing"
    kind = "to log in" if row["kind"] == "code" else ""
    label = paint("dim", " ".join(filter(None, (kind, row["label"]))))
    return [row["id"], row["principal"], f"until {_when(row['expires_at'])}", scope, label]


def _person(row: Row) -> list[str]:
    rights = "may nothing any more" if row["disabled"] else ", ".join(row["rights"]) or "no role yet"
    return [row["name"], rights.replace("@*", "")]


def _entry(row: Row) -> list[str]:
    what = " ".join(filter(None, (row["deed"], row["bench"], row["of"])))
    return [str(row["number"]), _when(row["at"]), row["who"], what, paint("dim", row["why"])]


def _intact(audit: Row) -> str:
    if audit["broken"] is None:
        return "Every entry is as it was written."
    return f"From entry {audit['broken']} on they are not as they were written, or are missing."


def _when(seconds: float) -> str:
    return f"{clock.from_epoch(seconds).astimezone():%Y-%m-%d %H:%M}"


def data(
    *, tokens: Sequence[Row] | None = None, people: Sequence[Row] | None = None, made: Row | None = None,
    enrolment: Row | None = None, audit: Row | None = None, url: str = "",
) -> dict[str, Any]:  # fmt: skip
    """Return schema `pico.token/v1`: one of `tokens`, `people`, `made` (`id`, `secret`, `expires_at`), `enrolment`
    (`code`, `expires_at`) and `audit` (`entries`, the first that is `broken`); what is made with its `url`."""
    found: dict[str, Any] = {
        "tokens": tokens, "people": people, "made": made, "enrolment": enrolment, "audit": audit,
    }  # fmt: skip
    told = {key: value for key, value in found.items() if value is not None}
    return {"schema": "pico.token/v1", **told} | ({"url": url} if url else {})
