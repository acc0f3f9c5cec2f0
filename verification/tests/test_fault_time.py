# SPDX-License-Identifier: Apache-2.0
"""Goal: the evaluation of faults of time finds each deviation. Method: handwritten courses of a system with two windows and three
components; instants in us."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from verification.faults.evaluation.evaluator import Evaluation, Outcome, Unexpected
from verification.faults.evaluation.host_causes import HostFigures, Spans
from verification.faults.evaluation.run_verdict import assess_run
from verification.faults.evaluation.time import Delay, Overrun, Report, System, evaluate_reports
from verification.faults.evaluation.time_watch import Bounds, ClockFault, Hold, WatchFinding, evaluate_watch

# Windows of 300 us with a budget of 200 us at 0 and 300; the first runs component 0, the second 1 and 2.
SYSTEM = System(1_000_000, 200_000, 100_000, (0, 1, 1), (300_000, 300_000))
SpanList = Sequence[tuple[int, int]]


def make_spans(spans: SpanList) -> Spans:
    return Spans([begin * 1000 for begin, _ in spans], [end * 1000 for _, end in spans])


def overrun(window: int, component: int, release: int, woke: int, at: int, *, component_delay: int = 0) -> Report:
    return Report(1, window, component, release * 1000, woke * 1000, at * 1000, 0, component_delay * 1000)


def late(window: int, release: int, at: int, *, runner_delay: int = 0, component_delay: int = 0) -> Report:
    return Report(0, window, -1, release * 1000, at * 1000, at * 1000, runner_delay * 1000, component_delay * 1000)


def inject(cause: str = "work", end: int = 6810) -> Overrun:
    """Component 1 takes 1.5 ms, from 5310 on."""
    return Overrun(1, cause, 5_310_000, end * 1000)


def delay(window: int, release: int, end: int) -> Delay:
    return Delay(window, release * 1000, end * 1000)


def evaluate(
    reports: Sequence[Report], overruns: Sequence[Overrun] = (), delays: Sequence[Delay] = (), stalls: SpanList = (), late_polls: SpanList = ()
) -> Evaluation:
    return evaluate_reports(SYSTEM, reports, overruns, delays, make_spans(stalls), make_spans(late_polls))


OWN = overrun(1, 1, 5300, 5310, 5515)
OTHER = overrun(1, 2, 5300, 5310, 5515)
LATE_POLLS = ((6820, 6900), (7850, 7900))


@pytest.mark.verifies("SWR-PRT-007")
def test_an_overrun_is_detected_from_its_report_to_the_return_of_its_work() -> None:
    evaluation = evaluate([OWN, overrun(1, 1, 6300, 6310, 6310)], [inject()])

    assert evaluation.outcomes == [("work", Outcome.IN_TIME)]
    assert evaluation.times_ns == {"detection": [5000]}, "from the end of the budget"
    assert not evaluation.unexpected


@pytest.mark.verifies("SWR-PRT-007", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("reports", "stalls", "late_polls", "outcome"),
    [
        ([OTHER], (), (), Outcome.WRONGLY_NAMED),
        ([], (), (), Outcome.NOT_DETECTED),
        # A report counts until one frame after the end, not counting time that the host took.
        ([overrun(1, 1, 5300, 5310, 7810)], [(6000, 6810)], (), Outcome.LATE_BY_HOST),
        ([overrun(1, 1, 5300, 5310, 7811)], [(6000, 6810)], (), Outcome.NOT_DETECTED),
        ([overrun(1, 1, 5300, 5310, 7940)], [(6000, 6810)], LATE_POLLS, Outcome.LATE_BY_HOST),
        ([overrun(1, 1, 5300, 5310, 7941)], [(6000, 6810)], LATE_POLLS, Outcome.NOT_DETECTED),
        # One frame after the deadline.
        ([overrun(1, 1, 5300, 5310, 6510)], (), (), Outcome.IN_TIME),
        ([overrun(1, 1, 5300, 5310, 6511)], (), (), Outcome.LATE),
        ([overrun(1, 1, 5300, 5310, 6511)], [(6000, 6400)], (), Outcome.LATE_BY_HOST),
    ],
)  # fmt: skip
def test_an_overrun_has_its_outcome_on_both_sides_of_each_limit(
    reports: list[Report], stalls: SpanList, late_polls: SpanList, outcome: Outcome
) -> None:
    assert evaluate(reports, [inject()], stalls=stalls, late_polls=late_polls).outcomes == [("work", outcome)]


REPORT = overrun(0, 0, 8000, 8010, 8215)


@pytest.mark.verifies("SWR-PRT-007", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("report", "late_polls", "reason"),
    [
        (REPORT, (), Unexpected.FALSE),
        (REPORT, [(7950, 8099)], Unexpected.FALSE),  # partly before the window
        (REPORT, [(7000, 8100)], Unexpected.BY_HOST),
        (REPORT, [(8115, 9000)], Unexpected.BY_HOST),
        (REPORT, [(8116, 9000)], Unexpected.FALSE),  # mostly after the report
        (REPORT, [(7900, 7999), (8216, 9000)], Unexpected.FALSE),
        (REPORT, [(8010, 8060), (8100, 8150)], Unexpected.SUSPECTED),  # in pieces
        (REPORT, [(8010, 8060), (8100, 8149)], Unexpected.FALSE),
        (REPORT, [(7000, 8000)], Unexpected.SUSPECTED),  # a complete budget since the previous frame
        (REPORT, [(6000, 7200)], Unexpected.SUSPECTED),
        (REPORT, [(6000, 7199)], Unexpected.FALSE),
        (late(0, 8000, 9100), (), Unexpected.FALSE),
        (late(0, 8000, 9100), [(8000, 9090)], Unexpected.BY_HOST),
        # The component was ready but did not run for half of its budget.
        (overrun(0, 0, 8000, 8010, 8210, component_delay=100), (), Unexpected.SUSPECTED),
        (overrun(0, 0, 8000, 8010, 8210, component_delay=99), (), Unexpected.FALSE),
        (overrun(0, 0, 8000, 8010, 8209, component_delay=100), (), Unexpected.FALSE),  # too early
        (overrun(0, 0, 8000, 8250, 8300, component_delay=100), (), Unexpected.SUSPECTED),  # its window ends first
        (overrun(0, 0, 8000, 8250, 8299, component_delay=100), (), Unexpected.FALSE),
        (late(0, 8000, 9100, component_delay=100), (), Unexpected.FALSE),
        # The runner was ready but did not run for half of its lateness.
        (late(0, 8000, 9400, runner_delay=700), (), Unexpected.SUSPECTED),
        (late(0, 8000, 9400, runner_delay=699), (), Unexpected.FALSE),
        (late(0, 8000, 8200, runner_delay=100), (), Unexpected.SUSPECTED),
        (late(0, 8000, 8198, runner_delay=99), (), Unexpected.FALSE),
    ],
)  # fmt: skip
def test_a_report_without_an_injection_is_false_unless_the_host_took_half_a_budget(report: Report, late_polls: SpanList, reason: Unexpected) -> None:
    evaluation = evaluate([report], late_polls=late_polls)

    assert evaluation.unexpected == {reason: 1}
    assert len(evaluation.deviations) == (reason == Unexpected.FALSE)


@pytest.mark.verifies("SWR-PRT-007", technique="fault_injection", polarity="violation")
def test_no_late_poll_and_another_injection_explain_no_report() -> None:
    assert evaluate([REPORT], stalls=[(8000, 8200)]).unexpected == {Unexpected.FALSE: 1}
    assert evaluate([REPORT], [inject()]).unexpected == {Unexpected.FALSE: 1}


@pytest.mark.verifies("SWR-PRT-007", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("reports", "late_polls", "unexpected"),
    [
        ([late(0, 8000, 9400), late(1, 9400, 10_700)], [(8000, 9390)], {Unexpected.BY_HOST: 2}),
        ([late(0, 8000, 9400), late(1, 9401, 10_700)], [(8000, 8150)], {Unexpected.BY_HOST: 1, Unexpected.FALSE: 1}),
        ([late(0, 8000, 9400, runner_delay=700), late(1, 9400, 9401), late(0, 9402, 10_600)], (),
         {Unexpected.SUSPECTED: 2, Unexpected.FALSE: 1}),
        # Work that has not returned one frame later shares the cause.
        ([overrun(0, 0, 8000, 8010, 8215), overrun(0, 0, 9000, 9010, 9010)], [(8000, 8210)], {Unexpected.BY_HOST: 1}),
        ([overrun(0, 0, 8000, 8010, 8215), overrun(0, 0, 10_000, 10_010, 10_010)], [(8000, 8210)], {Unexpected.BY_HOST: 1, Unexpected.FALSE: 1}),
        # False reports with the same cause count once.
        ([late(0, 8000, 9400), late(1, 8300, 9401)], (), {Unexpected.FALSE: 1}),
        ([late(0, 8000, 9400), late(1, 9400, 10_900)], (), {Unexpected.FALSE: 1}),
        ([late(0, 8000, 9400), late(1, 9401, 10_900)], (), {Unexpected.FALSE: 2}),
    ],
)  # fmt: skip
def test_what_was_due_before_a_report_shares_its_cause(reports: list[Report], late_polls: SpanList, unexpected: dict[Unexpected, int]) -> None:
    assert +evaluate(reports, late_polls=late_polls).unexpected == unexpected


@pytest.mark.verifies("SWR-VER-022", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("reports", "overruns", "late_polls", "verdict"),
    [
        ([REPORT], [], (), "failed"),
        ([REPORT], [], [(8010, 8060), (8100, 8150)], "inconclusive"),
        ([REPORT], [], [(8010, 8110)], "passed"),  # set aside
        ([OTHER], [inject()], (), "failed"),
        ([], [inject()], (), "failed"),
    ],
)  # fmt: skip
def test_a_false_report_fails_the_run_and_a_suspected_one_makes_it_inconclusive(
    reports: list[Report], overruns: list[Overrun], late_polls: SpanList, verdict: str
) -> None:
    evaluation = evaluate(reports, overruns, late_polls=late_polls)

    assert assess_run(evaluation.make_evidence(HostFigures(), 3000, 0)).verdict == verdict


@pytest.mark.verifies("SWR-PRT-007")
def test_a_delay_is_detected_at_its_window_and_explains_the_reports_until_the_schedule_is_met() -> None:
    reports = [late(0, 5000, 6290), late(1, 5300, 6291), overrun(0, 0, 6000, 6292, 6300)]
    evaluation = evaluate(reports, delays=[delay(0, 5000, 6290)])
    assert (evaluation.outcomes, +evaluation.unexpected) == ([("delay", Outcome.IN_TIME)], {}), "the last one started 8 us before its end"


@pytest.mark.verifies("SWR-PRT-007", technique="fault_injection", polarity="violation")
def test_a_report_of_another_window_or_with_its_whole_budget_is_not_that_of_a_delay() -> None:
    other = evaluate([late(1, 5300, 6291)], delays=[delay(0, 5000, 6290)])
    assert other.outcomes == [("delay", Outcome.NOT_DETECTED)]
    own = evaluate([late(0, 5000, 6290), overrun(0, 0, 6000, 6050, 6255)], delays=[delay(0, 5000, 6290)])
    assert own.unexpected == {Unexpected.FALSE: 1}


@pytest.mark.verifies("SWR-PRT-007", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("reports", "outcome"),
    [
        ([overrun(1, 1, 5300, 5310, 6815), late(0, 6000, 6816)], Outcome.IN_TIME),
        ([late(0, 6000, 6816)], Outcome.NOT_DETECTED),
        ([overrun(1, 1, 5300, 5401, 6815)], Outcome.IN_TIME),  # its own window started late
        ([overrun(0, 0, 6000, 6101, 6815)], Outcome.NOT_DETECTED),  # another window that started late
        ([overrun(1, 1, 6300, 6401, 6815)], Outcome.NOT_DETECTED),  # of the frame after
    ],
)  # fmt: skip
def test_a_stuck_guard_may_report_late_but_names_its_component(reports: list[Report], outcome: Outcome) -> None:
    evaluation = evaluate(reports, [inject("stuck_guard")])

    assert evaluation.outcomes == [("stuck_guard", outcome)]
    assert (+evaluation.unexpected, evaluation.times_ns) == ({}, {}), "its time is that of the watch"


@pytest.mark.verifies("SWR-PRT-007", technique="fault_injection", polarity="violation")
def test_a_late_report_of_a_guard_that_works_is_late() -> None:
    assert evaluate([overrun(1, 1, 5300, 5310, 6815)], [inject()]).outcomes == [("work", Outcome.LATE)]


@pytest.mark.verifies("SWR-PRT-035", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("reports", "cause", "end", "outcome"),
    [
        ([OWN], "lock", 6810, Outcome.IN_TIME),
        ([OTHER], "lock", 6810, Outcome.WRONGLY_NAMED),
        ([], "lock", 5510, Outcome.NOT_INJECTED),  # the mutex was released within the budget
        ([], "lock", 5511, Outcome.NOT_DETECTED),
        ([overrun(1, 1, 5300, 5305, 5506)], "lock", 5510, Outcome.IN_TIME),  # its window had started before the injection
        ([], "work", 5510, Outcome.NOT_DETECTED),  # injected work takes its full time
    ],
)  # fmt: skip
def test_a_component_that_waited_for_a_lock_is_reported_and_one_that_found_it_free_was_not_injected(
    reports: list[Report], cause: str, end: int, outcome: Outcome
) -> None:
    evaluation = evaluate(reports, [inject(cause, end)])

    assert evaluation.outcomes == [(cause, outcome)]
    assert evaluation.count_injected(cause) == (outcome != Outcome.NOT_INJECTED)


HOLD = Hold(5_000_000, 7_000_000)
FAST = ClockFault(50_000_000, 75_000_000, 10_000)


def overdue(due: int, seen: int, cleared: int) -> WatchFinding:
    return WatchFinding("overdue", due * 1000, seen * 1000, cleared * 1000)


def wrong_clock(fault: str, seen: int) -> WatchFinding:
    return WatchFinding(fault, 0, seen * 1000, (seen + 20_000) * 1000)


def watch(injections: Sequence[Hold | ClockFault], findings: Sequence[WatchFinding], stalls: SpanList = ()) -> Evaluation:
    """The monitor must find an overdue window in 1 ms, a wrong clock in 21 ms."""
    holds = [each for each in injections if isinstance(each, Hold)]
    faults = [each for each in injections if isinstance(each, ClockFault)]
    return evaluate_watch(Bounds(1_000_000, 21_000_000), holds, faults, findings, make_spans(stalls))


@pytest.mark.verifies("SWR-PRT-034")
def test_a_hang_and_a_wrong_clock_are_detected_by_their_findings() -> None:
    evaluation = watch([HOLD, FAST], [overdue(5000, 5450, 27_000), wrong_clock("fast_clock", 55_000)])

    assert evaluation.outcomes == [("hold", Outcome.IN_TIME), ("clock", Outcome.IN_TIME)]
    assert evaluation.times_ns == {"hold": [450_000], "clock": [5_000_000]}
    assert not evaluation.unexpected


@pytest.mark.verifies("SWR-PRT-034", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("injection", "findings", "stalls", "outcome"),
    [
        (HOLD, [], (), Outcome.NOT_DETECTED),
        (FAST, [], (), Outcome.NOT_DETECTED),
        # An earlier finding that is still latched.
        (HOLD, [overdue(3900, 4400, 5000)], [(3900, 4200)], Outcome.NOT_DETECTED),  # cleared when it began
        (HOLD, [overdue(3900, 4400, 5001)], [(3900, 4200)], Outcome.MASKED),
        # Another kind or direction.
        (HOLD, [wrong_clock("slow_clock", 5500)], (), Outcome.WRONGLY_NAMED),
        (FAST, [wrong_clock("slow_clock", 55_000)], (), Outcome.WRONGLY_NAMED),
        (FAST, [overdue(55_000, 55_450, 80_000)], (), Outcome.WRONGLY_NAMED),
        (FAST, [overdue(55_000, 55_450, 80_000)], [(55_000, 55_300)], Outcome.MASKED),  # the host stalled, and its finding masked the clock
        # The bounds.
        (HOLD, [overdue(5000, 6000, 27_000)], (), Outcome.IN_TIME),
        (HOLD, [overdue(5000, 6001, 27_000)], (), Outcome.LATE),
        (HOLD, [overdue(5000, 6001, 27_000)], [(5600, 5900)], Outcome.LATE_BY_HOST),
        (FAST, [wrong_clock("fast_clock", 71_000)], (), Outcome.IN_TIME),
        (FAST, [wrong_clock("fast_clock", 71_001)], (), Outcome.LATE),
    ],
)  # fmt: skip
def test_a_hang_and_a_wrong_clock_have_their_outcomes_on_both_sides_of_each_limit(
    injection: Hold | ClockFault, findings: list[WatchFinding], stalls: SpanList, outcome: Outcome
) -> None:
    assert [each for _, each in watch([injection], findings, stalls).outcomes] == [outcome]


@pytest.mark.verifies("SWR-PRT-034", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("finding", "stalls", "reason"),
    [
        (overdue(9000, 9450, 30_000), (), Unexpected.FALSE),
        (overdue(9000, 9450, 30_000), [(8000, 8999)], Unexpected.FALSE),  # the stall ended before anything was due
        (overdue(9000, 9450, 30_000), [(8000, 9000)], Unexpected.BY_HOST),
        (wrong_clock("slow_clock", 9450), [(9000, 9450)], Unexpected.FALSE),  # a stall never makes a clock wrong
    ],
)  # fmt: skip
def test_a_finding_without_an_injection_is_false_unless_the_host_stalled(finding: WatchFinding, stalls: SpanList, reason: Unexpected) -> None:
    assert watch([], [finding], stalls).unexpected == {reason: 1}
