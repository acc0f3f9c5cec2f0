# SPDX-License-Identifier: Apache-2.0
"""The rules, one per file. A rule is a module with `RULE` and `check(project)`, which yields (place, message, item id).

@satisfies SWR-TRC-010      Design: docs/design/trace.md#rules
"""

from __future__ import annotations

from mamori.trace.checks import (
    code_missing,
    cycle,
    design_link,
    duplicate_id,
    evidence_stale,
    campaign_missing,
    child_missing,
    function_unexecuted,
    level_order,
    malformed_item,
    mcdc_gap,
    parent_missing,
    polarity_missing,
    result_failed,
    result_missing,
    result_skipped,
    retired_id,
    shall_count,
    sil_lower,
    suspect_link,
    test_missing,
    test_unlinked,
    unfinished_text,
    unknown_id,
    unknown_word,
    unreadable_input,
    untraced_function,
)
from mamori.trace.model.finding import Finding, Rule
from mamori.trace.model.project import Project

RULES = (
    unreadable_input,
    malformed_item,
    duplicate_id,
    unknown_id,
    unknown_word,
    retired_id,
    parent_missing,
    child_missing,
    level_order,
    cycle,
    sil_lower,
    shall_count,
    unfinished_text,
    design_link,
    code_missing,
    untraced_function,
    test_missing,
    polarity_missing,
    campaign_missing,
    suspect_link,
    result_failed,
    result_skipped,
    result_missing,
    function_unexecuted,
    mcdc_gap,
    test_unlinked,
    evidence_stale,
)


def list_rules() -> list[Rule]:
    """All rules in the order in which a reader meets their subjects."""
    return [module.RULE for module in RULES]


def run_checks(project: Project) -> list[Finding]:
    """All findings of all rules, in order of file and line."""
    findings = [
        Finding(module.RULE.id, module.RULE.severity, place, message, item)
        for module in RULES
        for place, message, item in module.check(project)
    ]
    return sorted(findings, key=Finding.sort_key)
