# SPDX-License-Identifier: Apache-2.0
# Goal: figures, misses and their responsible components equal manually calculated values.
# Method: a run of a few window instances with given instants, one fault at a time.
from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from timing_run import make_run, make_table, write_run

from mamori_tools.timing.analysis import (
    calc_drift,
    calc_execution,
    calc_lateness,
    describe,
    list_components,
    list_drift_notes,
    list_findings,
    list_misses,
    list_windows,
)
from mamori_tools.timing.reader import COMPLETED, MISSED, NOT_BACK, NOT_DUE, OPENING, OVERRUN, STEP, Measurement, read_measurement
from mamori_tools.timing.verdict import COMPONENT, NOT_KNOWN

TABLE = make_table(windows=(("work", 0, 100, 300, 1000, 200),), components=(("first", 0, 50, 0), ("second", 0, None, 0)),
                   connections=((0, 1, "same_window"),))  # fmt: skip
US = 1000


Instants = tuple[int, int, int, float, float | None]
"""Frame, component, pass, start and end [us]; None for a missing end."""


class Rows:
    """A run of four window instances in frames 1 .. 4, each late by 10 us, with two steps of 30 us and 40 us. One table of instants [us],
    counted from the release."""

    def __init__(self) -> None:
        self.openings = [[10, 90, COMPLETED] for _ in range(4)]
        self.steps: list[list[Instants]] = [[(frame, 0, 0, 12, 42), (frame, 1, 0, 43, 83)] for frame in range(4)]

    def read(self, folder: Path) -> Measurement:
        openings = np.zeros(4, OPENING)
        for frame, (woke, closed, outcome) in enumerate(self.openings):
            release = (1000 * (frame + 1) + 100) * US
            openings[frame] = (release, release + woke * US, release + closed * US, 0, outcome)
        rows = [row for step in self.steps for row in step]
        steps = np.zeros(len(rows), STEP)
        for index, (frame, component, step_pass, start, end) in enumerate(rows):
            release = (1000 * (frame + 1) + 100) * US
            steps[index] = (release, release + int(start * US), NOT_BACK if end is None else release + int(end * US), component, step_pass)
        return read_measurement(write_run(folder, TABLE, openings, steps, make_run(TABLE, 4, 4)))


@pytest.fixture
def rows() -> Rows:
    return Rows()


@pytest.mark.verifies("SWR-TIM-012", technique="boundary_values")
@pytest.mark.parametrize(("count", "p50", "p99", "p999"), [(1, 1, 1, 1), (2, 1, 2, 2), (100, 50, 99, 100), (101, 51, 100, 101),
                                                           (1000, 500, 990, 999), (1001, 501, 991, 1000)])  # fmt: skip
def test_quantile_is_the_least_value_that_its_share_does_not_exceed(count: int, p50: int, p99: int, p999: int) -> None:
    found = describe(np.random.default_rng(1).permutation(np.arange(1, count + 1)))

    assert found is not None
    assert (found.count, found.min, found.p50, found.p99, found.p999, found.max) == (count, 1, p50, p99, p999, count)


@pytest.mark.verifies("SWR-TIM-012", technique="boundary_values", polarity="violation")
def test_nothing_measured_has_no_distribution() -> None:
    assert describe(np.zeros(0, np.int64)) is None


@pytest.mark.verifies("SWR-TIM-012")
def test_execution_time_is_the_sum_of_the_steps_of_an_opening(rows: Rows, tmp_path: Path) -> None:
    rows.steps[2].append((2, 0, 1, 84, 89))

    series, unfinished = calc_execution(rows.read(tmp_path), 0)

    assert series.values.tolist() == [30 * US, 30 * US, 35 * US, 30 * US]
    assert series.releases.tolist() == [1100 * US, 2100 * US, 3100 * US, 4100 * US]
    assert unfinished == 0


@pytest.mark.verifies("SWR-TIM-012", technique="error_guessing", polarity="violation")
def test_step_that_never_came_back_has_no_time_and_is_counted(rows: Rows, tmp_path: Path) -> None:
    rows.steps[3][1] = (3, 1, 0, 43, None)

    series, unfinished = calc_execution(rows.read(tmp_path), 1)

    assert (len(series.values), unfinished) == (3, 1)


@pytest.mark.verifies("SWR-TIM-012", technique="equivalence_classes")
def test_opening_that_was_not_due_is_not_late(rows: Rows, tmp_path: Path) -> None:
    rows.openings[0] = [80, 80, NOT_DUE]
    rows.openings[1] = [350, 350, MISSED]
    rows.steps[0] = rows.steps[1] = []

    run = rows.read(tmp_path)

    assert calc_lateness(run, 0).values.tolist() == [350 * US, 10 * US, 10 * US]
    assert list_windows(run)[0].outcomes == {"completed": 2, "overrun": 0, "missed": 1, "stopped": 0, "not due": 1}


