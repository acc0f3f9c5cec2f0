# SPDX-License-Identifier: Apache-2.0
"""Techniques and polarities that the schema does not know."""

from __future__ import annotations

from collections.abc import Iterator

from mamori.trace.model.finding import ERROR, Place, Rule
from mamori.trace.model.project import Project

RULE = Rule("unknown-word", ERROR, "Technique and polarity of tests and cases are words of the schema.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    schema = project.schema
    named = [(test.place, f"test {test.title}", test.technique, test.polarity, test.requirement) for test in project.tests]
    told = {(test.technique, test.polarity) for test in project.tests}
    for result in project.results:
        if result.requirement and (result.technique, result.polarity) not in told:
            technique = result.technique or "requirements_based"
            row = (result.place, f"result of {result.title}", technique, result.polarity or "nominal", result.requirement)
            named.append(row)
    named += [(case.place, f"campaign case {case.id}", "fault_injection", case.polarity, "") for case in project.evidence.cases]
    for place, who, technique, polarity, requirement in named:
        if technique not in schema.technique:
            yield place, f"{who}: technique '{technique}' is not one of {', '.join(schema.technique)}", requirement
        if polarity not in schema.polarity:
            yield place, f"{who}: polarity '{polarity}' is not one of {', '.join(schema.polarity)}", requirement
