# SPDX-License-Identifier: Apache-2.0
"""Turns the project into the plain rows that the page shows: items with their chains, results by suite, code by file.

@satisfies SWR-TRC-011      Design: docs/design/trace.md#report
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field
from typing import Any

from mamori.trace.model.evidence import CampaignCase, CodeTag, SourceTest, TestResult
from mamori.trace.model.finding import Finding
from mamori.trace.model.item import Item
from mamori.trace.model.project import Project
from mamori.trace.model.verdict import Verdict

PATHS_MAX = 12
_DEPTH_MAX = 8


@dataclass(slots=True)
class Node:
    """An item in a tree of items."""

    id: str
    title: str
    word: str
    children: list[Node] = field(default_factory=list)


@dataclass(slots=True)
class ItemView:
    """Everything the page tells about one item. `paths` lead from the top of the V down to the item itself."""

    item: Item
    verdict: Verdict
    paths: list[list[Node]]
    tree: list[Node]
    tags: list[CodeTag]
    results: list[TestResult]
    unexecuted: list[SourceTest]
    cases: list[CampaignCase]
    findings: list[Finding]

    @property
    def search_text(self) -> str:
        item = self.item
        return f"{item.id} {item.title} {item.statement} {self.verdict.word} {' '.join(item.parents)}".lower()


@dataclass(slots=True)
class SuiteView:
    """Results of one suite."""

    name: str
    kind: str
    counts: Counter
    time_s: float
    results: list[TestResult]


def make_item_views(project: Project, verdicts: dict[str, Verdict], findings: list[Finding]) -> list[ItemView]:
    """Views in the order of the levels, then of the ids."""
    findings_of: dict[str, list[Finding]] = defaultdict(list)
    for finding in findings:
        findings_of[finding.item].append(finding)
    rank = {level: index for index, level in enumerate(project.schema.levels)}
    ordered = sorted(verdicts, key=lambda key: (rank[project.items[key].level], key))
    return [_make_item_view(project, project.items[key], verdicts, findings_of.get(key, [])) for key in ordered]


def make_suite_views(results: list[TestResult]) -> list[SuiteView]:
    """Suites by kind and name; inside, what did not pass comes first."""
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


def describe_environment(environment: dict[str, Any]) -> dict[str, Any]:
    """The record with every entry present, as text or as a table of texts; empty where there is no record."""
    if not environment:
        return {}
    texts = ("commit", "date_utc", "command", "os", "cpu", "cores", "python")
    shown: dict[str, Any] = {name: str(environment.get(name) or "unknown") for name in texts}
    for name in ("compilers", "packages"):
        table = environment.get(name)
        shown[name] = {str(key): str(value) for key, value in table.items()} if isinstance(table, dict) else {}
    shown["dirty"] = environment.get("dirty") is True
    return shown


def _make_item_view(project: Project, item: Item, verdicts: dict[str, Verdict], findings: list[Finding]) -> ItemView:
    return ItemView(
        item=item,
        verdict=verdicts[item.id],
        paths=_list_paths(project, item, verdicts),
        tree=_make_tree(project, item, verdicts, (item.id,)),
        tags=sorted(project.tags_of.get(item.id, []), key=lambda tag: tag.place),
        results=sorted(project.results_of.get(item.id, []), key=lambda result: (result.title, result.place)),
        unexecuted=sorted(project.unexecuted_of.get(item.id, []), key=lambda test: test.place),
        cases=sorted(project.cases_of.get(item.id, []), key=lambda case: case.id),
        findings=findings,
    )


def _make_node(project: Project, item_id: str, verdicts: dict[str, Verdict]) -> Node:
    return Node(item_id, project.items[item_id].title, verdicts[item_id].word)


def _list_paths(project: Project, item: Item, verdicts: dict[str, Verdict]) -> list[list[Node]]:
    """At most PATHS_MAX ways from a top item to this one. A cycle ends a way."""
    finished: list[list[Node]] = []
    waiting = [[item.id]]
    while waiting and len(finished) < PATHS_MAX:
        path = waiting.pop(0)
        above = [parent for parent in project.items[path[0]].parents if parent in verdicts and parent not in path]
        if above and len(path) < _DEPTH_MAX:
            waiting.extend([parent, *path] for parent in above)
        else:
            finished.append([_make_node(project, key, verdicts) for key in path])
    return sorted(finished, key=lambda path: [node.id for node in path])


def _make_tree(project: Project, item: Item, verdicts: dict[str, Verdict], path: tuple[str, ...]) -> list[Node]:
    """What refines the item, down to the software; a cycle and excessive depth end a branch."""
    nodes = []
    for child in project.children_of.get(item.id, []):
        if child.id not in path and child.id in verdicts and len(path) < _DEPTH_MAX:
            node = _make_node(project, child.id, verdicts)
            node.children = _make_tree(project, child, verdicts, (*path, child.id))
            nodes.append(node)
    return nodes