@pytest.mark.verifies("SWR-TIM-013")
def test_schedulability_shows_plan_measurement_and_margins(rows: Rows, tmp_path: Path) -> None:
    rows.openings[1] = [20, 95, COMPLETED]

    run = rows.read(tmp_path)
    window, (first, second) = list_windows(run)[0], list_components(run)

    assert (window.offset_ns, window.length_ns, window.budget_ns) == (100 * US, 300 * US, 200 * US)
    assert window.response is not None and window.response.max == 95 * US
    assert (window.length_margin_ns, window.used_max_ns, window.budget_margin_ns) == (205 * US, 80 * US, 120 * US)
    assert (first.declared_ns, first.margin_ns) == (50 * US, 20 * US)
    assert (second.declared_ns, second.margin_ns) == (None, None)


@pytest.mark.verifies("SWR-TIM-013", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("end_us", "count"), [(62, 0), (62.001, 1)])
def test_declared_worst_case_below_the_measured_maximum_is_a_finding(rows: Rows, tmp_path: Path, end_us: float, count: int) -> None:
    rows.steps[1][0] = (1, 0, 0, 12, end_us)
    rows.steps[1][1] = (1, 1, 0, 63, 83)

    run = rows.read(tmp_path)
    findings = list_findings(list_windows(run), list_components(run), list_misses(run))

    assert len(findings) == count
    assert not count or findings == ["component 'first': declared worst case 50 us, measured 50.001 us"]


@pytest.mark.verifies("SWR-TIM-014", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("end", "guilty", "said"), [(211, "first", "returned 1.0 us after the deadline"), (None, "first", "never returned")])
def test_component_that_is_not_back_at_the_deadline_is_guilty(rows: Rows, tmp_path: Path, end: int | None, guilty: str, said: str) -> None:
    rows.openings[2] = [10, 211, OVERRUN]
    rows.steps[2] = [(2, 0, 0, 12, end)]
    rows.openings[3] = [10, 211, OVERRUN] if end is None else rows.openings[3]
    rows.steps[3] = [] if end is None else rows.steps[3]

    misses = list_misses(rows.read(tmp_path))

    assert (misses[0].cycle, misses[0].window, misses[0].outcome, misses[0].component, misses[0].late_ns) == (3, "work", "overrun", guilty, 10 * US)
    assert misses[0].reason == said
    if end is None:  # the work still hangs; the next window instance states the start of the hang
        assert (misses[1].cycle, misses[1].component, misses[1].reason) == (4, "first", "never returned; it began in cycle 3")


@pytest.mark.verifies("SWR-TIM-014", technique="boundary_values")
def test_step_that_ends_on_the_deadline_is_not_the_guilty_one(rows: Rows, tmp_path: Path) -> None:
    rows.openings[2] = [10, 215, OVERRUN]
    rows.steps[2] = [(2, 0, 0, 12, 210), (2, 1, 0, 210, 214)]

    assert list_misses(rows.read(tmp_path))[0].component == "second"


@pytest.mark.verifies("SWR-TIM-014", technique="error_guessing")
@pytest.mark.parametrize(("end", "verdict"), [(450, NOT_KNOWN), (451, COMPONENT), (None, COMPONENT)])
def test_deadline_of_a_late_window_is_its_planned_close(rows: Rows, tmp_path: Path, end: int | None, verdict: str) -> None:
    rows.openings[2] = [250, 301, OVERRUN]  # the complete budget would have lasted until 450 us
    rows.steps[2] = [(2, 0, 0, 252, 290), (2, 1, 0, 291, end)]
    rows.steps[3] = [] if end is None else rows.steps[3]

    run = rows.read(tmp_path)
    miss = list_misses(run)[0]

    assert (miss.component, miss.verdict) == ("second", verdict)
    assert ("which was 150.0 us early: the window started late" in miss.reason) == (verdict == NOT_KNOWN)
    assert bool(list_findings(list_windows(run), [], [miss])) == (verdict == COMPONENT)


@pytest.mark.verifies("SWR-TIM-014", technique="error_guessing")
def test_component_that_had_not_begun_is_named_when_no_step_was_late(rows: Rows, tmp_path: Path) -> None:
    rows.openings[2] = [10, 211, OVERRUN]
    rows.steps[2] = [(2, 0, 0, 12, 42)]

    miss = list_misses(rows.read(tmp_path))[0]

    assert miss.verdict == NOT_KNOWN
    assert (miss.component, miss.reason) == ("second", "had not begun at the deadline: its thread did not get the processor")


