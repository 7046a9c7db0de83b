"""What kernels make of another measurable of the same component: `kernel: image | centroid` of its type."""

from __future__ import annotations

from dataclasses import replace

from pico.backends.attempt import Failed
from pico.backends.measured import Reading
from pico.backends.sim.checks import not_simulated
from pico.backends.sim.readings import Table, measurer_of
from pico.diagnostics import PicoError, error
from pico.kernels.measured import computed, version
from pico.kernels.pipeline import parsed
from pico.model.setup import Setup


def measures(setup: Setup, component: str, measurable: str) -> bool:
    """Whether it is computed of what can be measured."""
    try:
        kernel = setup.measurable_of(component, measurable).kernel
        source = parsed(kernel).source if kernel else None
    except PicoError:
        return False
    if source is None:
        return False
    known = setup.measurables_of(component).get(source)
    return known is not None and known.kernel is None and measurer_of(setup, component, source) is not None


def read(table: Table, component: str, measurable: str) -> Reading:
    """Return what the kernels give; no value where they cannot tell, with why. The picture stays with what somebody
    asked of it by kernels of his own."""
    kernel = table.setup.measurable_of(component, measurable).kernel or ""
    pipeline = parsed(kernel)
    measurer = measurer_of(table.setup, component, pipeline.source)
    if measurer is None:
        raise Failed(not_simulated(component, pipeline.source))
    base = measurer.read(table, component, pipeline.source)
    if base.array is None and base.unknown:
        return replace(base, kernel=kernel, kernel_version=version(pipeline))
    if base.array is None:
        raise Failed(error("no-array", f"{component}.{pipeline.source} gives nothing for kernels", address=component))
    found = computed(pipeline, base.array, base.settings)
    return replace(
        base, array=base.array if measurable == kernel else None,
        value=found.value, sigma=found.sigma, kernel=kernel, kernel_version=version(pipeline),
        unknown=found.unknown, unit=found.unit, remark=found.remark,
    )  # fmt: skip
