# SPDX-License-Identifier: Apache-2.0
"""The impact of a change as text and as JSON, with the commands that run the touched tests again.

@satisfies SWR-TRC-072      Design: docs/design/trace.md#impact
"""

from __future__ import annotations

import json
import shlex
from dataclasses import asdict
from typing import Any

from mamori_trace.model.evidence import CampaignCase, SourceTest
from mamori_trace.model.impact import Impact, ItemChange, Part, Redo
from mamori_trace.model.project import Project

SCHEMA = "mamori.impact/1"
_BATCH = 100  # maximum number of names on one command line


def format_text(impact: Impact, project: Project, shown: str) -> str:
    """One section for each kind of affected part. An empty section is shown if its absence could be misunderstood."""
    lines = [f"impact of {shown}"]
    lines += _section("changed items", [_describe_change(each) for each in impact.items])
    lines += _section("changed functions and files", [_describe_part(part) for part in impact.parts if not part.is_test])
    lines += _section("changed tests", [f"{part.file}: {part.name} {part.state}" for part in impact.parts if part.is_test])
    lines += _section("changed design headings", [f"{part.file}#{part.name} {part.state}" + _list_ids(part) for part in impact.headings])
    touched = [row for key, why in impact.causes.items() for row in _describe_item(project, key, why)]
    lines += _section("touched requirements", touched)
    lines += _section("above them", [_name(project, key) for key in impact.above])
    lines += _section("tests to run again", [f"{test.title} ({test.requirement}, {test.place})" for test in impact.tests])
    lines += _section("removed tests", [f"{test.title} ({test.requirement})" for test in impact.removed_tests])
    lines += _section("campaign cases to run again", [f"{case.id} ({', '.join(case.requirements)})" for case in impact.cases])
    lines += _section("run", list_commands(impact))
    lines += _section("links to review", [_describe_review(each) for each in impact.reviews])
    lines += _section("changed, and owned by no item that is known", impact.unattributed)
    if not project.evidence.has_campaign:
        lines += ["", "no campaign evidence is at hand, so no campaign case can be named"]
    open_reviews = sum(not each.recorded for each in impact.reviews)
    lines += ["", f"{len(impact.causes)} requirements touched, {len(impact.above)} above them, {_count_tests(impact.tests)} tests and "
                  f"{len(impact.cases)} campaign cases to run, {open_reviews} reviews open"]  # fmt: skip
    return "\n".join(lines) + "\n"


def format_json(impact: Impact, project: Project, old: str, new: str) -> str:
    """The same facts for programs."""
    content: dict[str, Any] = {
        "schema": SCHEMA,
        "from": old,
        "to": new,
        "items": [{"id": each.id, "state": each.state, "fields": list(each.fields)} for each in impact.items],
        "functions": [_make_part(part) for part in impact.parts if not part.is_test],
        "changed_tests": [_make_part(part) for part in impact.parts if part.is_test],
        "headings": [_make_part(part) for part in impact.headings],
        "requirements": [{"id": key, "causes": why} for key, why in impact.causes.items()],
        "above": impact.above,
        "tests": [_make_test(test) for test in impact.tests],
        "removed_tests": [_make_test(test) for test in impact.removed_tests],
        "cases": [case.id for case in impact.cases],
        "has_campaign": project.evidence.has_campaign,
        "commands": list_commands(impact),
        "reviews": [asdict(each) for each in impact.reviews],
        "unattributed": impact.unattributed,
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def list_commands(impact: Impact) -> list[str]:
    """Command lines that repeat the tests and the cases, to run in the project folder."""
    files = [(test, test.place.file) for test in impact.tests]
    scripts = dict.fromkeys(_make_node_id(test) for test, file in files if file.endswith(".py"))
    names = dict.fromkeys(f"*{test.suite}*.{test.name}*" for test, file in files if not file.endswith(".py"))
    commands = [f"GTEST_FILTER={shlex.quote(':'.join(batch))} ctest --test-dir build/host-release" for batch in _split(list(names))]
    commands += [f".venv/bin/python -P -m pytest {' '.join(map(shlex.quote, batch))}" for batch in _split(list(scripts))]
    return commands + _list_scenarios(impact.cases)


def _list_scenarios(cases: list[CampaignCase]) -> list[str]:
    scenarios = sorted({case.scenario for case in cases})
    return [f"./mamori demo --scenario {' '.join(map(shlex.quote, scenarios))}"] if scenarios else []


def _split(names: list[str]) -> list[list[str]]:
    return [names[start : start + _BATCH] for start in range(0, len(names), _BATCH)]


def _make_node_id(test: SourceTest) -> str:
    return "::".join([test.place.file, *test.suite.split(".")[1:], test.name])


def _count_tests(tests: list[SourceTest]) -> int:
    return len({(test.place.file, test.suite, test.name) for test in tests})


def _section(title: str, rows: list[str]) -> list[str]:
    return ["", title, *(f"  {row}" for row in rows)] if rows else []


def _describe_change(change: ItemChange) -> str:
    return f"{change.id} {change.state}" + (f": {', '.join(change.fields)}" if change.fields else "")


def _describe_review(redo: Redo) -> str:
    return f"{redo.child} -> {redo.parent}: {redo.why}" + (" (recorded)" if redo.recorded else "")


def _describe_part(part: Part) -> str:
    return f"{part.file}: {part.name} {part.state}" + (_list_ids(part) or " (owned by no requirement)")


def _list_ids(part: Part) -> str:
    return f" [{', '.join(part.requirements)}]" if part.requirements else ""


def _describe_item(project: Project, key: str, why: list[str]) -> list[str]:
    return [_name(project, key), *(f"  because {cause}" for cause in why)]


def _name(project: Project, key: str) -> str:
    item = project.items.get(key)
    return f"{key} {item.title}" if item else f"{key} (not defined any more)"


def _make_part(part: Part) -> dict[str, Any]:
    return {"file": part.file, "name": part.name, "state": part.state, "requirements": list(part.requirements)}


def _make_test(test: SourceTest) -> dict[str, Any]:
    return {"test": test.title, "requirement": test.requirement, "file": test.place.file, "line": test.place.line}
