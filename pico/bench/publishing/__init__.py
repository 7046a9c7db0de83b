"""A revision as something to publish: state, plan, runs, measurements and pictures, described as an RO-Crate."""

from pico.bench.publishing.publish import Published, publish

__all__ = ["Published", "publish"]
