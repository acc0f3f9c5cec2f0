# SPDX-License-Identifier: Apache-2.0
"""Faults of a partition. Windows must run in the order of virtual time. Each fault must have its declared reaction in time; no other
reaction may occur.

Design: docs/design/posix_rt.md#faults-of-partitions
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from verification.faults.evaluation.course import Course
from verification.faults.evaluation.evaluator import Evaluation, Outcome, Result, Unexpected, add_evidence, summarize
from verification.faults.evaluation.host_causes import Spans
from verification.faults.evaluation.run_verdict import Evidence, assess_run

LOSS_MIN_NS = 115_000
"""Half of the budget. If the host takes this time from a window, it counts as the cause of the shift. If it takes the time at once,
the window is set aside; in pieces, the run is inconclusive."""

SLOW_LOSS_MIN_NS = 230_000
"""A complete budget: the same limit for the time since the previous frame. A window has only two to four polls, too few to show how slow
the host is, and time between polls is also lost. Measured: less than a tenth of the windows follow such a frame, but 98 of 100 shifted
windows."""

FOREIGN_MIN_NS = 25_000
"""Another program must have used the processor for this part of a window to be the cause of its shift; a poll is late by as much."""

REACTION_FRAMES = 2
"""From the reception to the reaction of the drive: within a frame, and at most one frame late."""

CAN_BE = {"kill": ("silent",), "stop": ("silent",), "flood": ("flooding", "silent"), "corrupt": ("silent", "flooding", "corrupt")}
"""The faults that a kind can cause. A dead or stopped process writes nothing; flooding has two writers in one memory."""


class Reception(NamedTuple):
    """Data of the receiver in one frame [ns]."""

    at_ns: int  # planned start of its window
    is_answer: int = 0
    is_check_right: int = 0
    is_malformed: int = 0
    skipped: int = 0  # messages between two polls


class Reaction(NamedTuple):
    """Start of a reaction at the drive [ns]."""

    at_ns: int
    fault: str
    is_declared: int = 1  # the table declares it for that fault


class Injection(NamedTuple):
    """A fault of the partition [ns]."""

    kind: str
    is_injected: int
    begin_ns: int
    injected_ns: int  # from here on no valid reply is expected
    end_ns: int  # the partition has ended


class Start(NamedTuple):
    """A window that started at its planned instant in virtual time, or a window in which a component ran."""

    window: int
    release_ns: int


class Window(NamedTuple):
    """A window instance in real time [ns]."""

    window: int
    release_ns: int
    woke_ns: int
    end_ns: int
    is_missed: int = 0  # started after its end: no component ran
    is_overrun: int = 0  # was aborted

    @property
    def start(self) -> Start:
        return Start(self.window, self.release_ns)


@dataclass(frozen=True)
class Limits:
    """Limits of the safety system [ns]."""

    frame_ns: int
    silent_frames: int
    skipped_max: int
    reaction_time_ns: int

    @property
    def silence_ns(self) -> int:
        return self.silent_frames * self.frame_ns

    @property
    def bound_ns(self) -> int:
        """From the last valid reply to the reaction: the gap, two frames until the drive receives the fault, and the reaction time."""
        return self.silence_ns + 2 * self.frame_ns + self.reaction_time_ns

    def is_good(self, reception: Reception) -> bool:
        return bool(reception.is_answer and reception.is_check_right and reception.skipped <= self.skipped_max)


@dataclass
class Record:
    """The tables of a course, each in the order of its instants."""

    limits: Limits
    injections: Sequence[Injection] = ()
    reactions: Sequence[Reaction] = ()
    receptions: Sequence[Reception] = ()
    windows: Sequence[Window] = ()
    ran: Sequence[Start] = ()
    expected: Sequence[Start] = ()
    stalls: Spans = field(default_factory=Spans)
    late_polls: Spans = field(default_factory=Spans)
    foreign: Spans | None = None  # while another program used the processor; None: unknown


def evaluate(course: Course) -> Result:
    """@raise WorkError if the course is not complete."""
    record = read_record(course)
    reactions, windows = evaluate_reactions(record), evaluate_windows(record)
    disordered = count_disordered(record)
    has_run, is_too_slow = course.get_flag("has_run"), course.get_flag("is_too_slow")
    evidence = reactions.make_evidence(course.get_host(), len(record.windows), course.get_number("requested"))
    # The data of the receiver are exact: no disturbance of the host explains a false reaction.
    false = reactions.unexpected[Unexpected.FALSE]
    exact = Evidence(violations=false + disordered + int(not has_run and not is_too_slow))
    moved = windows.make_evidence(evidence.host, 0, 0)
    finding = assess_run(add_evidence(add_evidence(replace(evidence, unexplained=evidence.unexplained - false), exact), moved))
    facts = {
        "requested": evidence.requested, "windows_run": len(record.windows), "bound_ns": record.limits.bound_ns, "disordered": disordered,
        "trouble": course.get_text("trouble"), "reactions": reactions.to_json(), "windows": windows.to_json(), "lateness": measure_lateness(record),
    }  # fmt: skip
    if finding.verdict != "passed":
        facts["outcomes_in_order"] = [f"{kind}: {outcome}" for kind, outcome in reactions.outcomes]
    return Result(finding, facts, course.get_flag("has_priority"), {"system": finding})


def read_record(course: Course) -> Record:
    kinds, faults = course.get_names("kinds"), course.get_names("faults")
    names = ("frame_ns", "silent_frames", "skipped_max", "reaction_time_ns")
    return Record(
        limits=Limits(*(course.get_number(name) for name in names)),
        injections=[row._replace(kind=kinds[int(row.kind)]) for row in course.get_rows("injections", Injection)],
        reactions=[row._replace(fault=_get_fault(faults, int(row.fault))) for row in course.get_rows("reactions", Reaction)],
        receptions=course.get_rows("receptions", Reception),
        windows=course.get_rows("windows", Window),
        ran=course.get_rows("ran", Start),
        expected=course.get_rows("expected", Start),
        stalls=course.get_spans("stalls"),
        late_polls=course.get_spans("late_polls"),
        foreign=course.get_spans("foreign") if course.get_flag("knows_foreign") else None,
    )


def evaluate_reactions(record: Record) -> Evaluation:
    return _Reactions(record).evaluate()


class _Reactions:
    def __init__(self, record: Record) -> None:
        self.record = record
        self.evaluation = Evaluation()
        self.instants = [reception.at_ns for reception in record.receptions]

    def evaluate(self) -> Evaluation:
        rest = list(self.record.reactions)
        for injection in self.record.injections:
            while rest and rest[0].at_ns < injection.begin_ns:
                self._add_unexpected(rest.pop(0), is_host_possible=True)
            outcome = Outcome.NOT_DETECTED if injection.is_injected else Outcome.NOT_INJECTED
            if rest and rest[0].at_ns <= injection.end_ns:
                reaction = rest.pop(0)
                if not self._is_explained(reaction):
                    self._add_unexpected(reaction, is_host_possible=False)
                    outcome = Outcome.WRONGLY_NAMED
                elif injection.is_injected:
                    outcome = self._find_outcome(injection, reaction)
                    self.evaluation.add_time(injection.kind, reaction.at_ns - injection.injected_ns)
            self.evaluation.add_outcome(injection.kind, outcome)
        for reaction in rest:
            self._add_unexpected(reaction, is_host_possible=True)
        return self.evaluation

    def _add_unexpected(self, reaction: Reaction, is_host_possible: bool) -> None:
        reason = Unexpected.BY_HOST if is_host_possible and self._is_by_host(reaction) else Unexpected.FALSE
        self.evaluation.unexpected[reason] += 1
        if reason == Unexpected.FALSE:
            self.evaluation.deviations.append(reaction._asdict())

    def _find_outcome(self, injection: Injection, reaction: Reaction) -> Outcome:
        """A reaction is late only if no valid reply arrived in time. A partition that corrupts or floods, and gets no processor time for
        it, may send one more valid reply."""
        if not reaction.is_declared or reaction.fault not in CAN_BE[injection.kind]:
            return Outcome.WRONGLY_NAMED
        limits = self.record.limits
        good = self._find_last(reaction.at_ns, limits.is_good)
        due_ns = max(injection.injected_ns, good.at_ns if good else injection.injected_ns)
        if reaction.at_ns - due_ns <= limits.bound_ns:
            return Outcome.IN_TIME
        return Outcome.LATE_BY_HOST if self.record.stalls.overlaps(due_ns, reaction.at_ns) else Outcome.LATE

    def _find_last(self, until_ns: int, is_wanted: Callable[[Reception], bool]) -> Reception | None:
        for index in range(bisect_right(self.instants, until_ns) - 1, -1, -1):
            if is_wanted(self.record.receptions[index]):
                return self.record.receptions[index]
        return None

    def _is_explained(self, reaction: Reaction) -> bool:
        """Whether the received messages agree with the reaction."""
        limits = self.record.limits

        def is_flood(reception: Reception) -> bool:
            return bool(reception.is_answer) and reception.skipped > limits.skipped_max

        def is_corrupt(reception: Reception) -> bool:
            return bool(reception.is_malformed or (reception.is_answer and not reception.is_check_right))

        if reaction.fault == "silent":
            last = self._find_last(reaction.at_ns, limits.is_good)
            return last is None or reaction.at_ns - last.at_ns >= limits.silence_ns
        if reaction.fault not in ("flooding", "corrupt"):
            return False
        last = self._find_last(reaction.at_ns, is_flood if reaction.fault == "flooding" else is_corrupt)
        return last is not None and reaction.at_ns - last.at_ns <= REACTION_FRAMES * limits.frame_ns

    def _is_by_host(self, reaction: Reaction) -> bool:
        """A process without priority may get no time and thus send no reply. A stalled safety side has missed many messages."""
        if not reaction.is_declared or not self._is_explained(reaction):
            return False
        limits = self.record.limits
        missed_ns = (limits.skipped_max + REACTION_FRAMES) * limits.frame_ns
        is_stalled = self.record.stalls.overlaps(reaction.at_ns - missed_ns, reaction.at_ns)
        return reaction.fault == "silent" or (reaction.fault == "flooding" and is_stalled)


def evaluate_windows(record: Record) -> Evaluation:
    """Windows that were missed or aborted. `deviations` contains windows that no stall explains."""
    evaluation = Evaluation()
    has_cause = set()
    for window in record.windows:
        if not window.is_missed and not window.is_overrun:
            continue
        # After an aborted window, the next one does not start until the aborted work has returned: both have one cause.
        is_aftermath = Start(window.window, window.release_ns - record.limits.frame_ns) in has_cause
        is_alone = _is_alone(record, window)
        if is_aftermath or record.late_polls.calc_longest_loss(window.release_ns, window.end_ns) >= LOSS_MIN_NS:
            reason = Unexpected.BY_HOST
        elif _is_suspected(record, window):
            reason = Unexpected.SUSPECTED
        else:
            reason = Unexpected.FALSE
            evaluation.deviations.append({**window._asdict(), "is_alone": is_alone})
        evaluation.unexpected[reason] += 1
        if reason != Unexpected.FALSE or is_alone:
            has_cause.add(window.start)
    return evaluation


def _is_suspected(record: Record, window: Window) -> bool:
    """A shorter stall, or several late polls."""
    return (
        record.stalls.overlaps(window.release_ns, window.end_ns)
        or record.late_polls.calc_loss(window.release_ns, window.end_ns) >= LOSS_MIN_NS
        or record.late_polls.calc_loss(window.release_ns - record.limits.frame_ns, window.end_ns) >= SLOW_LOSS_MIN_NS
    )


def _is_alone(record: Record, window: Window) -> bool:
    """A partition does not keep a window from its processor while neither the partition nor another program runs there."""
    return record.foreign is not None and record.foreign.calc_loss(window.release_ns, window.end_ns) < FOREIGN_MIN_NS


def count_disordered(record: Record) -> int:
    """Counts expected windows that did not run in order. Missed windows do not run; the work of aborted windows may run at any time, or
    never."""
    moved = {window.start for window in record.windows if window.is_missed or window.is_overrun}
    ran = [start for start in record.ran if start not in moved]
    place = disordered = 0
    for expected in record.expected:
        if expected in moved:
            continue
        if place < len(ran) and ran[place] == expected:
            place += 1
        else:
            disordered += 1
    return disordered + len(ran) - place


def measure_lateness(record: Record) -> dict[str, Any]:
    """Lateness of the windows (from the planned instant to the next reading of the clock), and the time of the partition in each state."""
    ends = [injection.end_ns for injection in record.injections]

    def get_state(at_ns: int) -> str:
        index = bisect_left(ends, at_ns)
        return "faulty" if index < len(ends) and record.injections[index].begin_ns <= at_ns else "quiet"

    shares = (("p50_ns", 5000), ("p99_ns", 9900), ("p9999_ns", 9999), ("max_ns", 10000))
    lateness: dict[str, list[int]] = {"quiet": [], "faulty": []}
    for window in record.windows:
        lateness[get_state(window.release_ns)].append(window.woke_ns - window.release_ns)
    figures: dict[str, Any] = {state: summarize(times, shares) for state, times in lateness.items()}
    faulty_ns = sum(injection.end_ns - injection.begin_ns for injection in record.injections)
    total_ns = record.windows[-1].end_ns - record.windows[0].release_ns if record.windows else faulty_ns
    for state, time_ns in (("quiet", total_ns - faulty_ns), ("faulty", faulty_ns)):
        figures[state] |= {"stalls": sum(get_state(begin) == state for begin in record.stalls.begins), "time_ns": time_ns}
    return figures


def _get_fault(faults: Sequence[str], index: int) -> str:
    return faults[index] if index < len(faults) else "unknown"
