# SPDX-License-Identifier: Apache-2.0
"""Writes the report: one offline HTML file; equal inputs give equal bytes.

@satisfies SWR-TRC-011, SWR-TRC-013, SWR-TRC-061, SWR-TRC-062, SWR-TRC-066, SWR-TRC-067, SWR-TRC-068, SWR-TRC-069      Design: docs/design/trace.md#report
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

from markupsafe import Markup

from mamori_trace.base.finding import ERROR, Finding, Rule
from mamori_trace.base.write import write_whole_bytes
from mamori_trace.checks import list_rules, run_checks
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import VERIFIED, WORST_FIRST, Verdict, calc_verdicts
from mamori_trace.readers.item_history import read_item_history
from mamori_trace.reports import dashboard, v_overview
from mamori_trace.reports.answers import LINES_MAX, make_answers
from mamori_trace.reports.campaign_view import find_slowest, list_filled, make_scenario_views
from mamori_trace.reports.cost_view import make_cost_views
from mamori_trace.reports.inline_json import format_inline
from mamori_trace.reports.page_data import make_page_data, order_items
from mamori_trace.reports.size_view import make_size_views
from mamori_trace.reports.static_lists import format_files, format_suites
from mamori_trace.reports.static_view import StaticView
from mamori_trace.reports.technique_view import list_techniques
from mamori_trace.reports.templating import make_environment
from mamori_trace.reports.timing_view import make_timing_views
from mamori_trace.reports.view import describe_environment, group_tags, make_suite_views

PAPER_ITEMS_MAX = 2000

GLOSSARY = (
    ("verified", "Every demanded test and campaign case was executed and passed, from each demanded side."),
    ("failed", "A test or campaign case that names the item failed or ended in an error, or an item below it failed."),
    ("incomplete", "Nothing failed, but something that is demanded is absent or was skipped."),
    ("unbound", "The results passed, but no evidence record tells what produced them."),
    ("not shown here", "This host cannot produce a result: a privilege is missing, or the measurement was inconclusive."),
    ("not run", "The demanded tests exist and this run left them out, which was allowed for it."),
    ("draft", "The item is not approved yet; it proves nothing and nothing is demanded of it."),
    ("nominal", "Shows that the wanted thing happens."),
    ("violation", "Shows that the unwanted thing is stopped: the test violates the rule on purpose."),
    ("suspect link", "One of its ends changed since a person last looked at both together."),
    ("waived", "A finding that the project accepts for a stated reason; it does not count."),
    ("described", "Of a technique: a document tells how it is used, and no test or item shows that it was."),
    ("SIL, QM", "Safety integrity level of IEC 61508, from 1 to 4; QM: quality management is enough, safety does not rest on it."),
    ("Ss1, Sto", "Reactions of an arm. Safe stop 1: brake to standstill, then cut the torque. Safe torque off: cut it at once."),
    ("finding", "A broken link, a missing proof or an unfinished text. An error makes the check fail, a warning does not."),
)  # fmt: skip


def write_report(
    project: Project, out: Path, make_pdf: Callable[[str], None] | None = None
) -> tuple[list[Finding], dict[str, Verdict]]:
    """Checks, evaluates, draws and writes. `make_pdf` receives the print version of the page before any file is written.

    @return the findings, including those about series and pictures that cannot be displayed, and the verdicts.
    """
    context = _make_context(project)
    page = _render(context)
    if make_pdf is not None:
        make_pdf(_render(context | {"paper": True, "listed": context["ordered"][:PAPER_ITEMS_MAX]}).decode("utf-8"))
    write_whole_bytes(out, page)
    return context["findings"], context["verdicts"]


def _render(context: dict[str, Any]) -> bytes:
    page = make_environment().get_template("report.html.j2").render(context)
    # JSON of other tools may contain a lone surrogate, which files cannot store.
    return page.encode("utf-8", errors="replace")


def _make_context(project: Project) -> dict[str, Any]:
    """All names for the templates."""
    scenarios = make_scenario_views(project, project.problems)
    timing, costs = make_timing_views(project, project.problems), make_cost_views(project)
    findings = run_checks(project)
    verdicts = calc_verdicts(project)
    words = Counter(verdict.word for verdict in verdicts.values())
    anchors = {view.case.id: view.anchor for scenario in scenarios for view in scenario.cases}
    history = read_item_history(project.root)
    ordered = order_items(project, verdicts)
    static = StaticView(project, verdicts, _group_by_item(findings), anchors, history)
    suites, files = make_suite_views(project.results), group_tags(project.tags)
    return {
        "paper": False,
        "project": project,
        "environment": describe_environment(project.evidence.environment),
        "findings": findings,
        "verdicts": verdicts,
        "findings_of_rule": _group_by_rule(findings),
        "errors": sum(finding.severity == ERROR for finding in findings),
        "rules": list_rules(),
        "words": words,
        "requirements": _count_requirements(project, verdicts),
        "results": Counter("failed" if result.failing else result.status for result in project.results),
        "level_bars": dashboard.list_level_bars(project, verdicts),
        "sil_bars": dashboard.list_sil_bars(project, verdicts),
        "finding_bars": dashboard.list_finding_bars(findings),
        "result_bars": dashboard.list_result_bars(project),
        "data": Markup(format_inline(make_page_data(project, verdicts, findings, anchors, history))),
        "static": static,
        "ordered": ordered,
        "listed": ordered,
        "suites": suites,
        "suite_rows": format_suites(suites, static.link_item),
        "files": files,
        "file_rows": format_files(files, static.link_item),
        "scenarios": scenarios,
        "filled": list_filled(scenarios),
        "anchors": anchors,
        "slowest": find_slowest(scenarios),
        "timing": timing,
        "costs": costs,
        "sizes": make_size_views(project),
        "answers": make_answers(project, verdicts, findings, scenarios, [*timing, *costs]),
        "answer_lines_max": LINES_MAX,
        "verdict_words": tuple(reversed(WORST_FIRST)),
        "techniques": list_techniques(project),
        "drawings": [(layout, v_overview.make_boxes(project, verdicts, layout)) for layout in v_overview.LAYOUTS],
        "v": v_overview,
        "glossary": GLOSSARY,
    }


def _group_by_rule(findings: list[Finding]) -> list[tuple[Rule, list[Finding]]]:
    """Rules with findings, errors first, in the order of the rules."""
    groups = [(rule, [finding for finding in findings if finding.rule == rule.id]) for rule in list_rules()]
    return sorted((group for group in groups if group[1]), key=lambda group: group[0].severity != ERROR)


def _group_by_item(findings: list[Finding]) -> dict[str, list[Finding]]:
    groups: dict[str, list[Finding]] = defaultdict(list)
    for finding in findings:
        groups[finding.item].append(finding)
    return groups


def _count_requirements(project: Project, verdicts: dict[str, Verdict]) -> tuple[int, int]:
    """(verified, all) of the items with their own verification: all except needs and hazards."""
    own = [word for key, word in verdicts.items() if not project.schema.levels[project.items[key].level].from_children]
    return sum(verdict.word == VERIFIED for verdict in own), len(own)
