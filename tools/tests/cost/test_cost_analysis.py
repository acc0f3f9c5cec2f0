# SPDX-License-Identifier: Apache-2.0
# Goal: figures, ratio and limits agree with the steps, and limits that are too low are named. Method: runs with given counts and times.
from __future__ import annotations

from pathlib import Path

import pytest
from cost_run import NS_PER_INSTRUCTION, load_table, make_class, make_run
from timing_run import COMPONENTS, WINDOWS, make_table

from mamori_tools.cost.analysis import Count, find_pace, list_findings, list_limits, list_ratios, list_steps
from mamori_tools.cost.run import ClassRun
from mamori_tools.table.document import Table

OTHER = make_class("other", cycles=40, first=4, every=9)


@pytest.fixture
def table(tmp_path: Path) -> Table:
    return load_table(tmp_path)


@pytest.mark.verifies("SWR-TIM-032")
def test_counts_are_shown_per_class_component_and_pass_with_the_cycle_of_the_greatest(table: Table) -> None:
    runs = [make_run(table), make_run(table, OTHER)]
    rows = list_steps(runs, find_pace(list_ratios(runs), runs))

    assert [(row.input_class, row.component) for row in rows[:5]] == [
        ("still", "reader"), ("still", "monitor"), ("still", "controller"), ("still", "drive"), ("other", "reader")]  # fmt: skip
    assert rows[0].instructions == Count(4, 500, 500, 510, 11)
    assert rows[1].instructions == Count(4, 2000, 2000, 2300, 12)
    assert rows[6].instructions == Count(4, 9000, 9000, 12_000, 31)
    assert {row.pass_name for row in rows} == {"execute"}
    assert rows[2].time_ns == 12_000 * 2.0


@pytest.mark.verifies("SWR-TIM-032")
def test_passes_of_a_component_are_kept_apart(table: Table) -> None:
    run = make_run(table)
    run.steps["pass"][4] = 1
    rows = list_steps([run], find_pace(list_ratios([run]), [run]))

    assert [(row.component, row.pass_name, row.instructions.count) for row in rows[:2]] == [("reader", "execute", 3), ("reader", "state update", 1)]


@pytest.mark.verifies("SWR-TIM-033")
def test_greatest_median_of_a_component_is_the_ratio(table: Table) -> None:
    runs = [make_run(table), make_run(table, OTHER)]
    ratios = list_ratios(runs)
    pace = find_pace(ratios, runs)

    assert [(row.component, row.openings) for row in ratios] == [("reader", 8), ("monitor", 8), ("controller", 8), ("drive", 8)]
    assert [row.median_ns for row in ratios] == pytest.approx(list(NS_PER_INSTRUCTION.values()), rel=0.01)
    assert (pace.component, pace.ns_per_instruction) == ("drive", 2.0)
    assert pace.least_ns == pytest.approx(0.25)
    assert pace.reference_ns == (2520 - 20) / 10_000


@pytest.mark.verifies("SWR-TIM-033")
def test_one_slow_opening_is_spread_and_no_ratio(table: Table) -> None:
    run = make_run(table)
    run.times_ns[3] = 900
    drive = list_ratios([run])[3]

    assert (drive.median_ns, drive.p99_ns) == (2.0, 9.0)


@pytest.mark.verifies("SWR-TIM-033", technique="boundary_values", polarity="violation")
def test_step_without_instructions_of_its_own_has_a_ratio(table: Table) -> None:
    run = make_run(table, counts={3: (0, 0, 0, 0)})
    assert list_ratios([run])[0].median_ns == 0.0


def judge(runs: list[ClassRun], margin_percent: float = 0.0) -> tuple[list[str], dict[str, float]]:
    """@return findings, and the margin of each limit [ns]."""
    ratios = list_ratios(runs)
    limits = list_limits(runs, find_pace(ratios, runs), margin_percent)
    return list_findings(limits, runs, ratios, margin_percent), {f"{row.what} {row.name}": row.left_ns for row in limits}


