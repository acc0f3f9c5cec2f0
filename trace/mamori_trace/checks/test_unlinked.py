# SPDX-License-Identifier: Apache-2.0
"""Tests that name no requirement."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from mamori_trace.base.finding import WARNING, Place, Rule
from mamori_trace.model.evidence import TestResult
from mamori_trace.model.project import Project

RULE = Rule("test-unlinked", WARNING, "Every test names the requirement that it verifies.")

_NAMES_MAX = 3


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    """One finding per suite, with the count: such tests may be useful but verify no requirement."""
    suites: dict[tuple[str, str], list[TestResult]] = defaultdict(list)
    for result in project.results:
        if not result.requirement:
            suites[(result.place.file, result.suite)].append(result)
    for (_, suite), results in suites.items():
        names = ", ".join(result.name for result in results[:_NAMES_MAX])
        more = ", ..." if len(results) > _NAMES_MAX else ""
        count = f"{len(results)} test{'s' if len(results) > 1 else ''}"
        yield results[0].source or results[0].place, f"{suite}: {count} without a requirement ({names}{more})", ""
