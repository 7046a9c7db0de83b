"""Fewest stagings that leave what must come before what without a cycle; knows nothing of tables and robots."""

from pico.staging.feedback.limit import Limit
from pico.staging.feedback.problem import (
    Arc,
    Choice,
    Component,
    Cycle,
    Event,
    Link,
    Option,
    Problem,
    Staging,
    arrives,
    leaves,
)
from pico.staging.feedback.staging import solve

__all__ = [
    "Arc",
    "Choice",
    "Component",
    "Cycle",
    "Event",
    "Limit",
    "Link",
    "Option",
    "Problem",
    "Staging",
    "arrives",
    "leaves",
    "solve",
]