@pytest.mark.verifies("SWR-TIM-035")
def test_limits_are_held_against_the_greatest_sum_of_one_opening(table: Table) -> None:
    findings, left = judge([make_run(table)], 50.0)

    assert findings == []
    # Window sense: reader and monitor of cycle 12, 500 + 2300; their own maxima are in different cycles.
    assert left == {"window sense": 250_000 - 2800 * 3.0, "window control": 350_000 - 12_000 * 3.0, "window act": 80_000 - 100 * 3.0,
                    "component reader": 40_000 - 510 * 3.0, "component monitor": 60_000 - 2300 * 3.0,
                    "component controller": 200_000 - 12_000 * 3.0}  # fmt: skip


@pytest.mark.verifies("SWR-TIM-035", technique="boundary_values", polarity="violation")
def test_budget_below_the_greatest_and_its_margin_is_a_finding_that_says_what_to_do(tmp_path: Path) -> None:
    def judge_budget(budget_us: int) -> list[str]:
        windows = (WINDOWS[0], ("control", 0, 300, 400, 1000, budget_us), WINDOWS[2])
        table = load_table(tmp_path, make_table(windows, tuple((*row[:2], None, row[3]) for row in COMPONENTS)))
        return judge([make_run(table), make_run(table, OTHER, {2: (12_001,) * 4, 3: (100,) * 4})], 25.0)[0]

    assert judge_budget(31) == []  # 12,001 instructions of 2 ns and a quarter are 30.0025 us
    assert judge_budget(30) == [
        "window 'control': budget 30 us, but 12001 instructions (class 'other', cycle 4, most of them by 'controller') take 24 us, with 25 % "
        "margin 30 us; raise the budget, or make 'controller' cheaper"]  # fmt: skip


@pytest.mark.verifies("SWR-TIM-035", polarity="violation")
def test_declared_worst_case_below_the_greatest_is_a_finding(tmp_path: Path) -> None:
    components = (("reader", 0, 1, 10), *COMPONENTS[1:])
    findings, _ = judge([make_run(load_table(tmp_path, make_table(components=components)))])

    assert findings == ["component 'reader': declared worst case 1 us, but 510 instructions (class 'still', cycle 11, most of them by 'reader') "
                        "take 1.02 us, with 0 % margin 1.02 us; declare more, or make 'reader' cheaper"]  # fmt: skip


@pytest.mark.parametrize("greatest_ns", [0, 1])
@pytest.mark.verifies("SWR-TIM-033", technique="boundary_values", polarity="violation")
def test_run_in_which_no_step_took_any_time_is_a_finding(table: Table, greatest_ns: int) -> None:
    run = make_run(table)
    run.times_ns[:] = greatest_ns * (run.steps["component"] == 1)
    findings, _ = judge([run])

    assert [line.partition(":")[0] for line in findings] == ([] if greatest_ns else ["ratio"])


@pytest.mark.verifies("SWR-TIM-035", polarity="violation")
def test_component_that_never_ran_is_a_finding(table: Table) -> None:
    findings, left = judge([make_run(table, counts={0: (10, 10, 10, 10)})])

    assert [line.partition(":")[0] for line in findings] == ["component 'monitor'", "component 'controller'", "component 'drive'"]
    assert "declare a class of inputs in which it runs" in findings[0]
    assert set(left) == {"window sense", "component reader"}


@pytest.mark.verifies("SWR-TIM-035")
def test_window_that_opens_several_times_in_a_frame_is_judged_by_opening(tmp_path: Path) -> None:
    table = load_table(tmp_path)
    run = make_run(table)
    run.steps["release_ns"][4] += 500  # the second reader starts alone
    _, left = judge([run])

    assert left["component reader"] == 40_000 - 510 * 2.0
    assert left["window sense"] == 250_000 - 2800 * 2.0


