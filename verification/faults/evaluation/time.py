# SPDX-License-Identifier: Apache-2.0
"""Faults of time: each fault must be reported in time and under its name, and each report must have a cause.

Design: docs/design/posix_rt.md#faults-of-time
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from verification.faults.evaluation.course import Course
from verification.faults.evaluation.evaluator import DETECTED, Evaluation, Outcome, Result, Unexpected, add_evidence, expect
from verification.faults.evaluation.host_causes import Spans
from verification.faults.evaluation.run_verdict import Evidence, assess_run
from verification.faults.evaluation.time_watch import CLOCK, HOLD, Bounds, ClockFault, Hold, WatchFinding, evaluate_watch

MINOR_FAULTS_MAX = 16
"""Maximum page faults without disk access, of all window threads together, in a run with locked memory. The kernel occasionally moves a
page."""


class Report(NamedTuple):
    """A report of the executive: an overrun of `component`, or a late release of `window` [ns]."""

    is_overrun: int
    window: int
    component: int  # -1 for a late release
    release_ns: int  # planned
    woke_ns: int  # actual
    at_ns: int  # of the report
    runner_delay_ns: int = 0  # the runner was ready but did not run, since the previous window
    component_delay_ns: int = 0  # the component was ready but did not run in this window


class Overrun(NamedTuple):
    """An injection: a component that took too long [ns]."""

    component: int
    cause: str
    begin_ns: int
    end_ns: int


class Delay(NamedTuple):
    """An injection: a window that was held back [ns]."""

    window: int
    release_ns: int
    end_ns: int


@dataclass(frozen=True)
class System:
    """Data of the system table [ns]. `loss_min_ns`: time that the host must take from a window to count as a cause, half of the budget."""

    frame_ns: int
    budget_ns: int
    loss_min_ns: int
    window_of: Sequence[int]  # of each component
    window_lengths_ns: Sequence[int]


class _Component(NamedTuple):
    window: int


class _Window(NamedTuple):
    length_ns: int


def evaluate(course: Course) -> Result:
    """@raise WorkError if the course is not complete."""
    system = System(
        frame_ns=course.get_number("frame_ns"), budget_ns=course.get_number("budget_ns"), loss_min_ns=course.get_number("loss_min_ns"),
        window_of=[row.window for row in course.get_rows("components", _Component)],
        window_lengths_ns=[row.length_ns for row in course.get_rows("windows", _Window)],
    )  # fmt: skip
    causes, faults = course.get_names("causes"), course.get_names("watch_faults")
    stalls = course.get_spans("stalls")
    overruns = [row._replace(cause=causes[int(row.cause)]) for row in course.get_rows("overruns", Overrun)]
    findings = [row._replace(fault=faults[int(row.fault)]) for row in course.get_rows("findings", WatchFinding)]
    reports = evaluate_reports(
        system, course.get_rows("reports", Report), overruns, course.get_rows("delays", Delay), stalls, course.get_spans("late_polls"))
    watch = evaluate_watch(
        Bounds(course.get_number("overdue_bound_ns"), course.get_number("rate_bound_ns")), course.get_rows("holds", Hold),
        course.get_rows("clock_faults", ClockFault), findings, stalls.merge(course.get_spans("runner_delays")))  # fmt: skip
    return _conclude(course, reports, watch)


def evaluate_reports(
    system: System, reports: Sequence[Report], overruns: Sequence[Overrun], delays: Sequence[Delay], stalls: Spans, late_polls: Spans
) -> Evaluation:
    """All lists in the order of their instants."""
    run = _Reports(system, reports, stalls, late_polls)
    for overrun in overruns:
        run.evaluate_overrun(overrun)
    for delay in delays:
        run.evaluate_delay(delay)
    return run.evaluate_rest()


def make_evidence(course: Course, reports: Evaluation, watch: Evaluation) -> tuple[Evidence, Evidence, Evidence]:
    """@return evidence of the reports, of the monitor, and of the complete run."""
    host, frames = course.get_host(), course.get_number("frames")
    windows = len(course.get_rows("windows", _Window))
    own = reports.make_evidence(host, frames * windows, course.get_number("requested"))
    own = replace(own, shown=own.shown + watch.count(*DETECTED, kind=CLOCK))
    other = replace(watch.make_evidence(host, frames, 0), shown=0)
    pages = Evidence(violations=int(not _are_pages_well(course)))
    return own, other, add_evidence(add_evidence(own, other), pages)


def _conclude(course: Course, reports: Evaluation, watch: Evaluation) -> Result:
    own, other, complete = make_evidence(course, reports, watch)
    locked_out, named = reports.count_injected("lock"), reports.count(*DETECTED, kind="lock")
    requests, stopped = course.get_number("requests"), course.get_number("reads_under_way")
    major, minor = course.get_number("major_faults"), course.get_number("minor_faults")
    found = [watch.count(*DETECTED, kind=kind) for kind in (HOLD, CLOCK)]
    is_found = expect(min(found) > 0, f"{found[0]} hangs and {found[1]} wrong clocks found")
    is_read = expect(min(requests, stopped) > 0, f"{requests} requests, stopped within one at {stopped} windows")
    parts = {
        "reports": assess_run(own),
        "watch": assess_run(other) if is_found.verdict == "passed" else is_found,
        "lock": expect(locked_out == named > 0, f"{named} of {locked_out} components that waited for a lock reported"),
        "reader": assess_run(own) if is_read.verdict == "passed" else is_read,
        "pages": expect(course.get_flag("has_storm") and _are_pages_well(course),
                        f"{major} page faults with a disk and {minor} without, page storm {course.get_flag('has_storm')}"),
    }  # fmt: skip
    facts = {
        "frames": course.get_number("frames"), "requested": own.requested, "injected": own.shown, "locked_out": locked_out,
        "major_faults": major, "minor_faults": minor, "requests": requests, "reads_under_way": stopped,
        "has_locked_memory": course.get_flag("has_locked_memory"), "reports": reports.to_json(), "watch": watch.to_json(),
    }  # fmt: skip
    return Result(assess_run(complete), facts, course.get_flag("has_priority"), parts)


def _are_pages_well(course: Course) -> bool:
    """True if there are no critical page faults. Without locked memory, nothing is required."""
    is_within = course.get_number("major_faults") == 0 and course.get_number("minor_faults") <= MINOR_FAULTS_MAX
    return is_within or not course.get_flag("has_locked_memory")


class _Reports:
    """Reports in the order of their instants; each must have a cause."""

    def __init__(self, system: System, reports: Sequence[Report], stalls: Spans, late_polls: Spans) -> None:
        self.evaluation = Evaluation()
        self.system = system
        self.reports = reports
        self.instants = [report.at_ns for report in reports]
        self.stalls = stalls
        self.late_polls = late_polls
        self.explained = [False] * len(reports)

    def evaluate_overrun(self, overrun: Overrun) -> None:
        """Reports about the window of the injection, from its begin to a frame after its end, belong to the injection. The frame excludes
        time that the host took. If the guard hangs too, it reports later, and the following windows start late."""
        last_ns = self._calc_last(overrun.end_ns)
        is_stuck = overrun.cause == "stuck_guard"
        first, is_wrongly_named = None, False
        for index in range(bisect_left(self.instants, overrun.begin_ns), len(self.reports)):
            report = self.reports[index]
            if report.at_ns > last_ns:
                break
            is_own = report.window == self.system.window_of[overrun.component] and report.component == overrun.component
            is_of_frame = report.release_ns <= overrun.begin_ns < report.release_ns + self.system.frame_ns
            if is_own and (not is_stuck or is_of_frame or not self._is_cut_short(report)):
                self.explained[index] = True
                first = first or report
            elif not report.is_overrun or (is_stuck and self._is_cut_short(report)):
                self.explained[index] = self.explained[index] or is_stuck
            else:
                is_wrongly_named = True
        self.evaluation.add_outcome(overrun.cause, self._find_outcome(overrun, first, is_wrongly_named))

    def _find_outcome(self, overrun: Overrun, first: Report | None, is_wrongly_named: bool) -> Outcome:
        if first is None:
            if overrun.cause == "lock" and overrun.end_ns - overrun.begin_ns <= self.system.budget_ns:
                return Outcome.NOT_INJECTED  # the host stalled until the mutex was released
            self.evaluation.deviations.append(overrun._asdict())
            return Outcome.WRONGLY_NAMED if is_wrongly_named else Outcome.NOT_DETECTED
        if overrun.cause == "stuck_guard":
            return Outcome.IN_TIME  # the monitor checks the time
        deadline_ns = first.woke_ns + self.system.budget_ns
        self.evaluation.add_time("detection", first.at_ns - deadline_ns)
        if first.at_ns - deadline_ns <= self.system.frame_ns:
            return Outcome.IN_TIME
        return Outcome.LATE_BY_HOST if self.stalls.overlaps(deadline_ns, first.at_ns) else Outcome.LATE

    def evaluate_delay(self, delay: Delay) -> None:
        """The delayed window must be reported as late. Later windows may be late until the schedule is met again. If one starts just before
        its end, the rest of its budget is too short."""
        is_detected = False
        for index in range(bisect_left(self.instants, delay.release_ns), len(self.reports)):
            report = self.reports[index]
            if report.release_ns > delay.end_ns:
                break
            if not report.is_overrun or self._is_cut_short(report):
                self.explained[index] = True
                is_delayed = report.window == delay.window and report.release_ns == delay.release_ns
                is_detected = is_detected or (not report.is_overrun and is_delayed)
        self.evaluation.add_outcome("delay", Outcome.IN_TIME if is_detected else Outcome.NOT_DETECTED)

    def evaluate_rest(self) -> Evaluation:
        """Reports without an injection. False reports with the same cause count once, but all their rows are kept."""
        false_until = covered_until = -1  # windows that were due before a report with a host cause have the same cause
        is_aside = False
        for index, report in enumerate(self.reports):
            if self.explained[index] or self._is_aftermath(index):
                self.explained[index] = True
                continue
            longest = self.late_polls.calc_longest_loss(report.release_ns, report.at_ns)
            is_covered = report.release_ns <= covered_until
            if longest >= self.system.loss_min_ns or (is_aside and is_covered):
                self.evaluation.unexpected[Unexpected.BY_HOST] += 1
                is_aside = True
            elif self._is_suspected(report) or is_covered:
                self.evaluation.unexpected[Unexpected.SUSPECTED] += 1
                is_aside = False
            else:
                self.evaluation.unexpected[Unexpected.FALSE] += report.release_ns > false_until
                self.evaluation.deviations.append(report._asdict())
                false_until = report.at_ns
                continue
            self.explained[index] = True
            covered_until = report.at_ns
        return self.evaluation

    def _calc_last(self, end_ns: int) -> int:
        """One frame after the end of an injection, without the time that the host took."""
        last_ns, before_ns = end_ns + self.system.frame_ns, end_ns
        while last_ns > before_ns:
            before_ns = last_ns
            last_ns = end_ns + self.system.frame_ns + self.late_polls.calc_loss(end_ns, last_ns)
        return last_ns

    def _get_end(self, report: Report) -> int:
        return report.release_ns + self.system.window_lengths_ns[report.window]

    def _is_cut_short(self, report: Report) -> bool:
        """The window started so late that less than its budget was left."""
        return report.woke_ns + self.system.budget_ns > self._get_end(report)

    def _is_suspected(self, report: Report) -> bool:
        """True if the host took half of the budget in pieces, delayed the ready runner by as much, or took a complete budget since the
        previous frame. Also true if the component was ready but did not run for half of its budget, and the report did not come too early
        for that."""
        loss_min = self.system.loss_min_ns
        is_runner_delayed = report.runner_delay_ns >= loss_min and 2 * report.runner_delay_ns >= report.woke_ns - report.release_ns
        if (
            is_runner_delayed
            or self.late_polls.calc_loss(report.release_ns, report.at_ns) >= loss_min
            or self.late_polls.calc_loss(report.release_ns - self.system.frame_ns, report.at_ns) >= self.system.budget_ns
        ):
            return True
        is_possible = report.at_ns >= min(report.woke_ns + self.system.budget_ns, self._get_end(report))
        return bool(report.is_overrun) and is_possible and report.component_delay_ns >= loss_min

    def _is_aftermath(self, index: int) -> bool:
        """Two reports of a window in consecutive frames have one cause: its work had not returned."""
        report = self.reports[index]
        for before_index in range(index - 1, -1, -1):
            before = self.reports[before_index]
            if before.release_ns + self.system.frame_ns < report.release_ns:
                return False
            is_before = before.window == report.window and before.release_ns + self.system.frame_ns == report.release_ns
            if before.is_overrun and report.is_overrun and is_before:
                return self.explained[before_index]
        return False
