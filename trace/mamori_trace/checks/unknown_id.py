# SPDX-License-Identifier: Apache-2.0
"""Named ids without a definition."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("unknown-id", ERROR, "Parents, code tags, tests, results and campaign cases name ids that exist.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for problem in project.problems:
        if problem.rule == RULE.id:
            yield problem.place, problem.message, problem.item
    for place, who, named in list_references(project):
        if named not in project.items:
            near = project.suggest(named)
            hint = f"; nearest: {', '.join(near)}" if near else ""
            yield place, f"{who} names {named or 'an empty id'}, which nothing defines{hint}", named


def list_references(project: Project) -> Iterator[tuple[Place, str, str]]:
    """(place, who, id) for every named id. If the test names the same id, it is reported at the test and not at the result."""
    for item in project.all_items:
        for parent in item.parents:
            yield item.find_place("Parents"), item.id, parent
    for tag in project.tags:
        yield tag.place, f"@satisfies ({tag.symbol})", tag.requirement
    for test in project.tests:
        yield test.place, f"test {test.title}", test.requirement
    told = {test.requirement for test in project.tests}
    for result in project.results:
        if result.requirement and result.requirement not in told:
            yield result.place, f"result of {result.title}", result.requirement
    for case in project.evidence.cases:
        for requirement in case.requirements:
            yield case.place, f"campaign case {case.id}", requirement
