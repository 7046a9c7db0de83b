"""The edge in this process: `LocalEdge`, and the parts that it is composed of, a file each."""

from pico.edge.local.edge import LocalEdge, embedded

__all__ = ["LocalEdge", "embedded"]
