"""Fewest stagings that leave what must come before what without a cycle; knows nothing of tables and robots."""

from pico.staging.feedback.limit import Limit
from pico.staging.feedback.problem import (
    Arc,
    Choice,
    Component,
    Cycle,
    Link,
    Option,
    PartEvent,
    StagingAnswer,
    StagingProblem,
    arrives,
    leaves,
)
from pico.staging.feedback.staging import solve

__all__ = [
    "Arc",
    "Choice",
    "Component",
    "Cycle",
    "Limit",
    "Link",
    "Option",
    "PartEvent",
    "StagingAnswer",
    "StagingProblem",
    "arrives",
    "leaves",
    "solve",
]
