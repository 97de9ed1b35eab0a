"""Least squares for positive or signed numbers within bounds, and confidence intervals from the Jacobian."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import t as student

from riser_soil.core.arrays import Array

CONFIDENCE = 0.95
DIFFERENCE = 0.01  # of a scaled parameter, for derivatives: well above the solver's tolerance
CLOSE = 1e-3  # change of a scaled parameter at which the search ends
FLAT = 1e-4  # relative change of the sum of squares at which it ends
MOST_STEPS = 30
LEAST_SHARE = 0.1  # of the largest datum: smaller data have the error of this share
DEPENDENT = 1e-6  # least ratio of singular values of the Jacobian with which parameters are independent

Model = Callable[[Mapping[str, float]], Array]


@dataclass(frozen=True)
class FitParameter:
    """A number to be found: its path in the scene, bounds, and first guess within them.

    Scaled, it is ln(p) where both bounds are positive, so that an interval is a factor, else p over the bounds' width.
    """

    name: str
    low: float
    high: float
    guess: float

    def scaled(self, value: float) -> float:
        return float(np.log(value)) if self.low > 0.0 else value / (self.high - self.low)

    def value(self, scaled: float) -> float:
        """Back from the scale, and kept within the bounds against round-off."""
        value = float(np.exp(scaled)) if self.low > 0.0 else scaled * (self.high - self.low)
        return min(max(value, self.low), self.high)


@dataclass(frozen=True)
class FittedParameter:
    """A fitted number and its interval of confidence CONFIDENCE, (-inf, inf) where the data do not determine it."""

    parameter: FitParameter
    value: float
    interval: tuple[float, float]

    @property
    def known(self) -> bool:
        return bool(np.isfinite(self.interval).all())

    @property
    def at_bound(self) -> bool:
        p = self.parameter
        near = 5.0 * CLOSE
        x, ends = p.scaled(self.value), (p.scaled(p.low), p.scaled(p.high))
        return bool(min(abs(x - end) for end in ends) < near)


@dataclass(frozen=True, eq=False)
class Fit:
    """Fitted parameters and the model's values (n,) there. misfit: root mean square. converged: of the search."""

    parameters: tuple[FittedParameter, ...]
    values: Array
    misfit: float
    converged: bool
    runs: int


def fit(
    model: Model,
    data: Array,
    parameters: tuple[FitParameter, ...],
    on_run: Callable[[int, float, Mapping[str, float]], None] = lambda *_: None,
    *,
    relative: bool = False,
) -> Fit:
    """Fit parameters of a model to data (n,) by least squares.

    on_run: called at each step with the number of runs so far, the misfit and the parameters. relative: errors grow
    with the data, those below LEAST_SHARE of the largest excepted; else they are of one size.
    """
    sizes = error_sizes(data) if relative else np.full(len(data), np.sqrt(np.mean(data**2)))
    search = _Search(model, data, sizes, parameters, on_run)
    first = np.array([p.scaled(p.guess) for p in parameters])
    low, high = np.array([p.scaled(p.low) for p in parameters]), np.array([p.scaled(p.high) for p in parameters])
    solution = least_squares(
        search.residual, first, search.jacobian, (low, high), xtol=CLOSE, ftol=FLAT, max_nfev=MOST_STEPS
    )
    values = search.residual(solution.x) * sizes + data
    misfit = float(np.sqrt(np.mean((values - data) ** 2)))
    spread = deviations(solution.jac, solution.fun)
    fitted = zip(parameters, solution.x, spread, strict=True)
    return Fit(
        tuple(_with_interval(*each, len(data) - len(first)) for each in fitted),
        values,
        misfit,
        solution.status > 0,
        search.runs,
    )


def error_sizes(data: Array) -> Array:
    """Sizes (n,) to which errors of data (n,) are proportional."""
    size = np.abs(data)
    return np.asarray(np.maximum(size, LEAST_SHARE * size.max()))


def deviations(J: Array, r: Array) -> Array:
    """Standard deviations (p,) of least-squares parameters from the Jacobian (n, p) and the residuals (n,) there:
    those of independent errors that count alike; inf for all where the columns are dependent."""
    n, p = J.shape
    _, sizes, V = np.linalg.svd(J, full_matrices=False)
    if n <= p or sizes[-1] <= DEPENDENT * sizes[0]:
        return np.full(p, np.inf)
    variance = float(r @ r) / (n - p)
    return np.asarray(np.sqrt(variance * np.sum((V / sizes[:, None]) ** 2, axis=0)))


def _with_interval(parameter: FitParameter, x: float, deviation: float, freedom: int) -> FittedParameter:
    value = parameter.value(x)
    if not np.isfinite(deviation):
        return FittedParameter(parameter, value, (-np.inf, np.inf))
    reach = float(student.ppf(0.5 + 0.5 * CONFIDENCE, freedom)) * deviation
    if parameter.low > 0.0:
        return FittedParameter(parameter, value, (value * float(np.exp(-reach)), value * float(np.exp(reach))))
    reach *= parameter.high - parameter.low
    return FittedParameter(parameter, value, (value - reach, value + reach))


class _Search:
    """Residuals over the sizes of the errors, and their Jacobian by differences into the bounds; keeps the last run."""

    def __init__(
        self,
        model: Model,
        data: Array,
        sizes: Array,
        parameters: tuple[FitParameter, ...],
        on_run: Callable[[int, float, Mapping[str, float]], None],
    ) -> None:
        self._model, self._data, self._sizes, self._parameters, self._on_run = (
            model,
            data,
            sizes,
            parameters,
            on_run,
        )
        self.runs = 0
        self._last: tuple[Array, Array] | None = None

    def residual(self, x: Array) -> Array:
        if self._last is None or not np.array_equal(self._last[0], x):
            self._last = x.copy(), self._run(x)
        return self._last[1]

    def _run(self, x: Array) -> Array:
        self.runs += 1
        return (self._model(self._named(x)) - self._data) / self._sizes

    def _named(self, x: Array) -> dict[str, float]:
        return {p.name: p.value(value) for p, value in zip(self._parameters, x, strict=True)}

    def jacobian(self, x: Array) -> Array:
        here = self.residual(x)
        self._on_run(self.runs, float(np.sqrt(np.mean((self._sizes * here) ** 2))), self._named(x))
        columns = []
        for n, p in enumerate(self._parameters):
            inwards = 1.0 if x[n] + DIFFERENCE <= p.scaled(p.high) else -1.0
            beside = x.copy()
            beside[n] += inwards * DIFFERENCE
            columns.append(inwards * (self._run(beside) - here) / DIFFERENCE)
        return np.column_stack(columns)
