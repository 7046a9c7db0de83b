"""The tables. Times are seconds since 1970 by the database's clock."""

from __future__ import annotations

from sqlalchemy import (
    Boolean,
    CheckConstraint,
    Column,
    Float,
    ForeignKey,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
    UniqueConstraint,
)  # fmt: skip

metadata = MetaData()

heads = Table(
    "heads", metadata,
    Column("name", String(16), primary_key=True),
    Column("number", Integer, nullable=False),
    Column("hash", String(64), nullable=False),
)  # fmt: skip
"""The last number of each ordered list (`audit`, `events`), locked by who adds to it: their numbers have no gap, and
nobody sees a later one before an earlier one."""

benches = Table(
    "benches", metadata,
    Column("bench", String(129), primary_key=True),
    Column("enrolled_at", Float, nullable=False),
    Column("met", Boolean, nullable=False, default=False),
    Column("token", Integer, nullable=False, default=0),
    Column("granted", Integer),
    Column("session", String(200)),
    Column("who", String(64)),
    Column("expires", Float),
    Column("since", Float),
    Column("fenced", Boolean, nullable=False, default=False),
    Column("job", String(200), nullable=False, default=""),
    CheckConstraint("granted IS NULL OR granted <= token"),
)  # fmt: skip
"""A bench (`lab/name`) and who has it. `met`: its edge has said what it fenced for since the coordinator began."""

waiting = Table(
    "waiting", metadata,
    Column("number", Integer, primary_key=True, autoincrement=True),
    Column("bench", ForeignKey("benches.bench"), nullable=False),
    Column("session", String(200), nullable=False),
    Column("who", String(64), nullable=False),
    UniqueConstraint("bench", "session", "who"),
)  # fmt: skip
"""Who waits for a bench, in the order of the numbers."""

commands = Table(
    "commands", metadata,
    Column("bench", ForeignKey("benches.bench"), primary_key=True),
    Column("key", String(300), primary_key=True),
    Column("token", Integer, nullable=False),
    Column("seq", Integer, nullable=False),
    Column("digest", String(80), nullable=False),
    Column("state", String(10), nullable=False),
    Column("result", Text, nullable=False, default=""),
    Column("by", String(64), nullable=False, default=""),
    Column("call", Text, nullable=False, default=""),
    Column("asked_at", Float, nullable=False),
    UniqueConstraint("bench", "token", "seq"),
)  # fmt: skip
"""What was asked of a bench under a lease, written before it is sent. `call`: what is sent, as JSON."""

runs = Table(
    "runs", metadata,
    Column("bench", ForeignKey("benches.bench"), primary_key=True),
    Column("run", String(200), primary_key=True),
    Column("kind", String(40), nullable=False),
    Column("who", String(64), nullable=False),
    Column("session", String(200), nullable=False),
    Column("began_at", Float, nullable=False),
    Column("ended_at", Float),
    Column("outcome", String(40)),
)  # fmt: skip
"""The runs that went through this coordinator; what they did is in the journal of their edge."""

audit = Table(
    "audit", metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("at", Float, nullable=False),
    Column("deed", String(40), nullable=False),
    Column("who", String(64), nullable=False),
    Column("bench", String(129), nullable=False, default=""),
    Column("token", Integer, nullable=False, default=0),
    Column("session", String(200), nullable=False, default=""),
    Column("of", String(300), nullable=False, default=""),
    Column("why", Text, nullable=False, default=""),
    Column("hash", String(64), nullable=False),
)  # fmt: skip
"""Who did what, only ever added to: each hash is of the row and of the hash before it."""

events = Table(
    "events", metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("at", Float, nullable=False),
    Column("bench", String(129), nullable=False),
    Column("kind", String(40), nullable=False),
    Column("data", Text, nullable=False),
)  # fmt: skip
"""What those who watch are told, in order."""

principals = Table(
    "principals", metadata,
    Column("name", String(64), primary_key=True),
    Column("created_at", Float, nullable=False),
    Column("disabled", Boolean, nullable=False, default=False),
)  # fmt: skip
"""People and programs."""

rights = Table(
    "rights", metadata,
    Column("principal", ForeignKey("principals.name"), primary_key=True),
    Column("lab", String(64), primary_key=True),
    Column("role", String(20), primary_key=True),
)  # fmt: skip
"""Who has which role in which lab, `*` for all."""

tokens = Table(
    "tokens", metadata,
    Column("id", String(16), primary_key=True),
    Column("hash", LargeBinary(32), nullable=False, unique=True),
    Column("principal", ForeignKey("principals.name"), nullable=False),
    Column("kind", String(10), nullable=False),
    Column("label", String(200), nullable=False, default=""),
    Column("scope", Text),
    Column("created_at", Float, nullable=False),
    Column("expires_at", Float, nullable=False),
    Column("ended_at", Float),
    Column("parent", String(16)),
    Index("tokens_of", "principal"),
)  # fmt: skip
"""What lets a principal in, as SHA-256. `kind`: a `token`, that of what changes something at a desk (`desk`) and of
what only looks there (`look`), or a `code` that is exchanged for a token, once. `scope`: the rights of the principal
that it carries, all where it is null. `ended_at`: revoked, or exchanged. `parent`: the principal's own token that it
was made with, and is revoked with."""

sessions = Table(
    "sessions", metadata,
    Column("hash", LargeBinary(32), primary_key=True),
    Column("token", ForeignKey("tokens.id"), nullable=False),
    Column("created_at", Float, nullable=False),
    Column("expires_at", Float, nullable=False),
    Column("ended_at", Float),
)  # fmt: skip
"""What lets a browser in, as SHA-256, as long as the token does for which it was given."""

edges = Table(
    "edges", metadata,
    Column("bench", ForeignKey("benches.bench"), primary_key=True),
    Column("key", Text, nullable=False),
    Column("enrolled_at", Float, nullable=False),
    Column("enrolled_by", String(64), nullable=False),
    Column("revoked_at", Float),
)  # fmt: skip
"""The edge of each bench, and the key by which it is known."""

enrolments = Table(
    "enrolments", metadata,
    Column("hash", LargeBinary(32), primary_key=True),
    Column("bench", String(129), nullable=False),
    Column("by", String(64), nullable=False),
    Column("expires_at", Float, nullable=False),
    Column("used_at", Float),
)  # fmt: skip
"""Codes by which an edge is enrolled, once."""
