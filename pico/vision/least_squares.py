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
    """Parameters (n,), their covariance (n, n) for residuals of unit variance, the residuals (m,) that are left, and
    their derivatives (m, n)."""

    parameters: Array
    covariance: Array
    residuals: Array
    jacobian: Array

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
    return Solution(parameters, covariance, left, jacobian)


LENT = 1.0
"""As how many residuals of its own a group counts what others of its kind show: as one, so that it hardly matters to a
group that shows its own noise (unit information: R. E. Kass, L. Wasserman, J. Am. Stat. Assoc. 90, 928 (1995))."""
_ROUNDS = 8  # of the noise of groups, each from what the fit with the noise before leaves


def noise_by_group(found: Solution, noise: Array, groups: Array, kinds: Array) -> Array:
    """Return one standard deviation (g,) of what was observed, by group, as the residuals of a fit show it.

    `noise` (g,): what the fit took it to be; `groups`: the group of each residual, of the first ones, if the others are
    of what was known before and keep their unit variance; `kinds` (g,): groups of one kind lend each other their noise,
    which counts the more, the fewer residuals a group has. Residuals without weight do not count.

    A fit bends toward each observation by its leverage j C j^T; the rest is what the others check. The variance of a
    group is the sum of its squared residuals by that number (variance components: W. Förstner, ZfV 104, 446 (1979)),
    drawn to that of its kind (G. K. Smyth, Stat. Appl. Genet. Mol. Biol. 3, 3 (2004)).
    """
    import numpy as np

    count, known = len(groups), np.ones(len(found.residuals) - len(groups))
    plain = np.append(noise[groups], known)
    left, jacobian = found.residuals * plain, found.jacobian * plain[:, None]
    used, found_noise = found.jacobian.any(axis=1), np.array(noise, np.float64)
    for _ in range(_ROUNDS):
        weight = 1 / np.append(found_noise[groups], known)
        weighted = jacobian * weight[:, None]
        covariance = np.linalg.pinv(weighted.T @ weighted)
        checked = np.where(used, 1 - np.sum(weighted @ covariance * weighted, axis=1), 0.0)
        squares = np.where(used, (left - jacobian @ (covariance @ (weighted.T @ (left * weight)))) ** 2, 0.0)
        free, total = (np.bincount(groups, values[:count], len(noise)) for values in (checked, squares))
        of_kind, in_kind = (np.bincount(kinds, values)[kinds] for values in (free, total))
        usual = np.where(of_kind > LENT, in_kind / np.maximum(of_kind, LENT), found_noise**2)
        found_noise = np.sqrt((total + LENT * usual) / (np.maximum(free, 0.0) + LENT))
    return found_noise


def _jacobian(residuals: Callable[[Array], Array], at: Array, there: Array, steps: Array) -> Array:
    import numpy as np

    columns = [(residuals(at + step) - there) / size for step, size in zip(np.diag(steps), steps, strict=True)]
    return np.column_stack(columns)
