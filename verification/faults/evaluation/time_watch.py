# SPDX-License-Identifier: Apache-2.0
"""Findings of the schedule monitor: it must find each hang and each wrong clock rate in time, and each finding must have a cause.

Design: docs/design/posix_rt.md#faults-of-time
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from verification.faults.evaluation.evaluator import Evaluation, Outcome, Unexpected
from verification.faults.evaluation.host_causes import Spans

HOLD = "hold"
CLOCK = "clock"


class Hold(NamedTuple):
    """The runner did not do its due work [ns]."""

    due_ns: int
    end_ns: int


class ClockFault(NamedTuple):
    """The clock ran at a wrong rate."""

    begin_ns: int
    end_ns: int
    ppm: int


class WatchFinding(NamedTuple):
    """A finding, latched until the program cleared it."""

    fault: str
    due_ns: int
    seen_ns: int
    cleared_ns: int


class Bounds(NamedTuple):
    """Declared limits, from the due time or the first wrong rate to the finding [ns]."""

    overdue_ns: int
    rate_ns: int


def evaluate_watch(
    bounds: Bounds, holds: Sequence[Hold], clock_faults: Sequence[ClockFault], findings: Sequence[WatchFinding], stalls: Spans
) -> Evaluation:
    """All lists are in the order of their instants. `stalls`: stalls of the host and of the runner."""
    watch = _Watch(findings, stalls)
    for hold in holds:
        # After the hold, the runner catches up; late work of this time belongs to the same finding.
        watch.evaluate(HOLD, hold.due_ns, hold.end_ns, "overdue", bounds.overdue_ns)
    for fault in clock_faults:
        watch.evaluate(CLOCK, fault.begin_ns, fault.end_ns, "fast_clock" if fault.ppm > 0 else "slow_clock", bounds.rate_ns)
    return watch.evaluate_rest()


class _Watch:
    def __init__(self, findings: Sequence[WatchFinding], stalls: Spans) -> None:
        self.evaluation = Evaluation()
        self.findings = findings
        self.stalls = stalls
        self.explained = [False] * len(findings)

    def evaluate(self, kind: str, begin_ns: int, end_ns: int, name: str, bound_ns: int) -> None:
        """Finds the first finding from `begin_ns` to `bound_ns` after the end. A latched overdue finding with a host cause masks a wrong
        clock."""
        is_masked = False
        outcome = None
        for index, finding in enumerate(self.findings):
            if finding.seen_ns > end_ns + bound_ns:
                break
            is_other = self.explained[index] or (kind == CLOCK and self._is_by_host(finding))
            if finding.seen_ns >= begin_ns and not is_other:
                self.explained[index] = True
                outcome = self._find_outcome(kind, finding, begin_ns, name, bound_ns)
                break
            is_masked = is_masked or finding.cleared_ns > begin_ns
        self.evaluation.add_outcome(kind, outcome or (Outcome.MASKED if is_masked else Outcome.NOT_DETECTED))

    def evaluate_rest(self) -> Evaluation:
        """Findings without an injection. A host stall explains an overdue finding, but never a wrong clock."""
        for finding, is_explained in zip(self.findings, self.explained, strict=True):
            if not is_explained:
                reason = Unexpected.BY_HOST if self._is_by_host(finding) else Unexpected.FALSE
                self.evaluation.unexpected[reason] += 1
                if reason == Unexpected.FALSE:
                    self.evaluation.deviations.append(finding._asdict())
        return self.evaluation

    def _find_outcome(self, kind: str, finding: WatchFinding, begin_ns: int, name: str, bound_ns: int) -> Outcome:
        if finding.fault != name:
            return Outcome.WRONGLY_NAMED
        self.evaluation.add_time(kind, finding.seen_ns - begin_ns)
        if finding.seen_ns - begin_ns <= bound_ns:
            return Outcome.IN_TIME
        return Outcome.LATE_BY_HOST if self.stalls.overlaps(begin_ns, finding.seen_ns) else Outcome.LATE

    def _is_by_host(self, finding: WatchFinding) -> bool:
        return finding.fault == "overdue" and self.stalls.overlaps(finding.due_ns, finding.seen_ns)
