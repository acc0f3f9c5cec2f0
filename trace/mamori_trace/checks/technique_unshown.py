# SPDX-License-Identifier: Apache-2.0
"""Claimed techniques without evidence."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project
from mamori_trace.model.technique import Technique
from mamori_trace.readers.headings import read_anchors

RULE = Rule("technique-unshown", ERROR, "What a listed technique is shown by is there: items, tests that use it, documents.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    used = {test.technique for test in project.tests} | {result.technique for result in project.results}
    anchors: dict[str, list[str] | None] = {}
    for technique in project.techniques or ():
        for fault in _list_faults(project, technique, used, anchors):
            yield technique.place, f"{technique.name}: {fault}", ""


def _list_faults(project: Project, technique: Technique, used: set[str], anchors: dict[str, list[str] | None]) -> Iterator[str]:
    if not technique.items and not technique.tests and not technique.documents:
        yield "says neither items nor tests nor documents that show it"
    for name in technique.items:
        item = project.items.get(name)
        if item is None or item.retired:
            near = ", ".join(project.suggest(name)) if item is None else ""
            yield f"{name} is {'retired' if item is not None else 'defined nowhere'}" + (f"; nearest: {near}" if near else "")
    for word in technique.tests:
        if word not in project.schema.technique:
            yield f"'{word}' is no technique of tests; known are {', '.join(project.schema.technique)}"
        elif word not in used:
            yield f"no test uses {word}"
    for document in technique.documents:
        yield from _find_document_fault(project, document, anchors)


def _find_document_fault(project: Project, document: str, anchors: dict[str, list[str] | None]) -> Iterator[str]:
    file, mark, anchor = document.partition("#")
    if file not in anchors:
        anchors[file] = read_anchors(project.root, file)
    known = anchors[file]
    if known is None:
        yield f"{file} does not exist"
    elif mark and anchor not in known:
        yield f"{file} has no heading #{anchor}"
