# SPDX-License-Identifier: Apache-2.0
"""Reads StrictDoc documents (.sdoc), line by line.

@satisfies SWR-TRC-045, SWR-TRC-048      Design: docs/design/trace_formats.md#formats
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from mamori_trace.base.files import UNREADABLE
from mamori_trace.base.finding import Place, Problem
from mamori_trace.formats.files import read_texts
from mamori_trace.formats.model import ForeignItem, ForeignProject, Loss, Relation

NAME = "strictdoc"
TITLE = "StrictDoc"
SUFFIXES = (".sdoc",)

_HEAD = re.compile(r"\[\[?(/?)([A-Z][A-Z0-9_]*)\]\]?")
_FIELD = re.compile(r"([A-Z][A-Za-z0-9_ ]*):(?:[ \t]+(.*))?")
_RELATION = re.compile(r"(- |  )(TYPE|VALUE|ROLE|FORMAT|HASH|LINE_RANGE|FUNCTION|CLASS|ELEMENT|ID):[ \t]*(.*)")
_OPEN, _CLOSE = ">>>", "<<<"
_NO_ITEMS = {"DOCUMENT", "GRAMMAR", "SECTION", "TEXT", "FREETEXT", "DOCUMENT_FROM_FILE", "VIEWS", "COMPOSITE"}
_OWN = {"UID", "TITLE", "STATEMENT", "RATIONALE"}


def looks_alike(name: str, text: str) -> bool:
    return name.endswith(SUFFIXES) or text.lstrip().startswith("[DOCUMENT]")


def read(path: Path, root: Path, problems: list[Problem]) -> ForeignProject:
    """Every node with a UID below `path`."""
    project = ForeignProject(NAME)
    nameless: list[tuple[str, Place]] = []
    for shown, text in read_texts(path, SUFFIXES, root, problems):
        document = _Document(shown, project, problems)
        document.take_all(text)
        nameless += document.nameless
    problems += _demand_uids(nameless, Counter(item.kind for item in project.items))
    return project


def _demand_uids(nameless: list[tuple[str, Place]], named: Counter[str]) -> Iterator[Problem]:
    """Rules ignore a node without a UID. If most nodes of its kind have one, the missing UID is reported as an error."""
    counts = Counter(tag for tag, _ in nameless)
    for tag, place in nameless:
        if named[tag] >= counts[tag]:
            yield Problem("malformed-item", place, f"{tag} has no UID, so no rule can judge it; give it one (strictdoc manage auto-uid)")


class _Document:
    """One file during reading: a node contains fields; the last field may be a list of relations or text over many lines."""

    def __init__(self, shown: str, project: ForeignProject, problems: list[Problem]) -> None:
        self._shown = shown
        self._project = project
        self._problems = problems
        self._title = ""
        self._tag = ""
        self._line = 0
        self._fields: list[tuple[str, str, int]] = []
        self._relations: list[dict[str, tuple[str, int]]] = []
        self._text: list[str] | None = None
        self._in_relations = False
        self.nameless: list[tuple[str, Place]] = []

    def take_all(self, text: str) -> None:
        lines = text.splitlines()
        if not lines or lines[0].strip() != "[DOCUMENT]":
            self._refuse(1, "does not begin with [DOCUMENT], so it is no StrictDoc document")
            return
        for number, line in enumerate(lines, start=1):
            if not self._take(number, line.rstrip()):
                return
        if self._text is not None:
            name, _, number = self._fields[-1]
            self._refuse(number, f"{name} is opened with {_OPEN} and never closed; the file is cut off")
        self._close_node()

    def _refuse(self, number: int, message: str) -> None:
        self._problems.append(Problem(UNREADABLE, Place(self._shown, number), message))

    def _take(self, number: int, line: str) -> bool:
        """@return False if the rest of the file cannot be parsed."""
        if self._text is not None:
            self._take_text(line)
            return True
        head = _HEAD.fullmatch(line)
        if head:
            self._close_node()
            self._tag, self._line = ("" if head[1] else head[2]), number
            if head[2] == "FREETEXT" and not head[1]:
                self._fields, self._text = [("FREETEXT", "", number)], []
            return True
        if not line or self._tag in ("GRAMMAR", "DOCUMENT", "VIEWS", "") or self._take_relation(number, line):
            if self._tag == "DOCUMENT" and line.startswith("TITLE:"):
                self._title = line[6:].strip()
            return True
        return self._take_field(number, line)

    def _take_text(self, line: str) -> None:
        if line in (_CLOSE, "[/FREETEXT]"):
            name, _, number = self._fields[-1]
            self._fields[-1] = (name, "\n".join(self._text or []).strip(), number)
            self._text = None
        elif self._text is not None:
            self._text.append(line)

    def _take_relation(self, number: int, line: str) -> bool:
        part = _RELATION.fullmatch(line) if self._in_relations else None
        if part is None:
            return False
        if part[1] == "- ":
            self._relations.append({})
        if self._relations:
            self._relations[-1][part[2]] = (part[3].strip(), number)
        return True

    def _take_field(self, number: int, line: str) -> bool:
        match = _FIELD.fullmatch(line)
        if match is None:
            self._refuse(number, f"'{line[:40]}' is neither a field nor a node; the rest of the file was not read")
            return False
        name, value = match[1], (match[2] or "").strip()
        self._in_relations = name in ("RELATIONS", "REFS") and not value
        if not self._in_relations:
            self._fields.append((name, value, number))
            if value == _OPEN:
                self._text = []
        return True

    def _close_node(self) -> None:
        tag, fields, relations = self._tag, self._fields, self._relations
        self._tag, self._fields, self._relations, self._in_relations = "", [], [], False
        values = {name: value for name, value, _ in fields}
        place = Place(self._shown, self._line)
        if not tag or tag in _NO_ITEMS:
            if tag in ("TEXT", "FREETEXT"):
                self._project.losses.append(Loss(place, f"text outside of requirements: {' '.join(values.get('STATEMENT', '').split())[:40]}"))
            return
        if not values.get("UID"):
            self._project.losses.append(Loss(place, f"{tag} without UID: {values.get('TITLE', '')}"))
            self.nameless.append((tag, place))
            return
        self._project.items.append(self._make_item(tag, place, fields, values, relations))

    def _make_item(
        self, tag: str, place: Place, fields: list[tuple[str, str, int]], values: dict[str, str], relations: list[dict[str, tuple[str, int]]]
    ) -> ForeignItem:
        lines = {name: number for name, _, number in fields}
        item = ForeignItem(values["UID"], values.get("TITLE", ""), Place(place.file, lines["UID"]), kind=tag, document=self._title, lines=lines)
        item.statement = values.get("STATEMENT", "")
        item.statement_line = lines.get("STATEMENT", place.line)
        item.rationale = values.get("RATIONALE", "")
        for name, value, _ in fields:
            if name not in _OWN:
                item.attributes[name] = f"{item.attributes[name]}\n{value}" if name in item.attributes else value
        for each in relations:
            kind, (target, line) = each.get("TYPE", ("", 0))[0], each.get("VALUE", ("", place.line))
            if kind == "File":
                item.files += [Relation(kind, target, line)] if target else []
                self._project.losses.append(Loss(Place(place.file, line), f"{item.id}: relation to the file {target}"))
            else:
                item.relations.append(Relation(kind, target, line, each.get("ROLE", ("", 0))[0]))
        return item
