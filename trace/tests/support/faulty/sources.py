# SPDX-License-Identifier: Apache-2.0
"""Writes code, tests and results of a plan; each format has its own notation of a tag."""

from __future__ import annotations

import json
from collections.abc import Callable

from faulty.page import Pages
from faulty.plan import Plan, Test

_PER_FILE = 10
_INNER = {
    "flaky": '<flakyFailure message="late"/>',
    "failed": '<failure message="value is wrong"/>',
    "error": '<error message="crashed"/>',
    "skipped": '<skipped message="no hardware"/>',
}


def write_sources(plan: Plan, pages: Pages, code_tag: str, test_tag: str, native: bool = False) -> None:
    """`code_tag` and `test_tag` are comments with a field for the id."""
    for number, code in enumerate(plan.code):
        file = f"src/part_{number // _PER_FILE}.cpp"
        if file not in pages.files:
            pages.add(file, "// SPDX-License-Identifier: Apache-2.0")
        pages.add(file, "")
        for requirement in code.requirements:
            pages.add(file, code_tag.format(requirement), (requirement, "code"))
        pages.add(file, f"int {code.function}(int value) {{ return value + {number}; }}", (code.function, "function"))
    if plan.traced:
        pages.add("requirements/schema/code.toml", 'schema = "mamori.code/1"\ntraced = ["src"]')
    for number, test in enumerate(each for each in plan.tests if not each.result_only):
        file = f"tests/part_{number // _PER_FILE}_test.cpp"
        if file not in pages.files:
            pages.add(file, "// SPDX-License-Identifier: Apache-2.0")
        _write_test(test, pages, file, test_tag, native)


def _write_test(test: Test, pages: Pages, file: str, tag: str, native: bool) -> None:
    named = (test.requirement, "test")
    pages.add(file, "")
    if not native and test.requirement:
        pages.add(file, tag.format(test.requirement), named)
    pages.add(file, f"TEST({test.suite}, {test.name}) {{")
    if native and test.requirement:
        pages.add(file, f'    verifies("{test.requirement}");', named)
    pages.add(file, "    EXPECT_TRUE(reported());")
    pages.add(file, "}")


def write_results(plan: Plan, pages: Pages, folder: str, properties: Callable[[Test], dict[str, str]]) -> None:
    """JUnit in the form of GoogleTest, and the environment of the run."""
    file = f"{folder}/tests.xml"
    pages.add(file, '<?xml version="1.0" encoding="UTF-8"?>')
    pages.add(file, '<testsuites name="AllTests"><testsuite name="Generated">')
    for test in plan.tests:
        if not test.outcome:
            continue
        status = "notrun" if test.outcome == "disabled" else "run"
        named = {**properties(test), **({"technique": test.technique} if test.technique != "requirements_based" else {})}
        where = ((test.requirement, "result"), (test.name, "result"))
        pages.add(file, f'<testcase name="{test.name}" classname="{test.suite}" status="{status}" time="0.001">', *where)
        pages.add(file, _INNER.get(test.outcome, "<system-out/>"))
        inner = "".join(f'<property name="{key}" value="{value}"/>' for key, value in named.items())
        pages.add(file, f"<properties>{inner}</properties></testcase>")
    pages.add(file, "</testsuite></testsuites>")
    for number in range(plan.broken_results):
        pages.add(f"{folder}/broken_{number}.xml", "<testsuites>")
        pages.add(f"{folder}/broken_{number}.xml", '<testsuite name="Cut"><testcase name="Off"', (f"broken_{number}", "result"))


def write_environment(plan: Plan, pages: Pages, folder: str) -> None:
    content = {"schema": "mamori.environment/1", "commit": plan.commit, "dirty": False, "date_utc": "2026-11-21T10:00:00+00:00"}
    if plan.coverage:
        _write_coverage(plan, pages, f"{folder}/coverage/coverage.json")
    pages.add(f"{folder}/environment.json", json.dumps(content), ("environment", "result"))


def _write_coverage(plan: Plan, pages: Pages, file: str) -> None:
    functions, gaps = [], []
    for code in plan.code:
        source, line = pages.find(code.function, "function")
        count = 0 if code.function in plan.unexecuted else 7
        open_conditions = 1 if code.function in plan.gaps else 0
        functions.append({"file": source, "name": code.function, "line": line, "last_line": line, "count": count, "lines": [line],
                          "lines_missed": [] if count else [line], "outcomes": 0, "outcomes_reached": 0,
                          "conditions": open_conditions, "conditions_shown": 0})  # fmt: skip
        if open_conditions:
            gaps.append({"file": source, "line": line, "function": code.function, "condition": "value > 0", "missing": "false", "reason": None})
    pages.add(file, json.dumps({"schema": "mamori.coverage/1", "functions": functions, "gaps": gaps}))
