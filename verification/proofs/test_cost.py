# SPDX-License-Identifier: Apache-2.0
# Goal: step counts are exact, and each measured time belongs to its count. Method: callgrind over a program with known instruction counts
# (tools/probe/timing/tests/cost_subject.cpp). A program whose real-time run takes other steps must be detected.
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mamori_tools.cost.analysis import find_pace, list_ratios, list_steps
from mamori_tools.cost.classes import InputClass
from mamori_tools.cost.run import ClassRun, run_class
from mamori_tools.host.project import Project
from mamori_tools.timing.system import System
from mamori_trace.base.errors import WorkError

CYCLES = 40
LINEAR, CONSTANT, HEAVY = range(3)
HEAVY_ROUNDS = 20_000 - 1
EXECUTE = 0
LEAST_ROUND_NS = 0.1
"""One taken branch each 0.1 ns would be one per cycle at 10 GHz."""


@pytest.fixture(scope="module")
def system(project: Project) -> System:
    program = project.build / "tools" / "probe" / "timing" / "mamori_cost_subject"
    assert program.exists(), f"{program} is missing; run ./mamori build"
    return System("cost_subject", program)


def count(system: System, folder: Path, first: int = 0, every: int = 1, words: tuple[str, ...] = ()) -> ClassRun:
    one = InputClass("known", CYCLES, first, every, words, words)
    return run_class(system, one, folder / "program.log", lambda text: None)


def pick(run: ClassRun, component: int) -> list[int]:
    """Instructions of on_execute, cycle by cycle."""
    chosen: list[int] = run.instructions[(run.steps["component"] == component) & (run.steps["pass"] == EXECUTE)].tolist()
    return chosen


@pytest.fixture(scope="module")
def whole(system: System, tmp_path_factory: pytest.TempPathFactory) -> ClassRun:
    return count(system, tmp_path_factory.mktemp("cost"))


@pytest.mark.verifies("SWR-TIM-032")
def test_one_round_more_is_the_same_number_of_instructions_more_each_time(whole: ClassRun) -> None:
    counts = pick(whole, LINEAR)

    assert len(counts) == CYCLES
    assert len(set(np.diff(counts).tolist())) == 1 and counts[1] > counts[0]


@pytest.mark.verifies("SWR-TIM-032")
def test_step_that_does_the_same_has_the_same_count(whole: ClassRun) -> None:
    assert len(set(pick(whole, CONSTANT))) == 1


@pytest.mark.verifies("SWR-TIM-032")
def test_greatest_step_is_found_in_its_cycle_and_is_the_known_number_of_rounds_more(whole: ClassRun) -> None:
    rows = list_steps([whole], find_pace(list_ratios([whole]), [whole]))
    heavy = next(row.instructions for row in rows if row.component == "heavy" and row.pass_name == "execute")

    assert heavy.cycle == 7
    assert heavy.min == heavy.median
    assert (heavy.max - heavy.min) % HEAVY_ROUNDS == 0 and heavy.max > heavy.min


@pytest.mark.verifies("SWR-TIM-032", technique="back_to_back")
def test_counts_are_the_same_again(system: System, whole: ClassRun, tmp_path: Path) -> None:
    again = count(system, tmp_path)

    assert np.array_equal(again.instructions, whole.instructions)
    assert again.reference_instructions == whole.reference_instructions


@pytest.mark.verifies("SWR-TIM-032", technique="back_to_back")
def test_counting_fewer_frames_changes_no_count(system: System, whole: ClassRun, tmp_path: Path) -> None:
    few = count(system, tmp_path, first=3, every=4)

    for component in (LINEAR, CONSTANT, HEAVY):
        assert pick(few, component) == pick(whole, component)[3::4]


@pytest.mark.verifies("SWR-TIM-033")
def test_each_time_belongs_to_its_count(whole: ClassRun) -> None:
    chosen = (whole.steps["component"] == HEAVY) & (whole.steps["pass"] == EXECUTE)

    # The loop has a minimum time per cycle on any processor, but no maximum, because host disturbances lengthen steps.
    assert whole.times_ns[chosen][7] >= HEAVY_ROUNDS * LEAST_ROUND_NS
    assert [ratio.component for ratio in list_ratios([whole])] == ["linear", "constant", "heavy"]


@pytest.mark.verifies("SWR-TIM-033", technique="fault_injection", polarity="violation")
def test_program_that_does_something_else_by_the_clock_is_found(system: System, tmp_path: Path) -> None:
    with pytest.raises(WorkError, match="under callgrind"):
        count(system, tmp_path, words=("unsteady",))
