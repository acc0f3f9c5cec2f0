# SPDX-License-Identifier: Apache-2.0
"""Converts the project to the plain rows of the page: results by suite, code by file, the environment record.

@satisfies SWR-TRC-011      Design: docs/design/trace.md#report
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass
from typing import Any

from mamori_trace.model.evidence import CodeTag, TestResult


@dataclass(slots=True)
class SuiteView:
    """Results of one suite."""

    name: str
    kind: str
    counts: Counter
    time_s: float
    results: list[TestResult]


def make_suite_views(results: list[TestResult]) -> list[SuiteView]:
    """Suites by kind and name; within a suite, results that did not pass come first."""
    groups: dict[tuple[str, str], list[TestResult]] = defaultdict(list)
    for result in results:
        groups[(result.kind, result.suite)].append(result)
    return [
        SuiteView(
            name=suite,
            kind=kind,
            counts=Counter("failed" if result.failing else result.status for result in group),
            time_s=sum(result.time_s for result in group),
            results=sorted(group, key=lambda result: (result.status == "passed", result.name, result.requirement)),
        )
        for (kind, suite), group in sorted(groups.items())
    ]


def group_tags(tags: list[CodeTag]) -> list[tuple[str, list[CodeTag]]]:
    """Tags by file."""
    files: dict[str, list[CodeTag]] = defaultdict(list)
    for tag in sorted(tags, key=lambda tag: (tag.place, tag.requirement)):
        files[tag.place.file].append(tag)
    return sorted(files.items())


def describe_full_run(record: object) -> dict[str, Any]:
    """Date, commit and failed steps of the last complete run; empty if the environment has none."""
    if not isinstance(record, dict) or not isinstance(record.get("steps"), list):
        return {}
    steps = [step for step in record["steps"] if isinstance(step, dict)]
    failed = [f"{step.get('name')} ({step.get('verdict')})" for step in steps if step.get("verdict") != "passed"]
    return {"date": str(record.get("date_utc"))[:10], "commit": str(record.get("commit")), "dirty": record.get("dirty") is True,
            "count": len(steps), "failed": failed}  # fmt: skip


def describe_environment(environment: dict[str, Any]) -> dict[str, Any]:
    """The record with every entry, as text or as a table of texts; empty if there is no record."""
    if not environment:
        return {}
    texts = ("commit", "date_utc", "command", "os", "cpu", "cores", "python")
    shown: dict[str, Any] = {name: str(environment.get(name) or "unknown") for name in texts}
    for name in ("compilers", "packages"):
        table = environment.get(name)
        shown[name] = {str(key): str(value) for key, value in table.items()} if isinstance(table, dict) else {}
    shown["dirty"] = environment.get("dirty") is True
    shown["full_run"] = describe_full_run(environment.get("full_run"))
    return shown
