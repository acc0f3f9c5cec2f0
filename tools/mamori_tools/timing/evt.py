# SPDX-License-Identifier: Apache-2.0
"""Extreme-value estimate of an execution time if the series permits one; otherwise the reason of the rejection.

Block maxima with a Gumbel distribution, fitted to even blocks and tested on odd blocks.

Source: runs test: Wald and Wolfowitz, "On a test whether two samples are from the same population", 1940.
        Portmanteau test: Ljung and Box, "On a measure of lack of fit in time series models", 1978, here on ranks.
        Fit by L-moments: Hosking, "L-moments", 1990 (Gumbel: scale = l2 / ln 2, location = l1 - Euler's constant * scale).
        Test of a Gumbel tail: Hosking, Wallis and Wood, "Estimation of the generalized extreme-value distribution by the method
        of probability-weighted moments", 1985 (shape k, z = k * sqrt(n / 0.5633)).
        Fit of the held-out maxima: Kolmogorov and Smirnov, critical value 1.358 / (sqrt(n) + 0.12 + 0.11 / sqrt(n)) at 5 %
        (Stephens, "EDF statistics for goodness of fit and some comparisons", 1974).

@satisfies SWR-TIM-018      Design: docs/design/timing.md#extreme-values
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mamori_tools.timing.reader import Array

BLOCK = 50
BLOCKS_MIN = 40
"""Half of the blocks are fitted, half tested; with fewer than 20 each, the result is meaningless."""
BLOCKS_WANTED = 200
DISTINCT_MIN = 10
"""Maxima with fewer different values are clock steps, not a continuous quantity."""
LAGS = 20  # even: the chi-squared tail then has a closed form
P_MIN = 0.05
TAIL_Z_MAX = 1.645  # one-sided, 5 %
EULER = 0.5772156649015329
PROBABILITIES = (1e-6, 1e-9)


@dataclass(frozen=True)
class Test:
    """One test and its result. `text` names the statistic."""

    name: str
    statistic: float
    limit: float
    is_passed: bool
    text: str


@dataclass(frozen=True)
class Estimate:
    """`quantiles_ns`: value [ns] that a window instance exceeds with each probability in PROBABILITIES. After a rejection it is empty, and
    `refusal` contains the reason."""

    tests: tuple[Test, ...]
    quantiles_ns: dict[float, float]
    refusal: str = ""


def estimate(values: Array, cut_count: int = 0) -> Estimate:
    """@param values [ns] in order of time, one per window instance. @param cut_count instances with incomplete time."""
    if cut_count:
        return _refuse((), f"{cut_count} window instances were aborted: their times are incomplete")
    block = max(BLOCK, len(values) // BLOCKS_WANTED)
    count = len(values) // block
    if count < BLOCKS_MIN:
        return _refuse((), f"{len(values)} values are too few, at least {BLOCK * BLOCKS_MIN} are needed")
    maxima = values[: count * block].reshape(count, block).max(axis=1).astype(float)
    distinct = len(np.unique(maxima[::2]))
    if distinct < DISTINCT_MIN:
        return _refuse((), f"the maxima of {len(maxima[::2])} blocks have {distinct} different values, at least {DISTINCT_MIN} are needed: "
                           "the clock is too coarse, or the time does not vary")  # fmt: skip
    tests = [check_runs(values), check_correlation(values)]
    failed = [test.text for test in tests if not test.is_passed]
    if failed:
        return _refuse(tuple(tests), f"the window instances are not independent: {'; '.join(failed)}")
    fitted, held_out = maxima[::2], maxima[1::2]
    location, scale = fit_gumbel(fitted)
    tests += [check_tail(fitted), check_fit(held_out, location, scale)]
    failed = [test.text for test in tests if not test.is_passed]
    if failed:
        return _refuse(tuple(tests), f"the tail does not fit the model: {'; '.join(failed)}")
    quantiles = {p: location - scale * math.log(-block * math.log1p(-p)) for p in PROBABILITIES}
    if (greatest := float(values.max())) > (rarest := quantiles[PROBABILITIES[-1]]):
        return _refuse(tuple(tests), f"the estimate of {rarest:.0f} ns for {PROBABILITIES[-1]:g} is below the {greatest:.0f} ns that were measured")
    return Estimate(tuple(tests), quantiles)


def _refuse(tests: tuple[Test, ...], reason: str) -> Estimate:
    return Estimate(tests, {}, reason)


def check_runs(values: Array) -> Test:
    """Runs above and below the median, two-sided; values equal to the median are excluded."""
    median = float(np.median(values))
    above = values[values != median] > median
    n1, n2 = int(above.sum()), int((~above).sum())
    name = "runs test"
    if min(n1, n2) < 10:
        return Test(name, 0.0, P_MIN, False, f"runs test: only {n1} values above and {n2} below the median")
    runs = 1 + int((above[1:] != above[:-1]).sum())
    mean = 1.0 + 2.0 * n1 * n2 / (n1 + n2)
    z = (runs - mean) / math.sqrt((mean - 1.0) * (mean - 2.0) / (n1 + n2 - 1.0))
    p = math.erfc(abs(z) / math.sqrt(2.0))
    return Test(name, z, P_MIN, p >= P_MIN, f"runs test: z = {z:.2f}, p = {p:.2g}, needed p >= {P_MIN:g}")


def check_correlation(values: Array) -> Test:
    """Ljung-Box over LAGS lags, applied to ranks, because one outlier in raw times would hide every correlation."""
    _, inverse, counts = np.unique(values, return_inverse=True, return_counts=True)
    last = np.cumsum(counts)
    ranks = (last - (counts - 1) / 2.0)[inverse]
    centred = ranks - ranks.mean()
    n, power = len(centred), float(centred @ centred)
    shares = [float(centred[lag:] @ centred[:-lag]) / power for lag in range(1, LAGS + 1)] if power else [1.0]
    q = n * (n + 2.0) * sum(share * share / (n - lag) for lag, share in enumerate(shares, start=1))
    p = calc_chi_squared_tail(q, LAGS)
    return Test("Ljung-Box", q, P_MIN, p >= P_MIN, f"Ljung-Box over {LAGS} lags: Q = {q:.1f}, p = {p:.2g}, needed p >= {P_MIN:g}")


def calc_chi_squared_tail(x: float, degrees: int) -> float:
    """P(X > x) for an even number of degrees: exp(-x/2) * sum of (x/2)^i / i!, i < degrees/2 (Abramowitz and Stegun, 26.4.21)."""
    half = x / 2.0
    if half > 700.0:
        return 0.0
    term = total = 1.0
    for i in range(1, degrees // 2):
        term *= half / i
        total += term
    return math.exp(-half) * total


def calc_l_moments(values: Array) -> tuple[float, float, float]:
    """@return the first three sample L-moments."""
    ordered = np.sort(values)
    n = len(ordered)
    i = np.arange(n, dtype=float)
    b0 = float(ordered.mean())
    b1 = float((i / (n - 1.0) * ordered).mean())
    b2 = float((i * (i - 1.0) / ((n - 1.0) * (n - 2.0)) * ordered).mean())
    return b0, 2.0 * b1 - b0, 6.0 * b2 - 6.0 * b1 + b0


def fit_gumbel(maxima: Array) -> tuple[float, float]:
    """@return location and scale, in the unit of `maxima`."""
    l1, l2, _ = calc_l_moments(maxima)
    scale = l2 / math.log(2.0)
    return l1 - EULER * scale, scale


def check_tail(maxima: Array) -> Test:
    """Checks that the tail is not heavier than Gumbel, because the estimate would then be too low. With a lighter tail, it is only too high."""
    _, l2, l3 = calc_l_moments(maxima)
    c = 2.0 / (3.0 + l3 / l2) - math.log(2.0) / math.log(3.0)
    shape = 7.8590 * c + 2.9554 * c * c  # negative: heavier than Gumbel
    z = -shape * math.sqrt(len(maxima) / 0.5633)
    return Test("tail shape", z, TAIL_Z_MAX, z <= TAIL_Z_MAX,
                f"tail heavier than Gumbel's: z = {z:.2f} (shape {-shape:.2f}), allowed {TAIL_Z_MAX:g}")  # fmt: skip


def check_fit(maxima: Array, location: float, scale: float) -> Test:
    """Kolmogorov-Smirnov distance of maxima that were not used for the fit."""
    ordered = np.sort(maxima)
    n = len(ordered)
    model = np.exp(-np.exp(np.clip(-(ordered - location) / scale, -700.0, 700.0)))
    i = np.arange(n)
    distance = float(max((model - i / n).max(), ((i + 1) / n - model).max()))
    limit = 1.358 / (math.sqrt(n) + 0.12 + 0.11 / math.sqrt(n))
    return Test("Kolmogorov-Smirnov", distance, limit, distance <= limit,
                f"Kolmogorov-Smirnov on {n} held-out maxima: D = {distance:.3f}, allowed {limit:.3f}")  # fmt: skip
