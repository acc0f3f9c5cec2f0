# SPDX-License-Identifier: Apache-2.0
"""Goal: each injected fault has its declared report or reaction in time, and no other report or reaction occurs. Method: one short
real-time run of each campaign, whose course the evaluator assesses. Inconclusive runs are repeated. Longer runs: `python -P -m
verification.faults`."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from mamori_tools.host.project import SANITIZED, Project
from verification.faults.evaluation.evaluator import Result
from verification.faults.reporting import record_finding
from verification.faults.run import CAMPAIGNS, run_short

SEED = 20261122

Report = Callable[[str, str], Result]


@cache
def get_result(campaign: str, build: Path) -> tuple[Result, int]:
    """All tests of a campaign share one run."""
    return run_short(CAMPAIGNS[campaign], build, SEED)


@pytest.fixture
def report(project: Project, request: pytest.FixtureRequest) -> Report:
    """Reports the finding of one part of a campaign as the result of the test."""

    def report_part(campaign: str, part: str) -> Result:
        result, repeats = get_result(campaign, project.build)
        request.node.user_properties += [("seed", SEED), ("repetitions", repeats)]
        record_finding(request.node.user_properties, result, part, is_timed=project.preset != SANITIZED)
        return result

    return report_part


@pytest.mark.verifies("SWR-PRT-022", technique="fault_injection", polarity="violation")
def test_outputs_are_closed_in_time_after_each_loss_and_not_before(report: Report) -> None:
    assert report("service", "outputs").facts["requested"] == 60


@pytest.mark.verifies("SWR-PRT-007", technique="fault_injection", polarity="violation")
def test_each_fault_of_time_is_reported_in_a_frame_under_its_name_and_no_other(report: Report) -> None:
    assert report("time", "reports").facts["frames"] == 4000


@pytest.mark.verifies("SWR-PRT-034", technique="fault_injection", polarity="violation")
def test_each_hang_of_the_runner_and_each_wrong_clock_is_found_within_its_bound_and_no_other(report: Report) -> None:
    report("time", "watch")


@pytest.mark.verifies("SWR-PRT-035", technique="fault_injection", polarity="violation")
def test_a_component_that_waits_for_a_thread_without_priority_is_aborted_and_named(report: Report) -> None:
    report("time", "lock")


@pytest.mark.verifies("SWR-PRT-036", technique="fault_injection", polarity="violation")
def test_a_reader_that_is_stopped_within_a_request_delays_no_window(report: Report) -> None:
    report("time", "reader")


@pytest.mark.verifies("SWR-PRT-037", technique="fault_injection", polarity="violation")
def test_a_process_that_faults_pages_causes_none_in_the_windows(report: Report) -> None:
    if not report("time", "pages").facts["has_locked_memory"]:
        pytest.skip("verdict=no-privilege: the host does not let this process lock its memory")


@pytest.mark.verifies("SWR-PRT-018", technique="fault_injection", polarity="violation")
def test_no_window_moves_and_each_fault_of_a_partition_ends_in_its_reaction_in_time(report: Report) -> None:
    report("partition", "system")
