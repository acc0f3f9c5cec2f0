# SPDX-License-Identifier: Apache-2.0
"""The first three questions of a reader: is it safe, is it complete, what is wrong. Each answer links to the counted rows.

@satisfies SWR-TRC-069      Design: docs/design/trace.md#report
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from urllib.parse import urlencode

from mamori_trace.base.finding import ERROR, Finding
from mamori_trace.model.evidence import PASSED
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import FAILED, VERIFIED, WORST_FIRST, Verdict
from mamori_trace.reports.campaign_view import ScenarioView, find_slowest
from mamori_trace.reports.cost_view import CostView
from mamori_trace.reports.timing_view import TimingView

LINES_MAX = 4
RULES_MAX = 3


@dataclass(frozen=True, slots=True)
class Line:
    """One line below an answer. `css` colours it; `target` is the view that a click opens."""

    text: str
    target: str
    css: str = ""


@dataclass(frozen=True, slots=True)
class Answer:
    """`word` answers `question` in a few characters; `lines` contain the facts, worst first."""

    question: str
    word: str
    css: str
    lines: tuple[Line, ...]


def make_answers(
    project: Project,
    verdicts: Mapping[str, Verdict],
    findings: Sequence[Finding],
    scenarios: list[ScenarioView],
    measured: Sequence[TimingView | CostView],
) -> list[Answer]:
    """The three answers. `measured`: systems with real-time measurements or counted steps."""
    return [_answer_safe(project, verdicts, scenarios), _answer_complete(project, verdicts), _answer_wrong(project, findings, measured)]


def _answer_safe(project: Project, verdicts: Mapping[str, Verdict], scenarios: list[ScenarioView]) -> Answer:
    """From the fault campaign and the items with a safety integrity level. A positive answer requires success of all of them."""
    items = {key: verdict.word for key, verdict in verdicts.items() if project.items[key].sil.isdecimal()}
    cases = project.evidence.cases
    good = sum(case.status == PASSED for case in cases)
    failed = sum(case.status == FAILED for case in cases)
    words = Counter(items.values())
    lines = []
    if cases:
        lines.append(Line(f"{good:,} of {len(cases):,} campaign cases ended as expected", "#campaign", "failed" if failed else ""))
    else:
        lines.append(Line("no fault campaign was run", "#campaign", "not-run"))
    if items:
        levels = sorted({project.items[key].sil for key in items})
        target = "#matrix?" + urlencode([("sil", sil) for sil in levels])
        lines.append(Line(f"{words[VERIFIED]:,} of {len(items):,} items with a SIL verified", target, "failed" if words[FAILED] else ""))
    if slowest := find_slowest(scenarios):
        lines.append(Line(f"slowest reaction: {slowest.reaction_time}", f"#{slowest.anchor}", "failed" if (slowest.share or 0) > 1 else ""))
    if failed or words[FAILED]:
        return Answer("Is it safe?", "No", "failed", tuple(lines))
    if cases and good == len(cases) and words[VERIFIED] == len(items):
        return Answer("Is it safe?", "Yes, as far as shown", "verified", tuple(lines))
    return Answer("Is it safe?", "Not fully shown", "incomplete", tuple(lines))


def _answer_complete(project: Project, verdicts: Mapping[str, Verdict]) -> Answer:
    words = Counter(verdict.word for verdict in verdicts.values())
    lines = [Line(f"{words[VERIFIED]:,} of {len(verdicts):,} items verified", "#matrix")]
    for word in WORST_FIRST:
        if words[word] and word != VERIFIED:
            lines.append(Line(f"{words[word]:,} {word}", f"#matrix?{urlencode({'verdict': word})}", word.replace(" ", "-")))
    if missing := len(project.tests_without_result):
        lines.append(Line(f"{missing:,} {_plural(missing, 'test')} without a result", "#tests?status=not+run", "not-run"))
    is_complete = bool(verdicts) and words[VERIFIED] == len(verdicts) and not missing
    return Answer("Is it complete?", "Yes" if is_complete else "No", "verified" if is_complete else "incomplete", tuple(lines))


def _answer_wrong(project: Project, findings: Sequence[Finding], measured: Sequence[TimingView | CostView]) -> Answer:
    """Failures first, then check findings, beginning with the rules with the most errors."""
    lines = []
    if count := len({result.title for result in project.results if result.failing}):
        lines.append(Line(f"{count:,} failed {_plural(count, 'test')}", "#tests?status=failed", "failed"))
    if count := sum(case.status == FAILED for case in project.evidence.cases):
        lines.append(Line(f"{count:,} failed campaign {_plural(count, 'case')}", "#campaign", "failed"))
    lines += [Line(f"{view.title}: {view.result[0]}", f"#{view.anchor}", "failed") for view in measured if view.result[1] == "failed"]
    rules = Counter((finding.severity != ERROR, finding.rule) for finding in findings)
    for (is_warning, rule), count in sorted(rules.items(), key=lambda row: (row[0][0], -row[1], row[0][1]))[:RULES_MAX]:
        word = "warning" if is_warning else "error"
        lines.append(Line(f"{rule}: {count:,} {_plural(count, word)}", f"#findings?{urlencode({'rule': rule})}", "warning" if is_warning else "failed"))
    errors = sum(finding.severity == ERROR for finding in findings)
    if errors:
        return Answer("What is wrong?", f"{errors:,} {_plural(errors, 'error')}", "failed", tuple(lines))
    if any(line.css == "failed" for line in lines):
        return Answer("What is wrong?", "See below", "failed", tuple(lines))
    if findings:
        return Answer("What is wrong?", f"{len(findings):,} {_plural(len(findings), 'warning')}", "warning", tuple(lines))
    return Answer("What is wrong?", "No findings", "verified", (Line("all checks ran", "#findings"),))


def _plural(count: int, noun: str) -> str:
    return noun if count == 1 else f"{noun}s"
