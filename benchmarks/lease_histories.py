"""Histories of leases, told by who had them: `python benchmarks/lease_histories.py --histories 50`.

Two clients take the lease of one bench from a coordinator over HTTP, keep it, renew it, give it back, steal it and
forget it, at random, while a third party plays the edge that fences. Each writes what it was told, when it asked and
when it heard: tokens order all grants, so one pass over the intervals tells whether ever two had the bench. Prints the
counts; exit code 1 where a history breaks a rule.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from network_bench import BENCH, TOKEN, answers, coordinator, dialled, forked, free_port, until  # noqa: E402


@dataclass(frozen=True)
class Told:
    """What somebody was told: by which token `who` had the bench, as `deed` (`has`: it was granted or renewed, `ended`:
    it gave it back, `fenced`: the edge fenced for it), asked for at `asked` and heard at `heard`."""

    who: str
    deed: str
    token: int
    asked: float
    heard: float


def broken(history: Sequence[Told]) -> list[str]:
    """Return which rules a history breaks, in one pass over its grants in the order of their tokens.

    A token belongs to one; a later one was asked for, or renewed, by nobody after the edge has fenced for a still later
    one was heard; the edge fences upward; nobody has a token that the edge did not fence for.
    """
    wrong = []
    fences = sorted((t for t in history if t.deed == "fenced"), key=lambda t: t.heard)
    if [t.token for t in fences] != sorted({t.token for t in fences}):
        wrong.append("the edge fenced for a token again, or for an earlier one")
    at = {t.token: t for t in fences}
    owners: dict[int, str] = {}
    last: dict[int, float] = {}
    for told in sorted((t for t in history if t.deed == "has"), key=lambda t: (t.token, t.asked)):
        if owners.setdefault(told.token, told.who) != told.who:
            wrong.append(f"{owners[told.token]} and {told.who} were both granted token {told.token}")
        if told.token not in at or told.heard < at[told.token].asked:
            wrong.append(f"{told.who} was told of token {told.token} before the edge had fenced for it")
        last[told.token] = max(last.get(told.token, 0.0), told.asked)
    ended = {t.token: t for t in history if t.deed == "ended"}
    tokens = sorted(at)
    for token, later in pairwise(tokens):
        if last.get(token, 0.0) > at[later].heard:
            wrong.append(f"token {token} was renewed after the edge had fenced for {later}")
        if token in ended and last.get(token, 0.0) > ended[token].heard:
            wrong.append(f"token {token} was renewed after it was given back")
    return wrong


async def history(port: int, seed: int, key: str, deeds: int) -> list[Told]:
    """Let two clients and an edge loose; return what they were told."""
    found: list[Told] = []
    over = asyncio.Event()
    edge = asyncio.create_task(_edge(port, key, found, over, random.Random(f"edge{seed}")))
    try:
        await asyncio.gather(*(_client(port, f"{who}{seed}", found, random.Random(f"{who}{seed}"), deeds)
                               for who in ("ann", "ben")))  # fmt: skip
    finally:
        over.set()
        await edge
    return found


async def _client(port: int, who: str, found: list[Told], draw: random.Random, deeds: int) -> None:
    from pico.edge.network.asking import ask
    from pico.edge.network.remotes import Remote

    remote, at, token = Remote(f"http://127.0.0.1:{port}"), f"/benches/{BENCH}/lease", 0

    async def said(method: str, path: str, body: Any = None) -> tuple[Any, float, float]:
        from pico.diagnostics import PicoError

        asked = time.monotonic()
        try:
            answer = await asyncio.to_thread(ask, remote, method, path, body)
        except PicoError:
            answer = {}
        return answer, asked, time.monotonic()

    for _ in range(deeds):
        deed = draw.choice(("take", "take", "renew", "renew", "release", "steal"))
        if deed == "take":
            answer, *when = await said("POST", at, {"session": who, "wait": draw.choice((0.0, 0.3))})
        elif deed == "renew" and token:
            answer, *when = await said("PUT", at, {"session": who, "token": token})
        elif deed == "release" and token:
            answer, *when = await said("DELETE", f"{at}?session={who}&token={token}")
            found.append(Told(who, "ended", token, *when))
            token, answer = 0, {}
        elif deed == "steal":
            answer, *when = await said("POST", f"{at}/steal", {"session": who, "reason": "a benchmark"})
        else:
            continue
        if answer.get("state") == "granted":
            token = int(answer["token"])
            found.append(Told(who, "has", token, *when))
        await asyncio.sleep(draw.uniform(0.0, 0.02))


async def _edge(port: int, key: str, found: list[Told], over: asyncio.Event, draw: random.Random) -> None:
    import json

    fenced = int((await asyncio.to_thread(_fenced.read_text)) or 0)
    async with dialled(port, BENCH, key, fenced) as link:
        while not over.is_set():
            said = {"asked": 1, "fenced": fenced, "taken": 0, "busy": False, "moving": None}
            await link.send(json.dumps({"poll": said}))
            while "asked" not in (lease := json.loads(await link.recv())["lease"]):
                pass
            if lease["token"] > fenced:
                asked = time.monotonic()
                await asyncio.sleep(draw.uniform(0.0, 0.02))  # it drains
                fenced = int(lease["token"])
                _fenced.write_text(str(fenced))
                found.append(Told("edge", "fenced", fenced, asked, time.monotonic()))
            else:
                await asyncio.sleep(0.005)


_fenced = Path()


def main() -> int:
    """Record and check."""
    global _fenced  # noqa: PLW0603
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--histories", type=int, default=50)
    parser.add_argument("--deeds", type=int, default=60, help="of each client in a history")
    given = parser.parse_args()
    from sqlalchemy import update

    from pico.server.access.principal import ROLES, right
    from pico.server.access.secret import fingerprint
    from pico.server.store.books import books_in
    from pico.server.store.edges import Edges
    from pico.server.store.tables import tokens

    os.environ["PICO_TOKEN"] = TOKEN
    wrong = grants = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder, key, port = Path(temporary) / "books", "5" * 64, free_port()
        books = books_in(folder)
        books.people.settled("anna", [right(role) for role in ROLES], by="benchmark")
        books.people.issued("anna", 86400.0, by="benchmark")
        with books.database.writing() as connection:
            connection.execute(update(tokens).values(hash=fingerprint(TOKEN)))
        code, _ = Edges(books.database).invited(BENCH, "benchmark")
        Edges(books.database).enrolled(code, key)
        books.close()
        _fenced = Path(temporary) / "fenced"
        _fenced.write_text("0")
        serving = forked(lambda: coordinator(folder, port))
        try:
            until(lambda: answers(port), 60)
            for seed in range(given.histories):
                told = asyncio.run(history(port, seed, key, given.deeds))
                grants += len({t.token for t in told if t.deed == "has"})
                for one in broken(told):
                    wrong += 1
                    print(f"history {seed}: {one}", flush=True)
        finally:
            os.kill(serving, 9)
            os.waitpid(serving, 0)
    print(f"{given.histories} histories of two clients, {grants} leases that were had: {wrong} broken rules")
    return 1 if wrong or not grants else 0


if __name__ == "__main__":
    sys.exit(main())
