"""Who asks, and what they may: roles by lab.

Roles build up, viewer to operator to admin; those to arm lasers, to take a bench over and to teleoperate are given by
themselves.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from pico.control.leases import Asker
from pico.diagnostics import ExitCode, PicoError, did_you_mean, error

ROLES = ("viewer", "operator", "admin", "laser:enable", "lease:steal", "teleop")
_HOLDS = {"admin": ("admin",), "operator": ("operator", "admin"), "viewer": ("viewer", "operator", "admin")}
"""Who has one of these has the role as well."""
_NAME = re.compile(r"[a-z0-9](?:[a-z0-9._-]{0,62}[a-z0-9])?")
_SESSION = re.compile(r"[A-Za-z0-9._-]{1,100}")


@dataclass(frozen=True, slots=True, order=True)
class Right:
    """A role in a lab, `*` for all labs."""

    lab: str
    role: str

    def __str__(self) -> str:
        return f"{self.role}@{self.lab}"


@dataclass(frozen=True, slots=True)
class Principal:
    """Whom a token let in, and what they may with it until it is over [s since 1970]."""

    name: str
    rights: frozenset[Right]
    token: str
    expires_at: float

    def may(self, role: str, lab: str) -> bool:
        """Whether this principal has a role in a lab. `*` asks for it in all labs."""
        held = _HOLDS.get(role, (role,))
        return any(Right(where, word) in self.rights for where in {lab, "*"} for word in held)

    def sees(self, lab: str) -> bool:
        """Whether this principal has any role in a lab."""
        return any(right.lab in (lab, "*") for right in self.rights)

    def require(self, role: str, lab: str) -> None:
        """Raise PicoError (exit code DENIED) where this principal has not a role in a lab. `any` is whatever role in
        it, `known` asks for none."""
        if role == "known" or (self.sees(lab) if role == "any" else self.may(role, lab)):
            return
        where = "in all labs" if lab == "*" else f"in the lab {lab}"
        what = "no role" if role == "any" else f"not the role {role}"
        hint = "an admin gives it: `pico token role`; `pico token list` shows what you have"
        raise PicoError(error("forbidden", f"{self.name} has {what} {where}", hint=hint), ExitCode.DENIED)

    def asker(self, session: str) -> Asker:
        """Return a session of this principal, whose name is part of it: nobody speaks for somebody else's. Raises
        PicoError for what is none."""
        if not _SESSION.fullmatch(session):
            raise PicoError(error("usage", "a session is named by up to 100 letters, digits, `.`, `_` and `-`"))
        return Asker(f"{self.name}/{session}", self.name)


def unauthenticated() -> PicoError:
    """Return what somebody is told who does not say who they are, or says it with what is no token (any more)."""
    hint = "log in with `pico login URL --code CODE`; an admin makes codes by `pico token invite`"
    return PicoError(error("unauthenticated", "no token, or one that is over, revoked or unknown here", hint=hint))


def require_name(name: str, what: str) -> str:
    """Return a name; raises PicoError where it is none that `what` may have."""
    if not _NAME.fullmatch(name):
        hint = "small letters, digits, `.`, `_` and `-`, up to 64, a letter or digit first and last"
        raise PicoError(error("usage", f"{what} can't be called {name[:80]!r}", hint=hint))
    return name


def right(text: str) -> Right:
    """Return a right from `role@lab`, of all labs without `@`; raises PicoError for what is none."""
    role, _, lab = text.partition("@")
    if role not in ROLES:
        raise PicoError(error("usage", f"there is no role {role[:40]!r}", hint=did_you_mean(role, ROLES)))
    return Right(lab if lab in ("", "*") else require_name(lab, "a lab"), role) if lab else Right("*", role)
