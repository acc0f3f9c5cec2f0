# SPDX-License-Identifier: Apache-2.0
"""Writes the report: one HTML file without network, the same bytes for the same inputs.

@satisfies SWR-TRC-011, SWR-TRC-013      Design: docs/design/trace.md#report
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import jinja2

from mamori.trace.checks import list_rules, run_checks
from mamori.trace.model.finding import ERROR, Finding, Rule
from mamori.trace.model.item import Level
from mamori.trace.model.project import Project
from mamori.trace.model.verdict import VERIFIED, WORST_FIRST, Verdict, calc_verdicts
from mamori.trace.reports import v_overview
from mamori.trace.reports.campaign_view import find_slowest, make_scenario_views
from mamori.trace.reports.cost_view import make_cost_views
from mamori.trace.reports.timing_view import make_timing_views
from mamori.trace.reports.view import describe_environment, group_tags, make_item_views, make_suite_views
from mamori.trace.write import write_whole

_TEMPLATES = Path(__file__).parent / "templates"

GLOSSARY = (
    ("verified", "Every demanded test and campaign case was executed and passed, from each demanded side."),
    ("failed", "A test or campaign case that names the item failed or ended in an error, or an item below it failed."),
    ("incomplete", "Nothing failed, but something that is demanded is absent or was skipped."),
    ("not run", "The demanded tests exist and this run left them out, which was allowed for it."),
    ("draft", "The item is not approved yet; it proves nothing and nothing is demanded of it."),
    ("nominal", "Shows that the wanted thing happens."),
    ("violation", "Shows that the unwanted thing is stopped: the test violates the rule on purpose."),
    ("suspect link", "One of its ends changed since a person last looked at both together."),
    ("finding", "A broken link, a missing proof or an unfinished text. An error makes the check fail, a warning does not."),
)  # fmt: skip


def write_report(project: Project, out: Path) -> list[Finding]:
    """Checks, judges, draws and writes. @return the findings, including those about series and pictures that cannot be shown."""
    scenarios = make_scenario_views(project, project.problems)
    timing = make_timing_views(project, project.problems)
    findings = run_checks(project)
    verdicts = calc_verdicts(project)
    words = Counter(verdict.word for verdict in verdicts.values())
    page = _make_environment().get_template("report.html.j2").render(
        project=project,
        environment=describe_environment(project.evidence.environment),
        findings=findings,
        findings_of_rule=_group_by_rule(findings),
        errors=sum(finding.severity == ERROR for finding in findings),
        rules=list_rules(),
        words=words,
        verdict_words=[word for word in reversed(WORST_FIRST) if words[word]],
        requirements=_count_requirements(project, verdicts),
        results=Counter("failed" if result.failing else result.status for result in project.results),
        items=make_item_views(project, verdicts, findings),
        levels=_list_levels(project),
        suites=make_suite_views(project.results),
        files=group_tags(project.tags),
        scenarios=scenarios,
        anchors={view.case.id: view.anchor for scenario in scenarios for view in scenario.cases},
        slowest=find_slowest(scenarios),
        timing=timing,
        costs=make_cost_views(project),
        drawings=[(layout, v_overview.make_boxes(project, verdicts, layout)) for layout in v_overview.LAYOUTS],
        v=v_overview,
        glossary=GLOSSARY,
    )
    write_whole(out, page)
    return findings


def _make_environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["css"] = lambda word: word.replace(" ", "-")
    environment.globals["style"] = (_TEMPLATES / "style.css").read_text(encoding="utf-8")
    environment.globals["script"] = (_TEMPLATES / "script.js").read_text(encoding="utf-8")
    return environment


def _list_levels(project: Project) -> list[Level]:
    """Levels that have items."""
    present = {item.level for item in project.live_items}
    return [level for level in project.schema.levels.values() if level.key in present]


def _group_by_rule(findings: list[Finding]) -> list[tuple[Rule, list[Finding]]]:
    """Rules with findings, errors first, in the order of the rules."""
    groups = [(rule, [finding for finding in findings if finding.rule == rule.id]) for rule in list_rules()]
    return sorted((group for group in groups if group[1]), key=lambda group: group[0].severity != ERROR)


def _count_requirements(project: Project, verdicts: dict[str, Verdict]) -> tuple[int, int]:
    """(verified, all) of the items that are to be verified themselves: without needs, hazards."""
    own = [word for key, word in verdicts.items() if not project.schema.levels[project.items[key].level].from_children]
    return sum(verdict.word == VERIFIED for verdict in own), len(own)
