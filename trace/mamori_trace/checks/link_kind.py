# SPDX-License-Identifier: Apache-2.0
"""Links between kinds for which the schema allows no link."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("link-kind", ERROR, "Each link joins kinds that the schema allows, and each item says what its kind has to say.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    if not project.kinds.kinds:
        return
    kind_of = {level: project.kinds.find_kind(level) for level in project.schema.levels}
    yield from _check_required(project, kind_of)
    for place, source, link, target in _list_links(project):
        item = project.items.get(target)
        kind = kind_of.get(item.level) if item is not None else None
        allowed = project.kinds.list_targets(source, link)
        if kind is not None and allowed is not None and kind.key not in allowed:
            yield place, f"{source} {link} {target}, which is of the kind {kind.key}; allowed: {', '.join(allowed)}", target


def _list_links(project: Project) -> Iterator[tuple[Place, str, str, str]]:
    """(place, kind of the source, link, id) of the links of code, tests and campaign cases. Rule level-order checks parent links."""
    for tag in project.tags:
        yield tag.place, "code", "satisfies", tag.requirement
    for test in project.tests:
        yield test.place, "test", "verifies", test.requirement
    for case in project.evidence.cases:
        for name in case.requirements:
            yield case.place, "campaign", "verifies", name


def _check_required(project: Project, kind_of: dict) -> Iterator[tuple[Place, str, str]]:
    """Attributes that are present without a value (`-`)."""
    for item in project.live_items:
        kind = kind_of[item.level]
        if not item.whole or not item.approved or kind is None:
            continue
        said = {"Parents": item.parents, "Design": item.design}
        for name in kind.required:
            if name in item.lines and not said.get(name, True):
                yield item.find_place(name), f"{item.id} says no {name}, which each {kind.name} has to", item.id
