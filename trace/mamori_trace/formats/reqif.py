# SPDX-License-Identifier: Apache-2.0
"""Reads ReqIF with expat in one pass: objects, values by the names of their definitions, relations and specifications.

A document type definition is rejected without reading, because entities can fill the memory.

@satisfies SWR-TRC-045, SWR-TRC-048, SWR-TRC-051      Design: docs/design/trace_formats.md#formats
"""

from __future__ import annotations

import xml.parsers.expat
import zipfile
from dataclasses import dataclass, field
from pathlib import Path

from mamori_trace.base.errors import FormatError
from mamori_trace.base.files import UNREADABLE, get_shown_path
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.xml_file import feed_file
from mamori_trace.formats.files import list_files
from mamori_trace.formats.model import ForeignItem, ForeignProject, Loss, Relation

NAME = "reqif"
TITLE = "ReqIF"
SUFFIXES = (".reqif", ".reqifz")

_ID = ("ReqIF.ForeignID", "UID", "ID", "Identifier")
_NAME = ("ReqIF.Name", "TITLE", "Title", "Name", "ReqIF.ChapterName")
_CHAPTER = "ReqIF.ChapterName"
_TEXT = ("ReqIF.Text", "STATEMENT", "Statement", "Text", "Description")
_RATIONALE = ("RATIONALE", "Rationale", "ReqIF.Rationale")
_OWNERS = {"SPEC-OBJECT", "SPEC-RELATION", "SPECIFICATION", "SPEC-OBJECT-TYPE", "SPEC-RELATION-TYPE", "SPECIFICATION-TYPE", "SPEC-HIERARCHY"}
_DEPTH_MAX = 1000
_REMEDY = "export it again"


@dataclass(slots=True)
class _Owner:
    """An element with an identifier that has values or references."""

    tag: str
    id: str
    name: str
    line: int
    type: str = ""
    source: str = ""
    target: str = ""
    values: list[tuple[str, str, int]] = field(default_factory=list)


def looks_alike(name: str, text: str) -> bool:
    return name.endswith(SUFFIXES) or "<REQ-IF" in text


def read(path: Path, root: Path, problems: list[Problem]) -> ForeignProject:
    """All requirements of all files: objects that a relation, a specification or their own id marks as requirements."""
    project = ForeignProject(NAME)
    for file in list_files(path, SUFFIXES, root, problems):
        shown, collector = get_shown_path(file, root), _Collector()
        if file.is_file() and zipfile.is_zipfile(file):
            problems.append(Problem(UNREADABLE, Place(shown, 1), "is a packed archive (.reqifz); unpack it, and name the .reqif that it holds"))
        elif feed_file(collector.parser, file, shown, _REMEDY, problems):
            _join(collector, shown, project, problems)
    return project


class _Collector:
    """Collects owners while expat parses the file; values and references belong to the innermost owner."""

    def __init__(self) -> None:
        self.owners: list[_Owner] = []
        self.definitions: dict[str, str] = {}
        self.words: dict[str, str] = {}
        self.places: list[tuple[str, str]] = []
        self.is_reqif = False
        self._open: list[_Owner] = []
        self._path: list[str] = []
        self._text: list[str] = []
        self._value: list[str] | None = None
        self._definition = ""
        self._document = ""
        self._line = 0
        self.parser = xml.parsers.expat.ParserCreate(namespace_separator=" ")
        self.parser.buffer_text = True
        self.parser.StartDoctypeDeclHandler = self._refuse_doctype
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text.append

    def _refuse_doctype(self, *_: object) -> None:
        raise FormatError("holds a document type definition (DTD, entities), which no ReqIF needs; refused unread")

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        tag = name.rpartition(" ")[2]
        self._path.append(tag)
        if len(self._path) > _DEPTH_MAX:
            raise FormatError("is nested more than a thousand elements deep; refused")
        self.is_reqif = self.is_reqif or tag == "REQ-IF"
        if tag.startswith("ATTRIBUTE-VALUE-"):
            self._value = [attributes["THE-VALUE"]] if "THE-VALUE" in attributes else []
            self._definition, self._line = "", self.parser.CurrentLineNumber
        elif tag.startswith("ATTRIBUTE-DEFINITION-") and not tag.endswith("-REF"):
            self.definitions[attributes.get("IDENTIFIER", "")] = attributes.get("LONG-NAME", "")
        elif tag == "ENUM-VALUE":
            self.words[attributes.get("IDENTIFIER", "")] = attributes.get("LONG-NAME", "")
        elif tag in _OWNERS:
            owner = _Owner(tag, attributes.get("IDENTIFIER", ""), attributes.get("LONG-NAME", ""), self.parser.CurrentLineNumber)
            self.owners.append(owner)
            self._open.append(owner)
            if tag == "SPECIFICATION":
                self._document = owner.id
        if not self._in_rich_text():
            self._text.clear()

    def _in_rich_text(self) -> bool:
        return "THE-VALUE" in self._path[:-1]

    def _end(self, name: str) -> None:
        tag = name.rpartition(" ")[2]
        self._path.pop()
        if "THE-VALUE" in self._path:
            if tag in ("p", "div", "br", "li", "tr"):
                self._text.append("\n")
            return
        text = "".join(self._text).strip()
        self._text.clear()
        if tag == "THE-VALUE" and self._value is not None:
            self._value.append("\n".join(" ".join(line.split()) for line in text.splitlines() if line.strip()))
        elif tag == "ENUM-VALUE-REF" and self._value is not None:
            self._value.append(self.words.get(text, text))
        elif tag.startswith("ATTRIBUTE-DEFINITION-") and tag.endswith("-REF"):
            self._definition = text
        elif tag.startswith("ATTRIBUTE-VALUE-") and self._open:
            self._open[-1].values.append((self._definition, ", ".join(self._value or []), self._line))
            self._value = None
        elif tag.endswith("-TYPE-REF") and self._open:
            self._open[-1].type = text
        elif tag == "SPEC-OBJECT-REF" and self._open:
            self._take_object(text)
        elif tag in _OWNERS:
            self._open.pop()

    def _take_object(self, text: str) -> None:
        around = self._path[-1]
        if around == "SOURCE":
            self._open[-1].source = text
        elif around == "TARGET":
            self._open[-1].target = text
        elif around == "OBJECT":
            self.places.append((text, self._document))


