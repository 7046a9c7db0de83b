"""Nonlinear least squares (Levenberg-Marquardt) for the few parameters of a pose or a calibration."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Solution:
    """Parameters (n,), their covariance (n, n) for residuals of unit variance, and the residuals (m,) that are left."""

    parameters: Array
    covariance: Array
    residuals: Array

    @property
    def rms(self) -> float:
        """The root mean square of the residuals."""
        import numpy as np

        return float(np.sqrt(np.mean(self.residuals**2)))


def solve(residuals: Callable[[Array], Array], start: Array, steps: Array, rounds: int = 30) -> Solution:
    """Return the parameters that make the sum of squared `residuals` least.

    `steps` (n,): what a parameter is changed by to find its derivative, in its own unit. Where the matrix of the
    normal equations is singular its pseudo-inverse is the covariance. Where residuals are not finite nothing is found:
    covariance and residuals are not finite, either.
    """
    import numpy as np

    parameters, damping = np.array(start, np.float64), 1e-4
    left = residuals(parameters)
    jacobian = _jacobian(residuals, parameters, left, steps)
    for _ in range(rounds):
        normal, gradient = jacobian.T @ jacobian, jacobian.T @ left
        diagonal = np.diag(np.maximum(np.diag(normal), 1e-12))
        change = -np.linalg.solve(normal + damping * diagonal, gradient)
        tried = residuals(parameters + change)
        gained = float(left @ left - tried @ tried)
        if not np.isfinite(gained) or gained < 0:
            damping *= 10
            if damping > 1e8:
                break
            continue
        parameters, left, damping = parameters + change, tried, max(damping / 10, 1e-9)
        if np.all(np.abs(change) < 1e-3 * np.abs(steps)) or gained < 1e-10 * float(left @ left):
            break
        jacobian = _jacobian(residuals, parameters, left, steps)
    normal = jacobian.T @ jacobian
    lost = not np.isfinite(normal).all()
    covariance = np.full_like(normal, np.nan) if lost else np.asarray(np.linalg.pinv(normal), np.float64)
    return Solution(parameters, covariance, left)


def _jacobian(residuals: Callable[[Array], Array], at: Array, there: Array, steps: Array) -> Array:
    import numpy as np

    columns = [(residuals(at + step) - there) / size for step, size in zip(np.diag(steps), steps, strict=True)]
    return np.column_stack(columns)
