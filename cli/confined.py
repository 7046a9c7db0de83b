"""Keeps a command to some folders, whatever the manifests and recipes that it reads name: a second wall behind the
checks of what is read, for Python's own opening of files and starting of programs."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

SYSTEM = ("/usr", "/lib", "/lib64", "/bin", "/dev/null", "/dev/urandom", "/etc/localtime", "/etc/mime.types",
          "/etc/hosts", "/etc/resolv.conf", "/etc/nsswitch.conf", "/etc/host.conf", "/etc/gai.conf", "/etc/ssl",
          "/etc/ld.so.cache", "/proc/stat", "/proc/cpuinfo", "/sys/devices/system/cpu")  # fmt: skip
"""What may be read besides the program's own folders."""
_PROCESS = re.compile(r"/proc/[0-9]+/(stat|cmdline)")
"""Whether a process that left something half done still lives."""
PROGRAMS = ("git",)
_WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_CHANGES = {"os.remove": 1, "os.rename": 2, "os.link": 2, "os.symlink": 2, "os.mkdir": 1, "os.rmdir": 1,
            "os.truncate": 1, "os.chmod": 1, "sqlite3.connect": 1}  # fmt: skip
"""Events by how many of their arguments are paths that are written."""


def confine(folders: Sequence[str]) -> None:
    """Have nothing opened from now on but in `folders`, and to read in those of the system and of the program; a
    process can't take that back."""
    import pico
    from pico.resources import catalog_dir, labs_dir, schemas_dir

    own = tuple(map(os.path.realpath, folders))
    here = Path(__file__).parent
    programs = (sys.prefix, sys.base_prefix, here, pico.__path__[0], catalog_dir(), labs_dir(), schemas_dir())
    read = (*own, *SYSTEM, *{os.path.realpath(one) for one in (*programs, *SYSTEM)})
    executable = {os.path.realpath(sys.executable), sys.executable}

    def heard(event: str, arguments: tuple[Any, ...]) -> None:
        if event == "open":
            path, mode, flags = arguments
            writes = bool((flags or 0) & _WRITES) or bool(mode and set(mode) & set("wax+"))
            _require(path, own if writes else read)
        elif event in _CHANGES:
            for path in arguments[: _CHANGES[event]]:
                _require(path, own)
        elif event in ("os.listdir", "os.scandir"):
            _require(arguments[0], read)
        elif event in ("subprocess.Popen", "os.exec", "os.posix_spawn", "os.system", "os.startfile"):
            program = os.fsdecode(arguments[0]) if arguments[0] else ""
            if event == "os.system" or (Path(program).name not in PROGRAMS and program not in executable):
                raise PermissionError(1, "no program is started at a desk", program)

    def _require(path: Any, within: Sequence[str]) -> None:
        if path is None or isinstance(path, int):
            return
        text = os.path.realpath(os.fsdecode(path))
        if (
            text != os.devnull
            and not _PROCESS.fullmatch(text)
            and not any(text == folder or text.startswith(f"{folder}/") for folder in within)
        ):
            raise PermissionError(13, "outside of the desk", os.fsdecode(path))

    sys.addaudithook(heard)
