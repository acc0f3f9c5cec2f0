# SPDX-License-Identifier: Apache-2.0
# Goal: the effect of requests from outside is the median of the differences within the rounds; an effect of 1 % of the major frame is a
# finding.
# Method: runs whose starts in the blocks with requests are shifted, on both sides of each limit.
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from timing_run import OPENING, make_run, make_table, write_run

from mamori_tools.timing.reader import STEP, Measurement, read_measurement
from mamori_tools.timing.request_shift import ShiftRow, check_requests, list_shift_findings, list_shifts
from mamori_trace.base.errors import InputError

TABLE = make_table(windows=(("work", 0, 100, 300, 1000, 200),), components=(("only", 0, None, 0),), connections=())
PACES = (0, 0, 1, 2, 1, 2, 0, 2, 0, 1)
BLOCK = 20
PLANNED = 6 * BLOCK  # requests in the pace of one per millisecond
START_NS = (50_000, 90_000, 30_000)  # in each round
STEADY_NS = (2_000, 1_000, -1_000)
BURST_NS = (0, 5_000, 30_000)


def read(folder: Path, steady_ns: tuple[int, ...] = STEADY_NS, burst_ns: tuple[int, ...] = BURST_NS, count: int = PLANNED, idle: int = -1,
         frames: int = len(PACES) * BLOCK) -> Measurement:  # fmt: skip
    """`idle`: a block in which the component did not run."""
    openings, steps = np.zeros(frames, OPENING), np.zeros(frames, STEP)
    block = np.arange(frames) // BLOCK
    shifts = np.array([(0, steady, burst) for steady, burst in zip(steady_ns, burst_ns, strict=True)])
    start = np.array(START_NS)[np.maximum(block - 1, 0) // 3] + shifts[np.maximum(block - 1, 0) // 3, np.array(PACES)[block]]
    openings["release_ns"] = steps["release_ns"] = np.arange(frames) * 1_000_000 + 100_000
    openings["woke_ns"] = openings["closed_ns"] = openings["release_ns"] + 200_000
    steps["start_ns"] = steps["end_ns"] = steps["release_ns"] + start
    run = {**make_run(TABLE, frames, frames), "requests": {"block_cycles": BLOCK, "count": count, "paces": list(PACES)}}
    return read_measurement(write_run(folder, TABLE, openings, steps[block != idle], run))


def get_shifts(row: ShiftRow) -> tuple[int, ...]:
    assert row.start is not None and row.steady is not None and row.burst is not None
    return row.start.p50, row.steady.p50, row.steady.min, row.steady.max, row.burst.p50, row.start.count


@pytest.mark.verifies("SWR-PRT-039")
def test_shift_is_the_median_of_the_differences_within_the_rounds(tmp_path: Path) -> None:
    run = read(tmp_path)
    (row,) = list_shifts(run)

    assert get_shifts(row) == (50_000, 1_000, -1_000, 2_000, 5_000, 3)
    assert list_shift_findings(run, [row]) == []


@pytest.mark.verifies("SWR-PRT-039", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("shift_ns", "count"), [(9_999, 0), (10_000, 2)])
def test_shift_of_one_percent_of_the_frame_is_a_finding(tmp_path: Path, sign: int, shift_ns: int, count: int) -> None:
    run = read(tmp_path, steady_ns=(sign * shift_ns,) * 3, burst_ns=(0, sign * shift_ns, sign * 20_000))
    found = list_shift_findings(run, list_shifts(run))

    assert len(found) == count
    assert not count or found[0] == f"window 'work': requests (steady) shift the median start by {sign * 10} us, limit 10 us"


@pytest.mark.verifies("SWR-PRT-039", technique="error_guessing")
def test_only_complete_rounds_in_which_the_window_ran_count(tmp_path: Path) -> None:
    assert get_shifts(list_shifts(read(tmp_path, idle=3))[0]) == (30_000, -1_000, -1_000, 1_000, 5_000, 2)
    assert get_shifts(list_shifts(read(tmp_path, frames=len(PACES) * BLOCK - 1))[0])[-1] == 2
    assert list_shifts(read(tmp_path, frames=4 * BLOCK - 1))[0].start is None


@pytest.mark.verifies("SWR-PRT-039", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("made", "count"), [(PLANNED // 2, 0), (PLANNED // 2 - 1, 1)])
def test_run_without_most_of_its_requests_is_a_finding(tmp_path: Path, made: int, count: int) -> None:
    run = read(tmp_path, count=made)

    assert len(list_shift_findings(run, list_shifts(run))) == count


@pytest.mark.verifies("SWR-TIM-022", technique="boundary_values", polarity="violation")
def test_too_few_cycles_for_a_round_are_rejected(tmp_path: Path) -> None:
    check_requests(read(tmp_path), 4 * BLOCK)

    with pytest.raises(InputError, match=f"at least {4 * BLOCK} cycles"):
        check_requests(read(tmp_path), 4 * BLOCK - 1)
