# SPDX-License-Identifier: Apache-2.0
"""Goal: a run fails only on exact evidence, passes only without doubt, and is inconclusive otherwise. Method: handwritten evidence on both
sides of each limit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from verification.faults.evaluation.evaluator import Evaluation, Outcome, Unexpected
from verification.faults.evaluation.host_causes import HostFigures, Spans
from verification.faults.evaluation.run_verdict import Evidence, assess_run


def make_evidence(stalls: int = 0, **counts: int) -> Evidence:
    return change(Evidence(instances=1000, shown=20, requested=20, host=HostFigures(stalls=stalls, longest_stall_ns=345_678)), **counts)


def change(evidence: Evidence, **counts: Any) -> Evidence:
    return replace(evidence, **counts)


@pytest.mark.verifies("SWR-VER-022")
@pytest.mark.parametrize("stalls", [0, 1_000_000])
def test_a_run_without_deviations_passes_however_noisy_the_host_is(stalls: int) -> None:
    finding = assess_run(make_evidence(stalls))

    assert (finding.verdict, finding.reason) == ("passed", "")


@pytest.mark.verifies("SWR-VER-022", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("count", "number", "stalls", "verdict"),
    [
        ("violations", 1, 1_000_000, "failed"),
        ("unexplained", 1, 0, "failed"), ("unexplained", 1, 99, "failed"), ("unexplained", 1, 100, "inconclusive"),
        ("unexplained", 3, 299, "failed"), ("unexplained", 3, 300, "inconclusive"),
        ("suspected", 1, 10, "inconclusive"),
        ("set_aside", 10, 10, "passed"), ("set_aside", 11, 10, "inconclusive"),
        ("shown", 19, 1, "passed"), ("shown", 18, 1, "inconclusive"), ("shown", 18, 0, "failed"),
    ],
)  # fmt: skip
def test_each_deviation_has_its_verdict_on_both_sides_of_its_limit(count: str, number: int, stalls: int, verdict: str) -> None:
    assert assess_run(make_evidence(stalls, **{count: number})).verdict == verdict


@pytest.mark.verifies("SWR-VER-022", technique="fault_injection", polarity="violation")
def test_a_violation_fails_on_any_host() -> None:
    finding = assess_run(make_evidence(1_000_000, violations=1, unexplained=1, suspected=1, set_aside=1000, shown=0))

    assert finding.verdict == "failed"
    assert finding.reason.startswith("1 violations; host: 1000000 stalls, longest 345 us")


@pytest.mark.verifies("SWR-VER-022", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("outcome", "field", "is_shown"),
    [
        (Outcome.IN_TIME, "", True), (Outcome.LATE, "unexplained", True), (Outcome.LATE_SUSPECTED, "suspected", True),
        (Outcome.LATE_BY_HOST, "set_aside", True), (Outcome.EARLY, "violations", True), (Outcome.NOT_DETECTED, "violations", True),
        (Outcome.WRONGLY_NAMED, "violations", True), (Outcome.NOT_INJECTED, "", False), (Outcome.MASKED, "", False),
        (Outcome.ENDED_BY_HOST, "set_aside", False),
    ],
)  # fmt: skip
def test_each_outcome_belongs_to_one_class_of_evidence(outcome: Outcome, field: str, is_shown: bool) -> None:
    evidence = Evaluation([("kind", outcome)]).make_evidence(HostFigures(), 1, 1)

    assert evidence == change(Evidence(instances=1, requested=1, shown=int(is_shown)), **({field: 1} if field else {}))


@pytest.mark.verifies("SWR-VER-022", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("reason", "field"), [(Unexpected.FALSE, "unexplained"), (Unexpected.SUSPECTED, "suspected"), (Unexpected.BY_HOST, "set_aside")]
)
def test_each_unexpected_report_belongs_to_one_class_of_evidence(reason: Unexpected, field: str) -> None:
    evaluation = Evaluation()
    evaluation.unexpected[reason] += 1

    assert evaluation.make_evidence(HostFigures(), 0, 0) == change(Evidence(), **{field: 1})


@pytest.mark.verifies("SWR-VER-022", technique="boundary_values")
def test_the_loss_between_two_instants_is_that_of_the_spans_within() -> None:
    spans = Spans([10, 30, 50], [20, 40, 60])

    assert [spans.overlaps(*ends) for ends in ((0, 9), (0, 10), (20, 25), (21, 29), (60, 70), (61, 70))] == [False, True, True, False, True, False]
    assert [spans.calc_loss(*ends) for ends in ((0, 10), (15, 35), (0, 70), (41, 49))] == [0, 10, 30, 0]
    assert [spans.calc_longest_loss(*ends) for ends in ((15, 32), (41, 49))] == [5, 0]
    merged = spans.merge(Spans([0], [45]))
    assert (merged.begins, merged.ends) == ([10, 30, 0, 50], [20, 40, 45, 60])
