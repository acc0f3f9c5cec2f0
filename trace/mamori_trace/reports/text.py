# SPDX-License-Identifier: Apache-2.0
"""Console output: findings in the format that editors parse, a summary, and one item with its chain.

@satisfies SWR-TRC-010      Design: docs/design/trace.md#command
"""

from __future__ import annotations

import os
import textwrap
from collections import Counter
from typing import TextIO

from mamori_trace.base.finding import ERROR, Finding
from mamori_trace.model.evidence import NOT_SHOWN, SKIPPED, UNBOUND, TestResult
from mamori_trace.model.item import Item
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import FAILED, INCOMPLETE, VERIFIED, WORST_FIRST, Verdict
from mamori_trace.model.waiver import Waived

_CODES = {"red": "31", "yellow": "33", "green": "32", "dim": "2", "bold": "1"}
_VERDICT_COLOURS = {VERIFIED: "green", FAILED: "red", INCOMPLETE: "yellow"}
_WIDTH = 100


class Paint:
    """Colours text only on a terminal, and only without NO_COLOR."""

    def __init__(self, stream: TextIO) -> None:
        self._active = stream.isatty() and not os.environ.get("NO_COLOR")

    def __call__(self, text: str, colour: str) -> str:
        return f"\x1b[{_CODES[colour]}m{text}\x1b[0m" if self._active and colour in _CODES else text

    def verdict(self, word: str) -> str:
        return self(word, _VERDICT_COLOURS.get(word, "dim"))


def format_findings(findings: list[Finding], paint: Paint) -> str:
    """`file:line: severity: [rule] message`, one line each."""
    lines = []
    for finding in findings:
        severity = paint(finding.severity, "red" if finding.severity == ERROR else "yellow")
        lines.append(f"{paint(str(finding.place), 'bold')}: {severity}: [{finding.rule}] {finding.message}\n")
    return "".join(lines)


def format_waived(waived: list[Waived], paint: Paint) -> str:
    """`file:line: waived: [rule] message (reason, place of the waiver)`, one line each."""
    lines = []
    for each in waived:
        finding, waiver = each.finding, each.waiver
        why = f"{waiver.reason} ({waiver.by}, {waiver.place})"
        lines.append(f"{paint(str(finding.place), 'bold')}: {paint('waived', 'dim')}: [{finding.rule}] {finding.message}; {why}\n")
    return "".join(lines)


def format_summary(project: Project, findings: list[Finding], verdicts: dict[str, Verdict], paint: Paint) -> str:
    words = Counter(verdict.word for verdict in verdicts.values())
    counts = ", ".join(f"{words[word]} {paint.verdict(word)}" for word in reversed(WORST_FIRST) if words[word])
    severities = Counter(finding.severity for finding in findings)
    tests = len(project.results)
    statuses = Counter(result.status for result in project.results)
    apart = "".join(f", {statuses[word]} {word}" for word in (SKIPPED, UNBOUND, NOT_SHOWN) if statuses[word])
    cases = len(project.evidence.cases)
    lines = (
        f"{len(verdicts)} items: {counts or 'none'}",
        f"{len(project.tags)} code tags, {tests} test results, {cases} campaign cases{apart}",
        f"{severities[ERROR]} errors, {len(findings) - severities[ERROR]} warnings"
        + (f", {len(project.waived)} waived" if project.waived else ""),
    )
    return "\n".join(lines) + "\n"


def format_item(project: Project, item: Item, verdicts: dict[str, Verdict], paint: Paint) -> str:
    """One item with its origin, its evidence, and its objections."""
    verdict = verdicts.get(item.id, Verdict("retired"))
    lines = [f"{paint(item.id, 'bold')} {item.title}   [{paint.verdict(verdict.word)}]", f"  {item.place}", ""]
    lines += textwrap.wrap(item.statement, _WIDTH, initial_indent="  ", subsequent_indent="  ")
    about = f"SIL {item.sil} | verify: {', '.join(item.verify)} | polarity: {', '.join(item.polarity)} | {item.status}"
    lines += ["", f"  {about}", f"  design: {item.design or '-'}"]
    lines += _section("objections", verdict.reasons)
    lines += _section("parents", [_name(project, parent, verdicts, paint) for parent in item.parents])
    lines += _section("children", [_name(project, child.id, verdicts, paint) for child in project.children_of.get(item.id, [])])
    lines += _section("code", [f"{tag.place} ({tag.symbol})" for tag in project.tags_of.get(item.id, [])])
    lines += _section("results", [_describe_result(result) for result in project.results_of.get(item.id, [])])
    unexecuted = project.unexecuted_of.get(item.id, [])
    lines += _section("tests without result", [f"{test.title} ({test.place})" for test in unexecuted])
    cases = project.cases_of.get(item.id, [])
    lines += _section("campaign", [f"{case.status}  {case.id} ({case.get_polarity(item.id)})" for case in cases])
    lines += _section("coverage of its functions", _describe_coverage(project, item))
    return "\n".join(lines) + "\n"


def _describe_coverage(project: Project, item: Item) -> list[str]:
    """Coverage shares; empty if nothing was measured."""
    reached = project.measure(item.id)
    if not reached.functions_measured:
        return []
    rows = [
        f"functions executed {reached.functions_executed}/{reached.functions}",
        f"lines {reached.lines_reached}/{reached.lines}",
        f"branch outcomes {reached.branches_reached}/{reached.branches}",
        f"MC/DC {reached.conditions_shown}/{reached.conditions}",
    ]
    return [", ".join(rows)] + [f"{gap.place}: {gap.text} ({gap.reason or 'no reason'})" for gap in reached.gaps]


def _describe_result(result: TestResult) -> str:
    return f"{result.status}  {result.title} ({result.polarity or 'nominal'})  {result.source or result.place}"


def _section(title: str, rows: list[str] | tuple[str, ...]) -> list[str]:
    return ["", f"  {title}", *(f"    {row}" for row in rows)] if rows else []


def _name(project: Project, item_id: str, verdicts: dict[str, Verdict], paint: Paint) -> str:
    item = project.items.get(item_id)
    if item is None:
        return f"{item_id} (defined nowhere)"
    word = verdicts[item_id].word if item_id in verdicts else "retired"
    return f"{item_id} {item.title}  [{paint.verdict(word)}]"
