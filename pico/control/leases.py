"""Who has a bench, as the coordinator keeps it: one row a bench, and what becomes of it, without clock or chance.

A request takes a number, the token, which only counts up. The edge beside the table drains and keeps that number for
good (it fences) before the holder hears of the lease, so that whatever an earlier holder says comes too late. Times are
seconds by the clock of the coordinator's database; who calls these functions writes row and audit in one transaction,
and sends what is to be said after it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

TTL = 10.0
"""How long a lease goes on after it was granted or renewed [s]."""
HEARTBEAT = 2.0
"""How often who has it renews it [s]."""

Deed = Literal["granted", "stolen", "released", "lapsed"]
Told = Literal["granted", "waiting", "lost"]


@dataclass(frozen=True, slots=True)
class Asker:
    """Who asks: a session of a client, and the principal that it acts for."""

    session: str
    who: str


@dataclass(frozen=True, slots=True)
class Grant:
    """A lease: until when, and whether the edge has fenced for it. `job`: the run that the coordinator renews it for,
    once its client is gone."""

    token: int
    holder: Asker
    expires: float
    fenced: bool = False
    job: str = ""


@dataclass(frozen=True, slots=True)
class Lease:
    """The row of a bench. `token`: the highest number that was ever given or heard of; `queue`: who waits, in order."""

    bench: str
    token: int = 0
    grant: Grant | None = None
    queue: tuple[Asker, ...] = ()


@dataclass(frozen=True, slots=True)
class Audit:
    """What is written of a deed, once: who did it, in which session and with which token, to whom and why. A number
    that a restored database gives once more is told from the first by its session."""

    deed: Deed
    bench: str
    token: int
    session: str
    who: str
    of: str = ""
    why: str = ""


@dataclass(frozen=True, slots=True)
class Said:
    """What a session is told of the lease: granted with its token, that it waits (and how many before it), or lost."""

    session: str
    what: Told
    token: int = 0
    ahead: int = 0
    why: str = ""


@dataclass(frozen=True, slots=True)
class Turn:
    """A row afterwards, what is written of that, and who is to be told what."""

    row: Lease
    audit: tuple[Audit, ...] = ()
    said: tuple[Said, ...] = ()

    def then(self, change: Callable[[Lease], Turn]) -> Turn:
        """Return this turn and the next one as one."""
        more = change(self.row)
        return Turn(more.row, self.audit + more.audit, self.said + more.said)


def asked(row: Lease, asker: Asker, now: float, met: bool) -> Turn:
    """Ask for the lease: granted where it is free, else the asker waits; who has it already hears so again.

    `met`: whether the edge has said what it last fenced for since this coordinator began; before that no number is
    given, for a database that was restored from a backup does not know how far they went.
    """
    if row.grant and row.grant.holder == asker and now <= row.grant.expires:
        if row.grant.fenced:
            return Turn(row, said=_granted(row.grant))
        return Turn(replace(row, grant=replace(row.grant, expires=now + TTL)), said=(Said(asker.session, "waiting"),))
    if asker not in row.queue:
        row = replace(row, queue=(*row.queue, asker))
    turn = Turn(row).then(lambda r: lapsed(r, now)).then(lambda r: _promoted(r, now, met))
    if asker not in turn.row.queue:
        return turn
    return replace(turn, said=(*turn.said, Said(asker.session, "waiting", ahead=turn.row.queue.index(asker))))


def renewed(row: Lease, session: str, token: int, now: float, met: bool) -> Turn:
    """Renew a lease for another TTL; who has it no longer is told so."""
    turn = Turn(row).then(lambda r: lapsed(r, now)).then(lambda r: _promoted(r, now, met))
    grant = turn.row.grant
    if grant is None or grant.token != token or grant.holder.session != session:
        return replace(turn, said=(*turn.said, Said(session, "lost", token)))
    kept = replace(turn.row, grant=replace(grant, expires=now + TTL))
    return replace(turn, row=kept, said=(*turn.said, *(_granted(grant) if grant.fenced else ())))


def kept(row: Lease, job: str, now: float) -> Turn:
    """Renew the lease of a detached run, as long as it goes on."""
    if row.grant is None or not job or row.grant.job != job:
        return Turn(row)
    return Turn(replace(row, grant=replace(row.grant, expires=now + TTL)))


def detached(row: Lease, session: str, token: int, job: str) -> Turn:
    """Let the coordinator renew a lease for a run from now on; all its commands must be there (`Commands.whole`)."""
    grant = row.grant
    if grant is None or grant.token != token or grant.holder.session != session:
        return Turn(row, said=(Said(session, "lost", token),))
    return Turn(replace(row, grant=replace(grant, job=job)))


def released(row: Lease, session: str, token: int, now: float, met: bool) -> Turn:
    """Give the lease back, or up waiting for it; the next one gets it."""
    grant = row.grant
    row = replace(row, queue=tuple(a for a in row.queue if a.session != session))
    if grant is None or grant.token != token or grant.holder.session != session:
        return Turn(row)
    audit = _audit("released", row.bench, grant)
    return Turn(replace(row, grant=None), (audit,)).then(lambda r: _promoted(r, now, met))


def stolen(row: Lease, asker: Asker, why: str, now: float, met: bool) -> Turn:
    """Take the lease from whoever has it; raises ValueError without a reason. Who had it is told who took it and why.
    Whether the asker may is the caller's business."""
    if not why.strip():
        raise ValueError("a lease is taken over with a reason: it is told to who had it")
    grant = row.grant
    if grant and grant.holder == asker:
        return asked(row, asker, now, met)
    if not met:
        return Turn(row, said=(Said(asker.session, "waiting", ahead=len(row.queue), why="the edge is away"),))
    row = replace(row, queue=tuple(a for a in row.queue if a != asker))
    turn = _given(row, asker, now)
    taken = replace(turn.audit[0], deed="stolen", of=grant.holder.who if grant else "", why=why)
    victim = (Said(grant.holder.session, "lost", grant.token, why=f"{asker.who}: {why}"),) if grant else ()
    return replace(turn, audit=(taken,), said=victim)


