# SPDX-License-Identifier: Apache-2.0
"""The rules, one per file. A rule is a module with `RULE` and `check(project)`, which yields (place, message, item id).

@satisfies SWR-TRC-010      Design: docs/design/trace.md#rules
"""

from __future__ import annotations

from types import ModuleType

from mamori_trace.base.finding import OFF, Finding, Rule
from mamori_trace.checks import (
    analysis_finding,
    campaign_missing,
    child_missing,
    code_missing,
    cycle,
    decomposition_unsound,
    decomposition_unused,
    design_link,
    design_missing,
    document_link,
    duplicate_id,
    evidence_altered,
    evidence_stale,
    function_unexecuted,
    id_reused,
    id_unrecorded,
    independence_missing,
    integration_missing,
    level_order,
    link_kind,
    malformed_item,
    mcdc_gap,
    not_verified,
    parent_missing,
    polarity_missing,
    refinement_missing,
    result_failed,
    result_flaky,
    result_missing,
    result_not_shown,
    result_skipped,
    result_unbound,
    retired_id,
    review_missing,
    review_unused,
    shall_count,
    sil_lower,
    suspect_link,
    technique_unshown,
    test_missing,
    test_unlinked,
    unfinished_text,
    unknown_id,
    unknown_word,
    unreadable_input,
    untraced_function,
    violation_not_demanded,
    waiver_expired,
    waiver_unused,
    waiver_without_reason,
    weak_word,
)
from mamori_trace.model.project import Project
from mamori_trace.model.waiver import split_waived

RULES = (
    unreadable_input,
    malformed_item,
    duplicate_id,
    id_reused,
    id_unrecorded,
    unknown_id,
    unknown_word,
    retired_id,
    parent_missing,
    child_missing,
    refinement_missing,
    level_order,
    link_kind,
    cycle,
    sil_lower,
    decomposition_unused,
    decomposition_unsound,
    shall_count,
    unfinished_text,
    weak_word,
    design_link,
    design_missing,
    document_link,
    code_missing,
    untraced_function,
    test_missing,
    polarity_missing,
    violation_not_demanded,
    campaign_missing,
    integration_missing,
    review_missing,
    review_unused,
    independence_missing,
    technique_unshown,
    suspect_link,
    result_failed,
    result_skipped,
    result_not_shown,
    result_missing,
    result_unbound,
    result_flaky,
    function_unexecuted,
    mcdc_gap,
    analysis_finding,
    test_unlinked,
    evidence_stale,
    evidence_altered,
)

# Reports problems that the other rules do not report.
REST_RULES = (not_verified,)

# Compare the waivers with the waived findings, so they run after all other rules.
LATE_RULES = (waiver_without_reason, waiver_expired, waiver_unused)


def list_rules() -> list[Rule]:
    """All rules, in the order of their subjects for a reader."""
    return [module.RULE for module in RULES + REST_RULES + LATE_RULES]


def list_rule_ids() -> list[str]:
    """Names that waivers and rule packs may use."""
    return [rule.id for rule in list_rules()]


def describe_rules() -> dict[str, str]:
    """The purpose of each rule: the first sentence of its module."""
    return {module.RULE.id: (module.__doc__ or "").strip().partition("\n")[0] for module in RULES + REST_RULES + LATE_RULES}


def run_checks(project: Project) -> list[Finding]:
    """All counted findings of all rules, ordered by file and line; adds waived findings to `project.waived`."""
    found = _run(RULES, project)
    project.told = frozenset((finding.rule, finding.item) for finding in found)
    findings, waived = split_waived(found + _run(REST_RULES, project), project.waivers, project.date)
    project.waived = sorted(waived, key=lambda each: each.finding.sort_key())
    return sorted(findings + _run(LATE_RULES, project), key=Finding.sort_key)


def _run(modules: tuple[ModuleType, ...], project: Project) -> list[Finding]:
    """Findings with the severity that the rule pack gives them for the SIL of their item."""
    findings = []
    for module in modules:
        for place, message, item in module.check(project):
            severity = project.pack.get_severity(module.RULE, project.items.get(item))
            if severity != OFF:
                severity = module.RULE.release if project.release and module.RULE.release else severity
                findings.append(Finding(module.RULE.id, severity, place, message, item))
    return findings
