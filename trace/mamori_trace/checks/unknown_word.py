# SPDX-License-Identifier: Apache-2.0
"""Techniques and polarities that the schema does not define."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("unknown-word", ERROR, "Technique and polarity of tests and cases are words of the schema.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    schema = project.schema
    for place, who, technique, polarity, requirement in _list_words(project):
        if technique not in schema.technique:
            yield place, f"{who}: technique '{technique}' is not one of {', '.join(schema.technique)}", requirement
        if polarity not in schema.polarity:
            yield place, f"{who}: polarity '{polarity}' is not one of {', '.join(schema.polarity)}", requirement


def _list_words(project: Project) -> Iterator[tuple[Place, str, str, str, str]]:
    """(place, who, technique, polarity, item) of tests, results and cases, except those already reported for the source test."""
    told = set()
    for test in project.tests:
        told.add((test.technique, test.polarity))
        yield test.place, f"test {test.title}", test.technique, test.polarity, test.requirement
    for result in project.results:
        words = (result.technique or "requirements_based", result.polarity or "nominal")
        if result.requirement and words not in told:
            yield result.place, f"result of {result.title}", *words, result.requirement
    for case in project.evidence.cases:
        for polarity in sorted({case.polarity, *case.requirement_polarity.values()}):
            yield case.place, f"campaign case {case.id}", "fault_injection", polarity, ""