def _join(collector: _Collector, shown: str, project: ForeignProject, problems: list[Problem]) -> None:
    if not collector.is_reqif:
        problems.append(Problem(UNREADABLE, Place(shown, 1), "is XML and no ReqIF: it has no element REQ-IF"))
        return
    names = {owner.id: owner.name for owner in collector.owners if owner.tag.endswith("TYPE") or owner.tag == "SPECIFICATION"}
    documents = {key: names.get(document, document) for key, document in reversed(collector.places)}
    rank = {key: number for number, (key, _) in reversed(list(enumerate(collector.places)))}
    objects = [owner for owner in collector.owners if owner.tag == "SPEC-OBJECT"]
    objects.sort(key=lambda owner: rank.get(owner.id, len(rank)))  # stable: objects without a specification keep file order, last
    items: dict[str, ForeignItem] = {}
    for owner in objects:
        item = _make_item(owner, collector, shown, names, documents)
        project.items.append(item)
        items.setdefault(owner.id, item)
    for owner in collector.owners:
        if owner.tag == "SPEC-RELATION":
            _take_relation(owner, collector, shown, names, items, project, problems)
        elif owner.tag == "SPECIFICATION" and owner.values:
            project.headers[owner.name] = owner.values[0][1]
    _find_headings(list(items.values()))


def _find_headings(items: list[ForeignItem]) -> None:
    """An object with a chapter name, but without text and links, is a heading. With a link it is a requirement."""
    linked = {each.target for item in items for each in item.relations}
    for item in items:
        item.heading = item.heading and not (item.statement or item.relations or item.id in linked)


def _make_item(owner: _Owner, collector: _Collector, shown: str, names: dict[str, str], documents: dict[str, str]) -> ForeignItem:
    values: dict[str, tuple[str, int]] = {}
    for definition, value, line in owner.values:
        values[collector.definitions.get(definition) or definition] = (value, line)
    taken: set[str] = set()

    def take(candidates: tuple[str, ...]) -> tuple[str, int]:
        for name in candidates:
            if name in values and name not in taken and (values[name][0] or candidates is not _ID):
                taken.add(name)
                return values[name]
        return "", 0

    item = ForeignItem(take(_ID)[0] or owner.id, take(_NAME)[0] or owner.name, Place(shown, owner.line), kind=names.get(owner.type, ""))
    if any(name in values for name in _TEXT):
        item.statement, item.statement_line = take(_TEXT)
    item.rationale = take(_RATIONALE)[0]
    item.document = documents.get(owner.id, "")
    item.attributes = {name: value for name, (value, _) in values.items() if name not in taken}
    item.heading = bool(values.get(_CHAPTER, ("", 0))[0])
    item.lines = {name: line for name, (_, line) in values.items()}
    return item


def _take_relation(
    owner: _Owner, collector: _Collector, shown: str, names: dict[str, str], items: dict[str, ForeignItem], project: ForeignProject,
    problems: list[Problem],
) -> None:  # fmt: skip
    values = {collector.definitions.get(key, key): value for key, value, _ in owner.values}
    if owner.source not in items:
        problems.append(Problem("unknown-id", Place(shown, owner.line), f"relation {owner.id} begins at {owner.source or 'nothing'}, which no object is"))
        return
    target = items[owner.target].id if owner.target in items else owner.target
    role = names.get(owner.type) or "relation"
    items[owner.source].relations.append(Relation(role, target, owner.line, values.pop("Name", ""), values.pop("Review", "")))
    for name in sorted(values):
        project.losses.append(Loss(Place(shown, owner.line), f"{items[owner.source].id}: attribute {name} of a relation"))