def heard(row: Lease, fenced: int, now: float) -> Turn:
    """Hear from the edge which token it has fenced for. A higher one than any known is known from then on, and whatever
    was granted below it was so by a database that lagged behind: it is lost."""
    grant = row.grant
    if grant and grant.token < fenced:
        why = "the edge serves a later lease"
        audit = _audit("lapsed", row.bench, grant, why=why)
        lost = Said(grant.holder.session, "lost", grant.token, why=why)
        return Turn(replace(row, token=max(row.token, fenced), grant=None), (audit,), (lost,))
    row = replace(row, token=max(row.token, fenced))
    if grant is None or grant.token != fenced or grant.fenced:
        return Turn(row)
    active = replace(grant, fenced=True, expires=now + TTL)
    return Turn(replace(row, grant=active), (), _granted(active))


def lapsed(row: Lease, now: float) -> Turn:
    """End a lease that nobody renewed."""
    grant = row.grant
    if grant is None or now <= grant.expires:
        return Turn(row)
    audit = _audit("lapsed", row.bench, grant)
    lost = Said(grant.holder.session, "lost", grant.token, why=f"it was not renewed for {TTL:g} s")
    return Turn(replace(row, grant=None), (audit,), (lost,))


def promoted(row: Lease, now: float, met: bool) -> Turn:
    """End what has lapsed, and give a free bench to the first who waits."""
    return Turn(row).then(lambda r: lapsed(r, now)).then(lambda r: _promoted(r, now, met))


def left(row: Lease, now: float) -> tuple[int, float]:
    """Return what the edge is told when it asks: for which token it shall fence, and how long that holds still [s]; 0
    where nobody has the bench."""
    return (row.grant.token, max(0.0, row.grant.expires - now)) if row.grant else (row.token, 0.0)


def _promoted(row: Lease, now: float, met: bool) -> Turn:
    if row.grant or not row.queue or not met:
        return Turn(row)
    first, *others = row.queue
    return _given(replace(row, queue=tuple(others)), first, now)


def _given(row: Lease, asker: Asker, now: float) -> Turn:
    token = row.token + 1
    grant = Grant(token, asker, now + TTL)
    return Turn(replace(row, token=token, grant=grant), (_audit("granted", row.bench, grant),))


def _audit(deed: Deed, bench: str, grant: Grant, why: str = "") -> Audit:
    return Audit(deed, bench, grant.token, grant.holder.session, grant.holder.who, why=why)


def _granted(grant: Grant) -> tuple[Said, ...]:
    return (Said(grant.holder.session, "granted", grant.token),)
