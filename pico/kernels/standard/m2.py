"""The beam propagation ratio of widths that were read along a beam: ISO 11146-1, 9."""

from __future__ import annotations

from collections.abc import Mapping

from pico.kernels.frame import Readings
from pico.kernels.kernel import Declaration, Parameter, Result

KERNEL = Declaration(
    version="1",
    takes="readings",
    units={"m2": "1", "waist": "um", "at": "mm", "divergence": "mrad", "rayleigh": "mm"},
    parameters={"wavelength": Parameter("nm", least=0.0)},
)
_SURE = 3.0
_ENOUGH = 5
"""Places within one Rayleigh length of the waist, and as many beyond two, that the standard wants."""


def apply(given: Readings, parameters: Mapping[str, float]) -> Result:
    """Return M2, the width of the waist [um] and its place [mm], the full divergence [mrad] and the Rayleigh length
    [mm], from widths D4sigma [um] at `places` [mm]. A ratio below 1 by more than its error is impossible: then nothing
    is known."""
    import numpy as np

    from pico.kernels.caustic import caustic

    if len(given.places) != len(given.values) or not given.sigma:
        return Result(unknown="expected widths with their uncertainties and places along the beam")
    found = caustic(np.array(given.places), np.array(given.values), np.array(given.sigma), parameters["wavelength"])
    if isinstance(found, str):
        return Result(unknown=found)
    if found.m2 < 1 - _SURE * found.sigma[0]:
        text = f"M2 would be {found.m2:.3g} ± {found.sigma[0]:.2g}, and no beam has less than 1"
        return Result(unknown=f"{text}: the size of a pixel, the wavelength or the places are wrong")
    remark = ""
    if min(found.near, found.far) < _ENOUGH:
        remark = (
            f"ISO 11146-1 wants {_ENOUGH} places within one Rayleigh length of the waist and {_ENOUGH} beyond two; "
            f"there are {found.near} and {found.far}"
        )
    numbers = (found.m2, found.waist, found.at, found.divergence, found.rayleigh)
    return Result(
        dict(zip(KERNEL.units, numbers, strict=True)), dict(zip(KERNEL.units, found.sigma, strict=True)), remark=remark
    )
