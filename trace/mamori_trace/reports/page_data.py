# SPDX-License-Identifier: Apache-2.0
"""All data that the page script displays, as columns of plain values: compact, and quick to parse.

@satisfies SWR-TRC-060, SWR-TRC-063, SWR-TRC-064      Design: docs/design/trace.md#data-in-the-page
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from mamori_trace.base.finding import Finding, Place
from mamori_trace.checks import list_rules
from mamori_trace.model.evidence import CampaignCase
from mamori_trace.model.item import Item
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import WORST_FIRST, Verdict
from mamori_trace.readers.item_history import Change
from mamori_trace.reports.coverage_view import FunctionCoverage, make_coverage_views

MESSAGE_MAX = 4000


class Words:
    """Repeated texts, each stored once and identified by its number."""

    def __init__(self) -> None:
        self._numbers: dict[str, int] = {}

    def get_number(self, text: str) -> int:
        return self._numbers.setdefault(text, len(self._numbers))

    def list_texts(self) -> list[str]:
        return list(self._numbers)


def make_page_data(
    project: Project,
    verdicts: Mapping[str, Verdict],
    findings: list[Finding],
    anchors: Mapping[str, str],
    history: Mapping[str, list[Change]],
) -> dict[str, Any]:
    """Columns of items, results, tags, cases, findings and history. Items are referenced by number, unknown items by id."""
    ordered = order_items(project, verdicts)
    numbers = {item.id: number for number, item in enumerate(ordered)}
    files = Words()
    present = {item.level for item in ordered}
    return {
        "levels": [[level.key, level.name, level.from_children] for level in project.schema.levels.values() if level.key in present],
        "verdicts": list(reversed(WORST_FIRST)),
        "sil": list(project.schema.sil),
        "items": _make_items(ordered, verdicts, numbers, files),
        "results": _make_results(project, numbers, files),
        "unexecuted": _make_rows(
            ([_name(test.requirement, numbers), test.title, test.technique, test.polarity, *_locate(test.place, files)]
             for test in sorted(project.tests_without_result, key=lambda test: (test.place, test.requirement))),
            ("item", "title", "technique", "polarity", "file", "line")),
        "tags": _make_rows(
            ([_name(tag.requirement, numbers), tag.symbol, *_locate(tag.place, files)]
             for tag in sorted(project.tags, key=lambda tag: (tag.place, tag.requirement))),
            ("item", "symbol", "file", "line")),
        "cases": [_make_case(case, anchors, numbers) for case in sorted(project.evidence.cases, key=lambda case: case.id)],
        "rules": [[rule.id, rule.severity, rule.about] for rule in list_rules()],
        "findings": _make_rows(
            ([finding.rule, finding.severity, finding.message, _name(finding.item, numbers), *_locate(finding.place, files)]
             for finding in findings),
            ("rule", "severity", "message", "item", "file", "line")),
        "coverage": _make_coverage(project, numbers, files),
        **_make_history(history, numbers),
        "files": files.list_texts(),
    }  # fmt: skip


def order_items(project: Project, verdicts: Mapping[str, Verdict]) -> list[Item]:
    """Live items ordered by level, then by id."""
    rank = {level: index for index, level in enumerate(project.schema.levels)}
    return [project.items[key] for key in sorted(verdicts, key=lambda key: (rank[project.items[key].level], key))]


def get_area(item_id: str) -> str:
    """`SWR-SUP-001` -> `SUP`; empty for ids without an area."""
    parts = item_id.split("-")
    return parts[1] if len(parts) > 2 else ""


def _make_items(items: list[Item], verdicts: Mapping[str, Verdict], numbers: Mapping[str, int], files: Words) -> dict[str, list]:
    order = {word: index for index, word in enumerate(reversed(WORST_FIRST))}
    return {
        "id": [item.id for item in items],
        "title": [item.title for item in items],
        "statement": [item.statement for item in items],
        "rationale": [item.rationale for item in items],
        "level": [item.level for item in items],
        "area": [get_area(item.id) for item in items],
        "sil": [item.sil for item in items],
        "verify": [list(item.verify) for item in items],
        "polarity": [list(item.polarity) for item in items],
        "status": [item.status for item in items],
        "design": [item.design for item in items],
        "file": [files.get_number(item.place.file) for item in items],
        "line": [item.place.line for item in items],
        "parents": [[_name(parent, numbers) for parent in dict.fromkeys(item.parents)] for item in items],
        "verdict": [order[verdicts[item.id].word] for item in items],
        "reasons": [list(verdicts[item.id].reasons) for item in items],
    }


def _make_results(project: Project, numbers: Mapping[str, int], files: Words) -> dict[str, Any]:
    suites = Words()
    # By kind and suite; within a suite, results that did not pass come first.
    ordered = sorted(project.results, key=lambda row: (row.kind, row.suite, row.status == "passed", row.name, row.requirement))
    rows = (
        [suites.get_number(result.suite), result.name, result.kind, result.status, _name(result.requirement, numbers),
         result.technique or "requirements_based", result.polarity or "nominal", result.message[:MESSAGE_MAX] if result.status != "passed" else "",
         round(result.time_s, 4), *_locate(result.source or result.place, files)]
        for result in ordered
    )  # fmt: skip
    columns = _make_rows(rows, ("suite", "name", "kind", "status", "item", "technique", "polarity", "message", "time", "file", "line"))
    return {**columns, "suites": suites.list_texts()}


def _make_case(case: CampaignCase, anchors: Mapping[str, str], numbers: Mapping[str, int]) -> list:
    shows = [[_name(requirement, numbers), case.get_polarity(requirement)] for requirement in dict.fromkeys(case.requirements)]
    return [case.id, anchors.get(case.id, "campaign"), case.status, case.title, shows]


def _make_coverage(project: Project, numbers: Mapping[str, int], files: Words) -> dict[str, list]:
    return {
        str(numbers[key]): [_make_function(row, files) for row in functions]
        for key, functions in sorted(make_coverage_views(project).items())
        if key in numbers
    }


def _make_function(row: FunctionCoverage, files: Words) -> list:
    gaps = [[gap.place.line, gap.text, gap.reason] for gap in row.gaps]
    return [row.symbol, *_locate(row.place, files), row.executed, list(row.lines), list(row.branches), list(row.conditions), gaps, row.accepted]


def _make_history(history: Mapping[str, list[Change]], numbers: Mapping[str, int]) -> dict[str, Any]:
    """Each commit once; items refer to commits by number."""
    commits: dict[Change, int] = {}
    changes = {
        str(numbers[key]): [commits.setdefault(change, len(commits)) for change in rows]
        for key, rows in sorted(history.items())
        if key in numbers
    }
    return {"commits": [[change.commit, change.date, change.subject] for change in commits], "history": changes}


def _make_rows(rows: Iterable[list], names: tuple[str, ...]) -> dict[str, list]:
    """Rows converted to columns."""
    columns = [list(column) for column in zip(*rows, strict=True)] or [[] for _ in names]
    return dict(zip(names, columns, strict=True))


def _name(item_id: str, numbers: Mapping[str, int]) -> int | str:
    return numbers.get(item_id, item_id)


def _locate(place: Place, files: Words) -> tuple[int, int]:
    return files.get_number(place.file), place.line
