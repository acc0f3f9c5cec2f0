# SPDX-License-Identifier: Apache-2.0
"""Waivers: findings that the project accepts for a stated reason and a limited time.

@satisfies SWR-TRC-021      Design: docs/design/trace.md#waivers
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

from mamori_trace.base.finding import Finding, Place


@dataclass(frozen=True, slots=True)
class Waiver:
    """One row of requirements/waivers.toml. `expires` is its last valid day, or empty."""

    rule: str
    item: str
    file: str
    reason: str
    expires: str
    by: str
    place: Place

    def is_expired(self, date: str) -> bool:
        """Whether the waiver has expired on `date`. If `date` is unknown, a waiver with an end counts as expired."""
        return bool(self.expires) and (not date or date > self.expires)

    def covers(self, finding: Finding) -> bool:
        """Whether the waiver covers the finding."""
        same_rule = finding.rule == self.rule
        return same_rule and self.item in ("", finding.item) and self.file in ("", finding.place.file)


@dataclass(frozen=True, slots=True)
class Waived:
    """A finding that does not count, and the reason."""

    finding: Finding
    waiver: Waiver


def split_waived(findings: list[Finding], waivers: list[Waiver], date: str) -> tuple[list[Finding], list[Waived]]:
    """(counted findings, waived findings). A waiver that is expired or has no reason waives nothing."""
    of_rule: dict[str, list[Waiver]] = defaultdict(list)
    for waiver in waivers:
        if waiver.reason and not waiver.is_expired(date):
            of_rule[waiver.rule].append(waiver)
    counting: list[Finding] = []
    waived: list[Waived] = []
    for finding in findings:
        covering = next((each for each in of_rule.get(finding.rule, ()) if each.covers(finding)), None)
        if covering is None:
            counting.append(finding)
        else:
            waived.append(Waived(finding, covering))
    return counting, waived
