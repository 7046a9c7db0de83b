"""Kinds of instruments, a file each, found by being there; each has an `InstrumentKind` as its `KIND`."""
