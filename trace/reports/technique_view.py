# SPDX-License-Identifier: Apache-2.0
"""The technique table of the page: which technique is demanded, and what shows that it was used.

@satisfies SWR-TRC-064      Design: docs/design/trace_report.md#techniques
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from mamori.trace.model.project import Project


@dataclass(frozen=True, slots=True)
class TechniqueRow:
    """One technique. `demand` says what asks for it, `word` is a word of the badges."""

    name: str
    demand: str
    shown_by: str
    word: str


def list_techniques(project: Project) -> list[TechniqueRow]:
    """Rows that the project offers under `techniques`, else the techniques of the schema with the tests that used them."""
    rows = getattr(project, "techniques", None)
    if rows is not None:
        return list(rows)
    passed = Counter(result.technique or "requirements_based" for result in project.results if result.status == "passed")
    written = Counter(test.technique for test in project.tests)
    return [
        TechniqueRow(name.replace("_", " "), "", _describe(passed[name], written[name]), "passed" if passed[name] else "not run")
        for name in project.schema.technique
        if passed[name] or written[name]
    ]


def _describe(passed: int, written: int) -> str:
    if passed:
        return f"{passed} passed result{'' if passed == 1 else 's'}"
    return f"{written} test{'' if written == 1 else 's'}, none executed"
