# SPDX-License-Identifier: Apache-2.0
"""Common parts of all evaluations: outcomes of injections, unexpected reports, and the resulting evidence.

Design: docs/design/test_strength.md#courses
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any

from verification.faults.evaluation.host_causes import HostFigures
from verification.faults.evaluation.run_verdict import Evidence, Finding

ROWS_SHOWN = 100


class Outcome(StrEnum):
    """Outcome of one injection."""

    IN_TIME = "in_time"
    LATE = "late"
    LATE_SUSPECTED = "late_suspected"  # a short stall explains a part of the delay
    LATE_BY_HOST = "late_by_host"
    EARLY = "early"  # before its bound began
    NOT_DETECTED = "not_detected"
    WRONGLY_NAMED = "wrongly_named"
    NOT_INJECTED = "not_injected"
    ENDED_BY_HOST = "ended_by_host"  # the run ended before the report was due
    MASKED = "masked"  # an earlier report was still latched


class Unexpected(StrEnum):
    """The cause of a report without an injection."""

    FALSE = "false"
    SUSPECTED = "suspected"  # the host explains the report in part
    BY_HOST = "by_host"


DETECTED = (Outcome.IN_TIME, Outcome.LATE, Outcome.LATE_SUSPECTED, Outcome.LATE_BY_HOST, Outcome.EARLY)
NOT_SHOWN = (Outcome.NOT_INJECTED, Outcome.ENDED_BY_HOST, Outcome.MASKED)


@dataclass
class Evaluation:
    """Injections and unexpected reports of one run, added as they are found."""

    outcomes: list[tuple[str, Outcome]] = field(default_factory=list)  # kind and outcome of each injection
    unexpected: Counter[Unexpected] = field(default_factory=Counter)
    times_ns: dict[str, list[int]] = field(default_factory=dict)  # from the due time to the report
    deviations: list[Mapping[str, Any]] = field(default_factory=list)  # rows of the course that have no explanation

    def add_outcome(self, kind: str, outcome: Outcome) -> None:
        self.outcomes.append((kind, outcome))

    def add_time(self, name: str, time_ns: int) -> None:
        self.times_ns.setdefault(name, []).append(time_ns)

    def count(self, *outcomes: Outcome, kind: str = "") -> int:
        return sum(outcome in outcomes and kind in ("", name) for name, outcome in self.outcomes)

    def count_injected(self, kind: str = "") -> int:
        """Injections that took effect."""
        return sum(outcome not in NOT_SHOWN and kind in ("", name) for name, outcome in self.outcomes)

    def make_evidence(self, host: HostFigures, instances: int, requested: int) -> Evidence:
        return Evidence(
            violations=self.count(Outcome.NOT_DETECTED, Outcome.WRONGLY_NAMED, Outcome.EARLY),
            unexplained=self.count(Outcome.LATE) + self.unexpected[Unexpected.FALSE],
            suspected=self.count(Outcome.LATE_SUSPECTED) + self.unexpected[Unexpected.SUSPECTED],
            set_aside=self.count(Outcome.LATE_BY_HOST, Outcome.ENDED_BY_HOST) + self.unexpected[Unexpected.BY_HOST],
            instances=instances,
            shown=self.count_injected(),
            requested=requested,
            host=host,
        )  # fmt: skip

    def to_json(self) -> dict[str, Any]:
        kinds = dict.fromkeys(kind for kind, _ in self.outcomes)
        return {
            "outcomes": {kind: dict(sorted(Counter(str(outcome) for name, outcome in self.outcomes if name == kind).items())) for kind in kinds},
            "unexpected": {str(reason): self.unexpected[reason] for reason in Unexpected},
            "times": {name: summarize(times) for name, times in self.times_ns.items()},
            "deviations": len(self.deviations),
            "first_deviations": list(self.deviations[:ROWS_SHOWN]),
        }


@dataclass(frozen=True)
class Result:
    """The verdict on one course. `parts` are the findings for single requirements."""

    finding: Finding
    facts: Mapping[str, Any]
    has_priority: bool
    parts: Mapping[str, Finding] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        parts = {name: {"verdict": part.verdict, "reason": part.reason} for name, part in self.parts.items()}
        return {"schema": "mamori.fault_verdict/1", "verdict": self.finding.verdict, "reason": self.finding.reason,
                "has_priority": self.has_priority, "parts": parts, **self.facts}  # fmt: skip


def add_evidence(evidence: Evidence, other: Evidence) -> Evidence:
    """@return the deviations of both, and the other figures of the first."""
    return replace(
        evidence,
        violations=evidence.violations + other.violations,
        unexplained=evidence.unexplained + other.unexplained,
        suspected=evidence.suspected + other.suspected,
        set_aside=evidence.set_aside + other.set_aside,
    )


def expect(is_met: bool, text: str) -> Finding:
    """A finding that has no host cause."""
    return Finding("passed") if is_met else Finding("failed", text)


def summarize(times: Sequence[int], parts: Sequence[tuple[str, int]] = (("p50_ns", 5000), ("p99_ns", 9900), ("max_ns", 10000))) -> dict[str, int]:
    """Number and quantiles (name and share of 10,000) of measured times."""
    ordered = sorted(times)
    return {"count": len(ordered), **{name: ordered[(len(ordered) - 1) * share // 10000] if ordered else 0 for name, share in parts}}
