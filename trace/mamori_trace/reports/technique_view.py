# SPDX-License-Identifier: Apache-2.0
"""The technique table of the page: the required techniques, and the evidence of each.

@satisfies SWR-TRC-064, SWR-TRC-027      Design: docs/design/trace.md#techniques
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from mamori_trace.model.project import Project
from mamori_trace.model.technique import Technique
from mamori_trace.model.verdict import FAILED, NOT_RUN, VERIFIED, WORST_FIRST, Verdict, calc_verdicts


@dataclass(frozen=True, slots=True)
class TechniqueRow:
    """One technique. `demand` names what requires it, `items` and `shown_by` name the evidence, `word` is the badge."""

    name: str
    demand: str
    shown_by: str
    word: str
    items: tuple[str, ...] = ()


def list_techniques(project: Project) -> list[TechniqueRow]:
    """Rows of the techniques of the project; without them, the techniques of the schema with the tests that used them."""
    if project.techniques is not None:
        verdicts = calc_verdicts(project) if any(each.items for each in project.techniques) else {}
        return [_make_row(project, each, verdicts) for each in project.techniques]
    failing = Counter(result.technique or "requirements_based" for result in project.results if result.failing)
    passed = Counter(result.technique or "requirements_based" for result in project.results if result.status == "passed")
    written = Counter(test.technique for test in project.tests)
    return [
        TechniqueRow(name.replace("_", " "), "", _describe(passed[name], written[name], failing[name]),
                     "failed" if failing[name] else "passed" if passed[name] else "not run")
        for name in project.schema.technique
        if passed[name] or failing[name] or written[name]
    ]  # fmt: skip


def _make_row(project: Project, technique: Technique, verdicts: dict[str, Verdict]) -> TechniqueRow:
    """The state is the worst of its items and tests. A technique with only documents as evidence is "described"."""
    words = [verdicts[name].word for name in technique.items if name in verdicts]
    parts: list[str] = []
    for name in technique.tests:
        results = [result for result in project.results if result.technique == name]
        passed = sum(result.status == "passed" for result in results)
        written = sum(test.technique == name for test in project.tests)
        failing = sum(result.failing for result in results)
        words.append(FAILED if failing else VERIFIED if passed else NOT_RUN)
        parts.append(f"{name.replace('_', ' ')}: {_describe(passed, written, failing)}")
    parts += technique.documents
    word = min(words, key=WORST_FIRST.index) if words else "described"
    return TechniqueRow(technique.name, f"{technique.clause}; {technique.phase}", "; ".join(parts), word, tuple(technique.items))


def _describe(passed: int, written: int, failing: int) -> str:
    if passed or failing:
        return f"{passed:,} passed result{'' if passed == 1 else 's'}" + (f", {failing:,} failed" if failing else "")
    return f"{written:,} test{'' if written == 1 else 's'}, none executed"
