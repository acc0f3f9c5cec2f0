# SPDX-License-Identifier: Apache-2.0
# Goal: an extreme-value estimate is given for each series that permits one; every other series is rejected with a reason.
# Method: seeded series of known kind; single tests compared with values from the literature.
from __future__ import annotations

import numpy as np
import pytest

from mamori_tools.timing.evt import (
    BLOCK,
    BLOCKS_MIN,
    BLOCKS_WANTED,
    calc_chi_squared_tail,
    calc_l_moments,
    check_correlation,
    check_fit,
    check_runs,
    check_tail,
    estimate,
    fit_gumbel,
)

N = 20_000


def draw(seed: int = 7, count: int = N) -> np.ndarray:
    return np.random.default_rng(seed).gumbel(50_000.0, 2_000.0, count).astype(np.int64)


@pytest.mark.verifies("SWR-TIM-018")
def test_independent_series_gets_an_estimate_near_the_true_quantile() -> None:
    found = estimate(draw())

    assert not found.refusal
    assert [test.name for test in found.tests] == ["runs test", "Ljung-Box", "tail shape", "Kolmogorov-Smirnov"]
    for p, value in found.quantiles_ns.items():
        assert value == pytest.approx(50_000 - 2_000 * np.log(p), rel=0.1)


@pytest.mark.verifies("SWR-TIM-018", technique="equivalence_classes")
def test_most_independent_series_are_accepted() -> None:
    assert sum(not estimate(draw(seed)).refusal for seed in range(20)) >= 12  # four tests at 5 %, the last one stricter


@pytest.mark.verifies("SWR-TIM-018", polarity="violation")
def test_dependent_series_is_refused_with_the_statistic() -> None:
    noise = draw()
    found = estimate(noise[1:] + noise[:-1])

    assert found.quantiles_ns == {}
    assert found.refusal.startswith("the window instances are not independent: runs test: z = -")
    assert "Ljung-Box over 20 lags: Q = " in found.refusal


@pytest.mark.verifies("SWR-TIM-018", technique="error_guessing", polarity="violation")
def test_series_with_a_trend_or_a_period_is_refused() -> None:
    for series in (draw() + np.arange(N) // 10, draw() + 2_000 * (np.arange(N) % 10)):
        assert "not independent" in estimate(series).refusal


@pytest.mark.verifies("SWR-TIM-018", polarity="violation")
def test_heavy_tail_is_refused_with_the_statistic() -> None:
    found = estimate((1000.0 * np.random.default_rng(5).pareto(1.5, N) + 1000.0).astype(np.int64))

    assert "the tail does not fit the model: tail heavier than Gumbel's: z = " in found.refusal


@pytest.mark.verifies("SWR-TIM-018", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("count", "is_refused"), [(0, True), (BLOCK * BLOCKS_MIN - 1, True), (BLOCK * BLOCKS_MIN, False)])
def test_few_values_are_refused(count: int, is_refused: bool) -> None:
    assert ("too few, at least 2000 are needed" in estimate(draw(count=count)).refusal) == is_refused


@pytest.mark.verifies("SWR-TIM-018", technique="error_guessing", polarity="violation")
def test_constant_and_coarse_series_are_refused() -> None:
    for series in (np.full(N, 1000), draw() // 10_000 * 10_000):
        assert "different values" in estimate(series).refusal


@pytest.mark.verifies("SWR-TIM-018", technique="back_to_back")
@pytest.mark.parametrize(("x", "degrees", "p"), [(31.410, 20, 0.05), (37.566, 20, 0.01), (5.991, 2, 0.05), (0.0, 20, 1.0), (1e6, 20, 0.0)])
def test_tail_of_chi_squared_is_that_of_the_tables(x: float, degrees: int, p: float) -> None:
    assert calc_chi_squared_tail(x, degrees) == pytest.approx(p, abs=2e-5)


@pytest.mark.verifies("SWR-TIM-018", technique="back_to_back")
def test_runs_are_counted_as_in_a_worked_example() -> None:
    # 40 values around their median in 20 pairs: 20 runs, mean 21, variance 20 * 19 / 39.
    found = check_runs(np.tile([1, 1, 9, 9], 10))

    assert found.statistic == pytest.approx((20 - 21) / np.sqrt(20 * 19 / 39))


@pytest.mark.verifies("SWR-TIM-018", technique="back_to_back")
def test_l_moments_are_those_of_a_worked_example() -> None:
    # Calculated from all subsamples of {1, 2, 4}: mean 7/3, half of the mean difference 1, third 1/3 (x3 - 2 x2 + x1).
    assert calc_l_moments(np.array([4.0, 1.0, 2.0])) == pytest.approx((7 / 3, 1.0, 1 / 3))


@pytest.mark.verifies("SWR-TIM-018", technique="back_to_back")
def test_fit_finds_location_and_scale() -> None:
    assert fit_gumbel(draw(count=200_000).astype(float)) == pytest.approx((50_000, 2_000), rel=0.01)


@pytest.mark.verifies("SWR-TIM-018", technique="boundary_values", polarity="violation")
def test_single_tests_fail_where_they_should() -> None:
    maxima = draw(count=100).astype(float)

    assert check_fit(maxima, 50_000.0, 2_000.0).is_passed
    assert not check_fit(maxima, 52_000.0, 2_000.0).is_passed
    assert check_tail(maxima).is_passed
    assert not check_tail(np.exp(maxima / 3_000.0)).is_passed
    assert not check_runs(np.ones(100)).is_passed
    assert not check_correlation(np.arange(1000)).is_passed


@pytest.mark.verifies("SWR-TIM-018", technique="boundary_values", polarity="violation")
def test_openings_that_were_cut_off_are_the_longest_and_forbid_an_estimate() -> None:
    assert estimate(draw(), 1).refusal.startswith("1 window instances were aborted")


@pytest.mark.verifies("SWR-TIM-018", technique="error_guessing", polarity="violation")
def test_fitted_maxima_that_are_all_equal_are_refused() -> None:
    values = draw()
    block = max(BLOCK, len(values) // BLOCKS_WANTED)
    for first in range(0, len(values), 2 * block):
        values[first : first + block] = np.minimum(values[first : first + block], 50_000)
        values[first] = 50_000

    assert "have 1 different values" in estimate(values).refusal
