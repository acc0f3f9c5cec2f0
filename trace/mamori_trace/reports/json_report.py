# SPDX-License-Identifier: Apache-2.0
"""The same facts as the console output, for programs."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import asdict
from typing import Any

from mamori_trace.base.finding import Finding
from mamori_trace.checks import list_rules
from mamori_trace.model.item import Item
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import Verdict

SCHEMA = "mamori_trace/1"


def format_json(project: Project, findings: list[Finding], verdicts: dict[str, Verdict]) -> str:
    """Findings, rules and the verdict of every item."""
    content = {
        "schema": SCHEMA,
        "summary": {
            "items": len(verdicts),
            "verdicts": dict(sorted(Counter(verdict.word for verdict in verdicts.values()).items())),
            "severities": dict(sorted(Counter(finding.severity for finding in findings).items())),
            "waived": len(project.waived),
            "results": len(project.results),
            "statuses": dict(sorted(Counter(result.status for result in project.results).items())),
            "cases": len(project.evidence.cases),
        },
        "rules": [{"id": rule.id, "severity": rule.severity, "about": rule.about} for rule in list_rules()],
        "findings": [make_finding(finding) for finding in findings],
        "waived": [
            {
                **make_finding(each.finding),
                "reason": each.waiver.reason,
                "by": each.waiver.by,
                "expires": each.waiver.expires,
                "waiver": str(each.waiver.place),
            }
            for each in project.waived
        ],
        "items": [make_item(project, project.items[key], verdicts) for key in sorted(verdicts)],
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def make_finding(finding: Finding) -> dict[str, Any]:
    """One finding as plain values."""
    return {
        "rule": finding.rule,
        "severity": finding.severity,
        "file": finding.place.file,
        "line": finding.place.line,
        "item": finding.item,
        "message": finding.message,
    }


def make_item(project: Project, item: Item, verdicts: dict[str, Verdict]) -> dict[str, Any]:
    """One item with its links and evidence, as plain values."""
    verdict = verdicts.get(item.id, Verdict("retired"))
    return {
        "id": item.id,
        "title": item.title,
        "statement": item.statement,
        "sil": item.sil,
        "status": item.status,
        "verify": list(item.verify),
        "polarity": list(item.polarity),
        "design": item.design,
        "file": item.place.file,
        "line": item.place.line,
        "verdict": verdict.word,
        "reasons": list(verdict.reasons),
        "parents": list(item.parents),
        "children": [child.id for child in project.children_of.get(item.id, [])],
        "code": [str(tag.place) for tag in project.tags_of.get(item.id, [])],
        "results": [
            {"test": result.title, "status": result.status, "polarity": result.polarity}
            for result in project.results_of.get(item.id, [])
        ],
        "cases": [{"case": case.id, "passed": case.passed, "status": case.status} for case in project.cases_of.get(item.id, [])],
        "coverage": _make_coverage(project, item),
    }


def _make_coverage(project: Project, item: Item) -> dict[str, Any] | None:
    """Coverage of the functions that the item owns; null if nothing was measured."""
    reached = project.measure(item.id)
    if not reached.functions_measured:
        return None
    content = asdict(reached)
    del content["accepted"], content["gaps"]
    gaps = [{"file": gap.place.file, "line": gap.place.line, "text": gap.text, "reason": gap.reason} for gap in reached.gaps]
    return {**content, "gaps": gaps}
