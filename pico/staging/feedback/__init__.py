"""Fewest vertices, or fewest stagings, that leave a digraph without cycles; knows nothing of tables and robots."""

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
from pico.staging.feedback.vertices import Feedback, fewest_vertices

__all__ = [
    "Arc",
    "Choice",
    "Component",
    "Cycle",
    "Event",
    "Feedback",
    "Limit",
    "Link",
    "Option",
    "Problem",
    "Staging",
    "arrives",
    "fewest_vertices",
    "leaves",
    "solve",
]
