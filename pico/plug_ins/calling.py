"""Loads plug-ins and calls them: a broken one raises PicoError (code `plugin`), and never anything else.

What PICO itself brings passes through unchanged: its mistakes are PICO's.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import wraps
from types import ModuleType, SimpleNamespace
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError
from pico.plug_ins.faults import broken, fault, own_met_it
from pico.plug_ins.known import PlugIn, entries, named, own_module, plug_in

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

Wrong = Callable[[Any], str]
"""Returns what is wrong with a value, '' if nothing is."""


@dataclass(frozen=True)
class Interface:
    """What plug-ins of a group must be like."""

    group: str
    has: Mapping[str, Wrong] = field(default_factory=dict)
    """What a module of it must have, by name: what is wrong with the value."""
    returns: Mapping[str, Wrong] = field(default_factory=dict)
    """What its functions must return, by name."""
    makes: tuple[str, ...] = ()
    """Functions that make an object, whose methods are guarded, too."""
    lets: tuple[type[Exception], ...] = ()
    """Exceptions, besides PicoError, by which its functions may say that something can't be done."""


def instance(*types: type) -> Wrong:
    """Return what finds a value wrong that is of none of the types."""
    names = " or ".join(t.__name__ for t in types)
    return lambda value: "" if isinstance(value, types) else f"is {shown(value)}, expected {names}"


def having(*names: str) -> Wrong:
    """Return what finds a value wrong that lacks one of the attributes."""

    def wrong(value: Any) -> str:
        lacking = [name for name in names if not hasattr(value, name)]
        return f"is {shown(value)}, which has no `{lacking[0]}`" if lacking else ""

    return wrong


def function(value: Any) -> str:
    """Return what is wrong with a value that can't be called."""
    return "" if callable(value) else f"is {shown(value)}, expected a function"


def shown(value: Any) -> str:
    """Return a value as messages have it: shortened, with its type."""
    text = repr(value)
    return f"{text if len(text) <= 60 else text[:57] + '...'} ({type(value).__name__})"


def module_of(interface: Interface, name: str, module: str) -> Any:
    """Return a module; if it is a plug-in's, its functions are guarded.

    Raises PicoError (code `plugin`) if a plug-in's module can't be imported or lacks something; raises whatever a
    module of PICO's own raises.
    """
    from importlib import import_module

    if own_module(module):
        return import_module(module)
    one = named(interface.group, name, module)
    with calling(one, "cannot be imported"):
        found = import_module(module)
    for key, wrong in interface.has.items():
        if not hasattr(found, key):
            raise broken(one, f"has no `{key}`", at=found)
        if why := wrong(getattr(found, key)):
            raise broken(one, f"is wrong: its `{key}` {why}", at=found)
    return _guarded_module(one, found, interface)


def loaded(interface: Interface, entry: EntryPoint) -> Any:
    """Return the object that an entry point names; a plug-in's function is guarded, and found wrong by
    `interface.has[""]`. Raises PicoError (code `plugin`) if a plug-in can't be loaded."""
    one = plug_in(interface.group, entry)
    if own_module(one.module):
        return entry.load()
    with calling(one, "cannot be loaded"):
        found = entry.load()
    if "" in interface.has and (why := interface.has[""](found)):
        raise broken(one, f"is wrong: `{one.attribute}` {why}", at=sys.modules.get(one.module))
    if inspect.isroutine(found):
        return guarded(one, found, interface.returns.get(""), interface.lets)
    return found


class Loading(Mapping[str, Any]):
    """The plug-ins of a group by name, each loaded when it is asked for; names are there whether it can be or not."""

    def __init__(self, interface: Interface) -> None:
        self._interface = interface
        self._entries = entries(interface.group)
        self._loaded: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._loaded:
            self._loaded[name] = loaded(self._interface, self._entries[name])
        return self._loaded[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __contains__(self, name: object) -> bool:
        return name in self._entries


@contextmanager
def calling(one: PlugIn, what: str, lets: tuple[type[Exception], ...] = ()) -> Iterator[None]:
    """Turn whatever a plug-in raises inside into PicoError (code `plugin`), besides PicoError and those of `lets`.

    `what` follows its title in the message."""
    try:
        yield
    except (Exception, SystemExit) as exc:
        if isinstance(exc, (PicoError, *lets)):
            raise
        if isinstance(exc, OSError) and own_met_it(exc) and not isinstance(exc, TimeoutError):
            raise  # a full disk is no mistake of the plug-in
        raise PicoError(fault(one, exc, what)) from exc


def guarded(
    one: PlugIn, call: Callable[..., Any], wrong: Wrong | None = None, lets: tuple[type[Exception], ...] = (),
    what: str = "",
) -> Callable[..., Any]:  # fmt: skip
    """Return a function, or coroutine function, of a plug-in that raises PicoError (code `plugin`) if it fails, or
    returns what is `wrong`."""
    what = what or getattr(call, "__name__", "it")

    def judged(value: Any) -> Any:
        if wrong is not None and (why := wrong(value)):
            raise broken(one, f"failed: what `{what}` returned {why}", at=call)
        return value

    @wraps(call)
    def called(*args: Any, **kwargs: Any) -> Any:
        with calling(one, f"failed in `{what}`", lets):
            value = call(*args, **kwargs)
        return judged(value)

    @wraps(call)
    async def awaited(*args: Any, **kwargs: Any) -> Any:
        with calling(one, f"failed in `{what}`", lets):
            value = await call(*args, **kwargs)
        return judged(value)

    return awaited if inspect.iscoroutinefunction(call) else called


def guarded_object(one: PlugIn, found: Any) -> Any:
    """Return an object that a plug-in made, its public methods guarded."""
    for name in dir(type(found)):
        if not name.startswith("_") and inspect.isfunction(getattr(type(found), name)):
            with suppress(AttributeError):  # one with slots stays as it is: `blamed` finds what it raises
                setattr(found, name, guarded(one, getattr(found, name)))
    return found


def _guarded_module(one: PlugIn, module: ModuleType, interface: Interface) -> SimpleNamespace:
    """Return what is in a plug-in's module, its functions guarded."""
    found = dict(vars(module))
    for key, value in vars(module).items():
        if inspect.isfunction(value):
            found[key] = guarded(one, value, interface.returns.get(key), interface.lets)
            if key in interface.makes:
                found[key] = _makes(one, found[key])
    return SimpleNamespace(**found)


def _makes(one: PlugIn, make: Callable[..., Any]) -> Callable[..., Any]:
    return lambda *args, **kwargs: guarded_object(one, make(*args, **kwargs))
