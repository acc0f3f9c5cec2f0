# SPDX-License-Identifier: Apache-2.0
"""Decides for every real-time run whether it passed, failed or is inconclusive.

@satisfies SWR-VER-022      Design: docs/design/test_strength.md#real-time-verdicts
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from verification.faults.evaluation.host_causes import HostFigures

Verdict = Literal["passed", "failed", "inconclusive"]

SEEN_PER_UNSEEN = 100
"""Minimum number of recorded disturbances per deviation that an unrecorded disturbance can explain. The design document has the
measurement."""

INSTANCES_PER_SET_ASIDE = 100
"""Minimum number of window instances per instance set aside. A run that sets aside more proves too little."""


@dataclass(frozen=True)
class Evidence:
    """Counts of one run. A deviation is a difference from the expected result; it belongs to exactly one of the first four counts."""

    violations: int = 0  # deviations that no host causes, for example a wrong name
    unexplained: int = 0  # deviations while the monitored clock ran without a gap
    suspected: int = 0  # deviations that the host explains in part: short stalls, switches
    set_aside: int = 0  # deviations that one stall explains alone: not assessed
    instances: int = 0  # window instances or trials of the run
    shown: int = 0  # injected faults that took effect; each had its reaction or is counted above
    requested: int = 0  # faults of the plan
    host: HostFigures = field(default_factory=HostFigures)


@dataclass(frozen=True)
class Finding:
    """The verdict on one run; `reason` is one line with the figures, empty if the run passed."""

    verdict: Verdict
    reason: str = ""


def assess_run(evidence: Evidence) -> Finding:
    """Worst condition first: a violation is a failure on any host."""
    if evidence.violations:
        return _find("failed", f"{evidence.violations} violations", evidence)
    if evidence.unexplained * SEEN_PER_UNSEEN > evidence.host.stalls:
        return _find("failed", f"{evidence.unexplained} deviations while nothing disturbed the host", evidence)
    if 20 * evidence.shown < 19 * evidence.requested:
        verdict: Verdict = "inconclusive" if evidence.host.stalls else "failed"
        return _find(verdict, f"{evidence.shown} of {evidence.requested} faults took effect", evidence)
    if evidence.unexplained:
        return _find("inconclusive", f"{evidence.unexplained} deviations that unseen disturbances may have caused", evidence)
    if evidence.suspected:
        return _find("inconclusive", f"{evidence.suspected} deviations that short losses of the host explain", evidence)
    if evidence.set_aside * INSTANCES_PER_SET_ASIDE > evidence.instances:
        return _find("inconclusive", f"{evidence.set_aside} of {evidence.instances} instances set aside", evidence)
    return Finding("passed")


def _find(verdict: Verdict, reason: str, evidence: Evidence) -> Finding:
    return Finding(verdict, f"{reason}; host: {evidence.host.to_text()}")
