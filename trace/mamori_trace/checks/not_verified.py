# SPDX-License-Identifier: Apache-2.0
"""Approved items without a passed result of a required kind, if no other rule reports the cause.

@satisfies SWR-TRC-100      Design: docs/design/trace.md#approved-items
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.item import DRAFT
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import NOT_SHOWN, UNBOUND, VERIFIED, calc_verdicts, judge_method

RULE = Rule("not-verified", ERROR, "Every approved item has a passed result of each kind that it demands.")

_OTHERS_TELL = (VERIFIED, DRAFT, NOT_SHOWN, UNBOUND)
_EXECUTED = {"test", "campaign"}
"""Methods that results show; separate rules check reviews and analyses."""
_TELLING = {"malformed-item", "code-missing", "test-missing", "polarity-missing", "campaign-missing", "result-failed", "result-skipped",
            "result-missing", "review-missing", "suspect-link", "unreadable-input", "duplicate-id", "id-reused"}  # fmt: skip
"""Rules that report the cause at the item itself."""


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    """Runs after the other rules; `project.told` holds their findings."""
    if project.allow_missing:
        return
    told = {item for rule, item in project.told if rule in _TELLING}
    told |= {name for case in project.evidence.cases if not case.passed for name in case.requirements}
    verdicts = calc_verdicts(project)
    for item in project.live_items:
        verdict = verdicts[item.id]
        demanded = item.approved and _EXECUTED & set(item.verify) and not project.schema.levels[item.level].from_children
        if not demanded or verdict.word in _OTHERS_TELL or item.id in told:
            continue
        children = [child for child in project.children_of.get(item.id, []) if child.id in verdicts]
        if any(child.approved and verdicts[child.id].word not in _OTHERS_TELL for child in children):
            continue  # the child has the finding; the item is a consequence
        methods = [method for method in item.verify if method in _EXECUTED]
        if any(judge_method(project, item, method, children, verdicts) for method in methods):
            yield item.find_place("Verify"), f"{item.id} is {verdict.word}: {'; '.join(verdict.reasons)}", item.id
