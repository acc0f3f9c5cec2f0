# SPDX-License-Identifier: Apache-2.0
"""Goal: the evaluation of failing partitions finds each deviation, and excuses a window only if the host was slow. Method: handwritten
courses; instants in us."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

from verification.faults.evaluation.evaluator import Outcome, Unexpected
from verification.faults.evaluation.host_causes import Spans
from verification.faults.evaluation.partition import (
    Injection,
    Limits,
    Reaction,
    Reception,
    Record,
    Start,
    Window,
    count_disordered,
    evaluate_reactions,
    evaluate_windows,
    measure_lateness,
)  # fmt: skip

LIMITS = Limits(frame_ns=1_000_000, silent_frames=50, skipped_max=64, reaction_time_ns=2_000_000)
BOUND = 54_000
# The injection of most courses: between two replies.
INJECTED = 100_500
LAST_REPLY = 100_200
END = 300_000
SpanList = Sequence[tuple[int, int]]


def make_spans(spans: SpanList) -> Spans:
    return Spans([begin * 1000 for begin, _ in spans], [end * 1000 for _, end in spans])


def good(at: int) -> Reception:
    return Reception(at * 1000, 1, 1)


def nothing(at: int) -> Reception:
    return Reception(at * 1000)


def wrong(at: int) -> Reception:
    return Reception(at * 1000, 1, 0)


def malformed(at: int) -> Reception:
    return Reception(at * 1000, 0, 0, 1)


def skipping(at: int, skipped: int) -> Reception:
    return Reception(at * 1000, 1, 1, 0, skipped)


def react(at: int, fault: str = "silent", is_declared: int = 1) -> Reaction:
    return Reaction(at * 1000, fault, is_declared)


def receive(last: int, end: int, *others: Reception) -> list[Reception]:
    """Valid replies in each frame up to `last`, none later. `others` replace the replies at their instants."""
    found = {at * 1000: good(at) if at <= last else nothing(at) for at in range(200, end + 1, 1000)}
    return list((found | {each.at_ns: each for each in others}).values())


def make_record(kind: str, receptions: list[Reception], *reactions: Reaction, is_injected: int = 1, stalls: SpanList = ()) -> Record:
    injection = Injection(kind, is_injected, INJECTED * 1000, INJECTED * 1000, END * 1000)
    return Record(LIMITS, [injection], reactions, receptions, stalls=make_spans(stalls))


def kill(*reactions: Reaction, is_injected: int = 1, stalls: SpanList = (), others: Sequence[Reception] = ()) -> Record:
    return make_record("kill", receive(LAST_REPLY, END, *others), *reactions, is_injected=is_injected, stalls=stalls)


def flood(skipped: int) -> Record:
    return make_record("flood", receive(100_200, 101_200, skipping(101_200, skipped)), react(101_500, "flooding"))


def corrupt(last: Reception, reacted: int) -> Record:
    return make_record("corrupt", receive(100_200, 101_200, last), react(reacted, "corrupt"))


def corrupt_late(reacted: int) -> Record:
    return make_record("corrupt", receive(130_200, END), react(reacted))


@pytest.mark.verifies("SWR-PRT-018", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("record", "outcome", "false"),
    [
        (kill(react(LAST_REPLY + 50_000)), Outcome.IN_TIME, 0),
        (kill(react(INJECTED + BOUND)), Outcome.IN_TIME, 0),
        (kill(react(INJECTED + BOUND + 1)), Outcome.LATE, 0),
        (kill(react(INJECTED + BOUND + 1), stalls=[(120_000, 120_500)]), Outcome.LATE_BY_HOST, 0),
        (kill(react(INJECTED + BOUND + 1), stalls=[(90_000, 90_500)]), Outcome.LATE, 0),  # a stall before the fault
        (kill(), Outcome.NOT_DETECTED, 0),
        (kill(react(END + 1)), Outcome.NOT_DETECTED, 0),  # the partition had already ended
        (kill(is_injected=0), Outcome.NOT_INJECTED, 0),
        # The reaction is not the declared one, or names a fault that this kind cannot cause.
        (kill(react(151_000, is_declared=0)), Outcome.WRONGLY_NAMED, 0),
        (kill(react(151_000, "flooding"), others=[skipping(150_200, 65)]), Outcome.WRONGLY_NAMED, 0),
        (kill(react(151_000, "none")), Outcome.WRONGLY_NAMED, 1),
        # A flood is more messages than the limit.
        (flood(65), Outcome.IN_TIME, 0),
        (flood(64), Outcome.WRONGLY_NAMED, 1),
        # Corruption is a malformed message, or a wrong check.
        (corrupt(wrong(101_200), 101_500), Outcome.IN_TIME, 0),
        (corrupt(malformed(101_200), 101_500), Outcome.IN_TIME, 0),
        (corrupt(malformed(101_200), 103_200), Outcome.IN_TIME, 0),
        (corrupt(malformed(101_200), 103_201), Outcome.WRONGLY_NAMED, 1),  # too long before the reaction
        (corrupt(nothing(101_200), 101_500), Outcome.WRONGLY_NAMED, 1),
        # No reaction is due while valid replies arrive.
        (corrupt_late(130_200 + BOUND), Outcome.IN_TIME, 0),
        (corrupt_late(130_200 + BOUND + 1), Outcome.LATE, 0),
    ],
)  # fmt: skip
def test_each_fault_has_its_outcome_on_both_sides_of_each_limit(record: Record, outcome: Outcome, false: int) -> None:
    evaluation = evaluate_reactions(record)

    assert [each for _, each in evaluation.outcomes] == [outcome]
    # A reaction after the end of the partition counts as a separate report.
    late_ones = sum(reaction.at_ns > END * 1000 for reaction in record.reactions)
    assert evaluation.unexpected.total() == false + late_ones


@pytest.mark.verifies("SWR-PRT-018")
def test_the_time_of_a_reaction_counts_from_its_fault() -> None:
    assert evaluate_reactions(kill(react(INJECTED + 51_000))).times_ns == {"kill": [51_000_000]}


SILENCE = [nothing(at) for at in range(10_200, 60_200, 1000)]


@pytest.mark.verifies("SWR-PRT-018", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("first", "others", "stalls", "reason"),
    [
        (react(50_500), (), (), Unexpected.FALSE),
        (react(59_200), SILENCE, (), Unexpected.BY_HOST),
        (Reaction(59_199_000, "silent"), SILENCE, (), Unexpected.FALSE),  # before the gap was long enough
        (react(60_500, "flooding"), [*SILENCE, skipping(60_200, 65)], (), Unexpected.FALSE),
        (react(60_500, "flooding"), [*SILENCE, skipping(60_200, 65)], [(10_000, 59_000)], Unexpected.BY_HOST),  # the guard could not poll
    ],
)  # fmt: skip
def test_a_reaction_without_a_fault_is_false_unless_nothing_came(
    first: Reaction, others: Sequence[Reception], stalls: SpanList, reason: Unexpected
) -> None:
    evaluation = evaluate_reactions(kill(first, react(151_000), stalls=stalls, others=others))

    assert evaluation.unexpected == {reason: 1}
    assert evaluation.outcomes == [("kill", Outcome.IN_TIME)], "the fault has its own"


@pytest.mark.verifies("SWR-PRT-018", technique="fault_injection", polarity="violation")
def test_a_reaction_after_the_last_fault_is_false_if_a_reply_came_shortly_before() -> None:
    record = kill(react(151_000), react(END + 60_000))
    record.receptions = [*record.receptions, good(END + 50_200)]

    assert evaluate_reactions(record).unexpected == {Unexpected.FALSE: 1}


STARTS = [Start(0, 0), Start(1, 500_000), Start(0, 1_000_000), Start(1, 1_500_000)]


def make_order(overruns: Sequence[int] = (), missed: Sequence[int] = (), ends: Sequence[int] = (100, 600, 1100, 1600)) -> Record:
    """Two windows in each of two frames. `overruns` and `missed` contain numbers of windows; ends in us."""
    windows = [Window(*start, start.release_ns + 20_000, end * 1000, int(number in missed), int(number in overruns))
               for number, (start, end) in enumerate(zip(STARTS, ends, strict=True))]  # fmt: skip
    ran = [start for number, start in enumerate(STARTS) if number not in missed]
    return Record(LIMITS, windows=windows, ran=ran, expected=STARTS)


@pytest.mark.verifies("SWR-PRT-018")
def test_windows_in_the_order_of_virtual_time_give_no_deviation() -> None:
    record = make_order()

    assert (count_disordered(record), evaluate_windows(record).unexpected) == (0, {})
    assert measure_lateness(record)["quiet"]["p50_ns"] == 20_000
    assert measure_lateness(record)["quiet"]["count"] == 4


@pytest.mark.verifies("SWR-PRT-018", technique="fault_injection", polarity="violation")
def test_a_window_that_is_lost_duplicated_or_exchanged_is_out_of_order() -> None:
    def count(ran: list[Start]) -> int:
        return count_disordered(replace(make_order(), ran=ran))

    assert count([STARTS[0], *STARTS[2:]]) == 1
    assert count([*STARTS, STARTS[3]]) == 1
    assert count([STARTS[0], STARTS[2], STARTS[1], STARTS[3]]) > 0
    assert count_disordered(replace(make_order(), expected=[])) == 4, "virtual time did not run"


@pytest.mark.verifies("SWR-PRT-018", technique="fault_injection", polarity="violation")
def test_the_work_of_an_aborted_window_runs_at_any_time_or_never() -> None:
    aborted = make_order(overruns=[2])
    for ran in (STARTS, [*STARTS[:2], STARTS[3], STARTS[2]], [*STARTS[:2], STARTS[3]]):
        assert count_disordered(replace(aborted, ran=ran)) == 0
    assert count_disordered(make_order(missed=[2])) == 0


MISSED = make_order(missed=[2])
LONG_MISSED = make_order(missed=[2], ends=(100, 600, 1300, 1600))
ABORTED = make_order(overruns=[2], ends=(100, 600, 1300, 1600))


@pytest.mark.verifies("SWR-PRT-018", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("record", "stalls", "late_polls", "reason"),
    [
        (MISSED, (), (), Unexpected.FALSE),
        (make_order(overruns=[2]), (), (), Unexpected.FALSE),
        (MISSED, [(1050, 1300)], (), Unexpected.SUSPECTED),  # partly within the window
        (MISSED, [(1101, 1300)], (), Unexpected.FALSE),  # the stall ended before
        # The host took half of the budget, in pieces or at once.
        (LONG_MISSED, (), [(1000, 1060), (1100, 1155)], Unexpected.SUSPECTED),
        (LONG_MISSED, (), [(1000, 1060), (1100, 1154)], Unexpected.FALSE),
        (LONG_MISSED, (), [(940, 1000), (1300, 1400)], Unexpected.FALSE),  # before and after the window
        (LONG_MISSED, (), [(1000, 1115)], Unexpected.BY_HOST),
        (LONG_MISSED, (), [(1000, 1114)], Unexpected.FALSE),
        # A complete budget from the previous frame on. Stalls that ended before that frame do not count.
        (ABORTED, (), [(-100, -1), (100, 200), (700, 780), (1100, 1150)], Unexpected.SUSPECTED),
        (ABORTED, (), [(-100, -1), (100, 200), (700, 779), (1100, 1150)], Unexpected.FALSE),
    ],
)  # fmt: skip
def test_a_window_that_moved_is_a_deviation_unless_the_host_took_half_of_its_budget(
    record: Record, stalls: SpanList, late_polls: SpanList, reason: Unexpected
) -> None:
    evaluation = evaluate_windows(replace(record, stalls=make_spans(stalls), late_polls=make_spans(late_polls)))

    assert evaluation.unexpected == {reason: 1}
    assert len(evaluation.deviations) == (reason == Unexpected.FALSE)


@pytest.mark.verifies("SWR-PRT-018", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("foreign", "is_alone"), [(None, False), ([(900, 1024), (1300, 1400)], True), ([(900, 1025), (1300, 1400)], False)]
)
def test_a_window_that_moved_while_no_other_program_ran_is_marked(foreign: SpanList | None, is_alone: bool) -> None:
    evaluation = evaluate_windows(replace(ABORTED, foreign=None if foreign is None else make_spans(foreign)))

    assert evaluation.unexpected == {Unexpected.FALSE: 1}, "the partition did not do it, but nothing explains it either"
    assert [row["is_alone"] for row in evaluation.deviations] == [is_alone]


@pytest.mark.verifies("SWR-PRT-018", technique="error_guessing", polarity="violation")
def test_a_window_whose_work_has_not_returned_shares_the_cause_of_the_frame_before() -> None:
    both = make_order(overruns=[0, 2])
    assert evaluate_windows(both).unexpected == {Unexpected.FALSE: 2}

    stalls = make_spans([(0, 100)])
    assert evaluate_windows(replace(both, stalls=stalls)).unexpected == {Unexpected.SUSPECTED: 1, Unexpected.BY_HOST: 1}
    other = make_order(overruns=[0, 3])
    assert evaluate_windows(replace(other, stalls=stalls)).unexpected == {Unexpected.SUSPECTED: 1, Unexpected.FALSE: 1}, "another window"


@pytest.mark.verifies("SWR-PRT-018", technique="boundary_values")
def test_lateness_and_stalls_are_counted_by_the_state_of_the_partition() -> None:
    record = make_order()
    record.windows = [*record.windows[:3], record.windows[3]._replace(woke_ns=1_590_000)]
    record.injections = [Injection("stop", 1, 500_000, 500_000, 1_000_000)]
    record.stalls = make_spans([(499, 500), (700, 800), (1001, 1100)])

    figures = measure_lateness(record)
    assert [figures["faulty"][key] for key in ("count", "stalls", "max_ns", "time_ns")] == [2, 1, 20_000, 500_000]
    assert [figures["quiet"][key] for key in ("count", "stalls", "max_ns", "time_ns")] == [2, 2, 90_000, 1_100_000]
