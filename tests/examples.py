"""How many examples properties draw that are dear to try."""

from hypothesis import settings


def examples(count: int) -> int:
    """Return so many in the whole suite, and a third of them where slow tests are left out."""
    return count * settings.default.max_examples // 100