@pytest.mark.verifies("SWR-TIM-014", technique="error_guessing")
def test_nobody_is_named_when_all_steps_were_in_time(rows: Rows, tmp_path: Path) -> None:
    rows.openings[2] = [10, 211, OVERRUN]

    miss = list_misses(rows.read(tmp_path))[0]

    assert (miss.component, miss.verdict) == (None, NOT_KNOWN)


@pytest.mark.verifies("SWR-TIM-014", polarity="violation")
def test_missed_opening_blames_nobody_and_is_no_finding(rows: Rows, tmp_path: Path) -> None:
    rows.openings[2] = [301, 301, MISSED]
    rows.steps[2] = []

    run = rows.read(tmp_path)
    misses = list_misses(run)

    assert [(one.cycle, one.outcome, one.component, one.late_ns) for one in misses] == [(3, "missed", None, 301 * US)]
    assert list_findings(list_windows(run), list_components(run), misses) == []


@pytest.mark.verifies("SWR-TIM-014", polarity="violation")
def test_overrun_is_a_finding_with_cycle_and_component(rows: Rows, tmp_path: Path) -> None:
    rows.openings[2] = [10, 211, OVERRUN]
    rows.steps[2] = [(2, 0, 0, 12, 42), (2, 1, 0, 43, 260)]

    run = rows.read(tmp_path)
    found = list_findings(list_windows(run), list_components(run), list_misses(run))

    assert found == ["window 'work': 1 overran, first in cycle 3 by 'second', which returned 50.0 us after the deadline"]


def read_drifting(folder: Path, planned_ns: int = 0, late_ns: int = 0, count: int = 1000, missing: int | None = None) -> Measurement:
    """Instances whose planned instant is off by `planned_ns`, and whose lateness grows by `late_ns` in each frame."""
    openings = np.zeros(count, OPENING)
    frames = np.arange(count)
    openings["release_ns"] = (1000 * (frames + 1) + 100) * US + frames * planned_ns
    openings["woke_ns"] = openings["closed_ns"] = openings["release_ns"] + 5 * US + frames * late_ns
    openings = openings if missing is None else np.delete(openings, missing)
    return read_measurement(write_run(folder, TABLE, openings, np.zeros(0, STEP), make_run(TABLE, count, count)))


@pytest.mark.verifies("SWR-TIM-040")
def test_run_on_the_schedule_with_constant_lateness_has_no_drift(tmp_path: Path) -> None:
    run = read_drifting(tmp_path)

    drift = calc_drift(run, 0)
    assert (drift.planned_ns, drift.first_ns, drift.last_ns, drift.shift_ns) == (0, 5 * US, 5 * US, 0)
    assert list_findings(list_windows(run), [], []) == []


@pytest.mark.verifies("SWR-TIM-040", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(("changes", "planned_us"), [({"planned_ns": 1}, 0.999), ({"planned_ns": -1}, 0.999), ({"missing": 500}, 1000)])
def test_planned_instant_off_the_schedule_is_a_finding(tmp_path: Path, changes: dict[str, int], planned_us: float) -> None:
    found = list_findings(list_windows(read_drifting(tmp_path, **changes)), [], [])

    assert found == [f"window 'work': planned instants are up to {planned_us:g} us off the schedule"]


@pytest.mark.verifies("SWR-TIM-040", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("shift_ns", "count"), [(100_000, 0), (100_001, 1)])
def test_median_lateness_that_changes_by_more_than_a_tenth_of_the_period_is_a_note(tmp_path: Path, sign: int, shift_ns: int, count: int
                                                                                   ) -> None:  # fmt: skip
    window = list_windows(read_drifting(tmp_path))[0]
    changed = replace(window, drift=replace(window.drift, first_ns=200_000, last_ns=200_000 + sign * shift_ns))

    assert len(list_drift_notes([changed])) == count
    assert list_findings([changed], [], []) == []


@pytest.mark.verifies("SWR-TIM-040", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("count", "shift_ns"), [(990, None), (991, 891 * 150)])
def test_change_of_lateness_needs_a_hundred_values_in_each_tenth(tmp_path: Path, count: int, shift_ns: int | None) -> None:
    run = read_drifting(tmp_path, late_ns=150, count=count)

    assert calc_drift(run, 0).shift_ns == shift_ns
    assert bool(list_drift_notes(list_windows(run))) == (shift_ns is not None)
