# SPDX-License-Identifier: Apache-2.0
"""Goal: the evaluation of lost watchdog services finds each deviation. Method: handwritten trials of a watchdog with 5 ms; instants in
us."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from verification.faults.evaluation.evaluator import Evaluation, Outcome, Unexpected
from verification.faults.evaluation.host_causes import HostFigures, Spans
from verification.faults.evaluation.run_verdict import assess_run
from verification.faults.evaluation.service import Trial, evaluate_trials

LOSSES = ["none", "hang", "wait", "unhealthy", "inconsistent", "runaway", "no_window"]
SpanList = Sequence[tuple[int, int]]


def make_spans(spans: SpanList) -> Spans:
    return Spans([begin * 1000 for begin, _ in spans], [end * 1000 for _, end in spans])


def make_trial(loss: str, closed_us: int = 0, *, serviced_us: int = 10_000, end_us: int = 20_000, injected_us: int = 10_900) -> Trial:
    """Last service at 10,000 us, loss at 10,900: the watchdog time ends at 15,000. Value 0: outputs not closed, or loss not injected."""
    return Trial(LOSSES.index(loss), int(injected_us > 0), injected_us * 1000, 10_000_000, serviced_us * 1000, int(closed_us > 0), closed_us * 1000, 0,
                 end_us * 1000)  # fmt: skip


def evaluate(trial: Trial, stalls: SpanList = ()) -> Evaluation:
    return evaluate_trials([trial], LOSSES, make_spans(stalls), 5_000_000, 1_000_000)


@pytest.mark.verifies("SWR-PRT-022", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("trial", "stalls", "outcome"),
    [
        # Closed within a frame after the time, and later.
        (make_trial("hang", 16_000), (), Outcome.IN_TIME),
        (make_trial("hang", 16_001), [(14_000, 14_999)], Outcome.LATE),
        (make_trial("hang", 16_001), [(14_000, 15_000)], Outcome.LATE_SUSPECTED),  # the reaction took no time
        (make_trial("hang", 16_300), [(15_100, 15_399)], Outcome.LATE_SUSPECTED),
        (make_trial("hang", 16_300), [(15_100, 15_400)], Outcome.LATE_BY_HOST),
        # Too early, or never.
        (make_trial("unhealthy", 15_000), (), Outcome.EARLY),
        (make_trial("wait"), (), Outcome.NOT_DETECTED),
        # The watchdog time starts at any instant within the last service.
        (make_trial("hang", 15_000, serviced_us=10_400), (), Outcome.EARLY),
        (make_trial("hang", 15_001, serviced_us=10_400), (), Outcome.IN_TIME),
        (make_trial("hang", 16_400, serviced_us=10_400), (), Outcome.IN_TIME),
        (make_trial("hang", 16_401, serviced_us=10_400), (), Outcome.LATE),
        # The trial ended before the reaction was due.
        (make_trial("wait", end_us=16_000), (), Outcome.ENDED_BY_HOST),
        (make_trial("wait", end_us=16_001), (), Outcome.NOT_DETECTED),
        # Too early services are an immediate error.
        (make_trial("runaway", 11_900), (), Outcome.IN_TIME),
        (make_trial("runaway", 11_901), (), Outcome.LATE),
    ],
)  # fmt: skip
def test_each_loss_has_its_outcome_on_both_sides_of_each_limit(trial: Trial, stalls: SpanList, outcome: Outcome) -> None:
    evaluation = evaluate(trial, stalls)

    assert evaluation.outcomes == [(LOSSES[trial.loss], outcome)]
    assert len(evaluation.deviations) == (outcome in (Outcome.LATE, Outcome.NOT_DETECTED))


CLEAN = make_trial("none", 15_010, injected_us=0)


@pytest.mark.verifies("SWR-PRT-022", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("trial", "stalls", "reason"),
    [
        (CLEAN, (), Unexpected.FALSE),
        (CLEAN, [(15_011, 15_100)], Unexpected.FALSE),
        (CLEAN, [(9_000, 9_999)], Unexpected.FALSE),
        (CLEAN, [(12_000, 12_500)], Unexpected.BY_HOST),
        (CLEAN, [(12_000, 12_499)], Unexpected.SUSPECTED),  # too short for a missed service
        (make_trial("hang", 10_899), (), Unexpected.FALSE),  # the loss occurred later
    ],
)  # fmt: skip
def test_outputs_closed_without_a_loss_are_false_unless_the_host_stalled(trial: Trial, stalls: SpanList, reason: Unexpected) -> None:
    evaluation = evaluate(trial, stalls)

    assert (evaluation.outcomes, evaluation.unexpected) == ([], {reason: 1})
    assert len(evaluation.deviations) == (reason == Unexpected.FALSE)


@pytest.mark.verifies("SWR-PRT-022")
@pytest.mark.parametrize(("closed_us", "serviced_us", "reaction_ns"), [(16_000, 10_000, 1_000_000), (15_001, 10_400, 0)])
def test_the_reaction_time_counts_from_the_end_of_the_watchdog_time(closed_us: int, serviced_us: int, reaction_ns: int) -> None:
    assert evaluate(make_trial("hang", closed_us, serviced_us=serviced_us)).times_ns == {"reaction": [reaction_ns]}


@pytest.mark.verifies("SWR-PRT-022", technique="equivalence_classes")
def test_a_watchdog_serviced_to_the_end_passes_and_a_loss_without_effect_shows_nothing() -> None:
    def assess(trial: Trial) -> str:
        return assess_run(evaluate(trial).make_evidence(HostFigures(), 1, int(trial.loss != 0))).verdict

    assert assess(make_trial("none", injected_us=0)) == "passed"
    assert assess(make_trial("hang", injected_us=0)) == "failed"
