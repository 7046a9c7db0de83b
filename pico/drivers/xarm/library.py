"""The vendor's library, imported when it is needed and kept to itself.

As it comes it prints to the terminal, from threads of its own, changes the timeout of every new socket of the process
(`socket.setdefaulttimeout`), makes a folder for logs in the user's home, prefers a Unix socket in the temporary
directory to the address that it was given, and may look for its control box for minutes. Reports it takes only from the
vendor's port numbers.
"""

from __future__ import annotations

import asyncio
import builtins
import logging
import os
import socket
import sys
import threading
from collections.abc import Sequence
from functools import cache
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType, SimpleNamespace
from typing import Any

from pico.diagnostics import PicoError, error
from pico.drivers.xarm.replies import judged

CONTROL_PORT = 502
ANSWER = 0.7
"""How long one request may take [s]."""
OPENING = 1.5
"""How long it may take until a control box has said what it is, and reported once [s]."""

_LOCK, _IMPORTING = threading.Lock(), threading.Lock()
_LOG = "xarm.core.utils.log"
"""The module of the library that makes a folder when it is imported."""


class _Sockets:
    """The module `socket` for the vendor's library, without what would change the whole process."""

    def __getattr__(self, name: str) -> object:
        """What `socket` has; the library sets the timeout of each of its own sockets as well."""
        return _ignored if name == "setdefaulttimeout" else getattr(socket, name)


class _System:
    """The module `os` for the vendor's library, which makes no folder."""

    def __getattr__(self, name: str) -> object:
        return _ignored if name == "makedirs" else getattr(os, name)


def library() -> Any:
    """Return the vendor's class of an arm; raises ImportError where the extra `xarm` is not installed."""
    with _IMPORTING:
        return _library()


@cache
def _library() -> Any:
    quietly = SimpleNamespace(find_spec=_quiet)
    sys.meta_path.insert(0, quietly)
    try:
        from xarm.core.comm import socket_port
        from xarm.core.utils import log
        from xarm.wrapper import XArmAPI
    finally:
        sys.meta_path.remove(quietly)
    for name, module in list(sys.modules.items()):
        if name.startswith("xarm."):  # what somebody else imported before, too
            module.__dict__["print"] = _ignored
    for logger in (log.logger, log.origin_logger, log.Logger.logger):
        logger.handlers.clear()
        logger.addHandler(logging.NullHandler())
        logger.propagate = False
    socket_port.__dict__["socket"] = _Sockets()
    return XArmAPI


def _quiet(name: str, path: Sequence[str] | None, target: object = None) -> ModuleSpec | None:
    """Find a module of the library, and let it begin with a `print` of its own, that does nothing; the one that makes a
    folder with an `os` of its own, too."""
    spec = PathFinder.find_spec(name, path) if name.startswith("xarm.") else None
    if spec is None or spec.loader is None:
        return None
    run = spec.loader.exec_module

    def unheard(module: ModuleType) -> None:
        module.__dict__["print"] = _ignored
        if name == _LOG:
            module.__dict__["__builtins__"] = {**vars(builtins), "__import__": _imported}
        run(module)

    spec.loader.exec_module = unheard  # type: ignore[method-assign]
    return spec


def _imported(name: str, *how: Any, **more: Any) -> object:
    """What `import` gives, but for `os`."""
    return _System() if name == "os" else builtins.__import__(name, *how, **more)


async def imported(name: str) -> None:
    """Import the library, which takes seconds, before device `name` has a deadline. Raises PicoError without it."""
    try:
        await asyncio.to_thread(library)
    except ImportError as exc:
        text = f"{name} needs the vendor's library, which can't be imported: {exc}"
        raise PicoError(error("missing-extra", text, hint="pip install 'pico-lab[xarm]'", address=name)) from exc


def _ignored(*args: object, **options: object) -> None:
    """Stand in for what the library is not to do: `print`, for one."""


def connected(host: str, port: int) -> Any:
    """Return an open connection to the control box at an IPv4 address, in radians, with reports.

    Raises ConnectionError where none answers within OPENING.
    """
    made = library()(
        host, is_radian=True, do_not_open=True, forbid_uds=True, check_joint_limit=False,
        check_is_pause=False, check_cmdnum_limit=False,  # with these it waits without end for a person
    )  # fmt: skip
    failed: list[BaseException] = []

    def connect() -> None:
        try:
            made.connect()
        except BaseException as exc:
            failed.append(exc)

    with _LOCK:  # the port is one of the process, in this library
        from xarm.core.config.x_config import XCONF

        XCONF.SocketConf.TCP_CONTROL_PORT = port
        opening = threading.Thread(target=connect, daemon=True, name="xarm connect")
        opening.start()
        opening.join(OPENING)
    if opening.is_alive() or failed or not made.connected:
        dropped(made)
        raise ConnectionError(f"no control box answers at {host}:{port}")
    made.set_timeout(ANSWER)
    judged(made.core)
    return made


def dropped(made: Any) -> None:
    """Close a connection without waiting for its threads; they end by themselves."""
    threading.Thread(target=made.disconnect, daemon=True, name="xarm disconnect").start()
