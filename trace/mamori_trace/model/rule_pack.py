# SPDX-License-Identifier: Apache-2.0
"""Rule packs: the severity of each rule for an item of a given SIL and status.

@satisfies SWR-TRC-020      Design: docs/design/trace.md#rule-packs
"""

from __future__ import annotations

from dataclasses import dataclass, field

from mamori_trace.base.finding import ERROR, OFF, WARNING, Rule
from mamori_trace.model.item import Item

SEVERITIES = (ERROR, WARNING, OFF)  # strictest first


@dataclass(frozen=True, slots=True)
class Grades:
    """The severities of one rule: by SIL, and by status, which overrides the SIL."""

    of_sil: dict[str, str] = field(default_factory=dict)
    of_status: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class RulePack:
    """Grades by rule id. A rule or SIL without an entry uses the severity of the rule itself."""

    grades: dict[str, Grades] = field(default_factory=dict)
    sil: tuple[str, ...] = ()

    def get_severity(self, rule: Rule, item: Item | None) -> str:
        """Severity of a finding about `item`. The strictest severity if there is no item or its SIL is not readable."""
        grades = self.grades.get(rule.id)
        if grades is None:
            return rule.severity
        if item is not None and item.status in grades.of_status:
            return grades.of_status[item.status]
        if item is not None and item.sil:
            return grades.of_sil.get(item.sil, rule.severity)
        return min((grades.of_sil.get(sil, rule.severity) for sil in self.sil), key=SEVERITIES.index, default=rule.severity)
