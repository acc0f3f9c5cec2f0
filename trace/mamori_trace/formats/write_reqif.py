# SPDX-License-Identifier: Apache-2.0
"""Writes ReqIF: one object per item, one relation per link, one specification per document.

Every value is a string attribute, so nothing is rounded. The creation time is fixed, so that equal items give equal bytes.

@satisfies SWR-TRC-050, SWR-TRC-051      Design: docs/design/trace_formats.md#export
"""

from __future__ import annotations

import hashlib
import re
from xml.sax.saxutils import quoteattr

from mamori_trace.base.errors import InputError
from mamori_trace.formats.model import ForeignItem, ForeignProject

_TIME = "1970-01-01T00:00:00+00:00"
_STRING = "type.string"
_LENGTH_MAX = 1000000
TOOL = "Mamori"
FIXED = ("ReqIF.ForeignID", "ReqIF.Name", "ReqIF.Text", "Rationale")
REVIEW = "Review"
RELATION_NAME = "Name"
_CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


def format_reqif(project: ForeignProject) -> str:
    """The complete file. Raises InputError for a text that XML cannot represent."""
    return "\n".join(_Page(project).lines) + "\n"


class _Page:
    """Builds the lines. An identifier depends only on its object, not on the order of other objects."""

    def __init__(self, project: ForeignProject) -> None:
        self.lines = ['<?xml version="1.0" encoding="UTF-8"?>', '<REQ-IF xmlns="http://www.omg.org/spec/ReqIF/20110401/reqif.xsd">']
        self._project = project
        self._kinds = list(dict.fromkeys(item.kind for item in project.items))
        self._names = list(dict.fromkeys([*FIXED, *(name for item in project.items for name in item.attributes)]))
        self._roles = list(dict.fromkeys(each.role for item in project.items for each in item.relations)) or ["Parent"]
        self._documents = list(dict.fromkeys(item.document for item in project.items))
        first = {item.id: item for item in reversed(project.items)}
        self._objects = {item.id: _make_id("object", item.id) for item in first.values()}
        self._write_head()
        self._write_types()
        self._write_objects()
        self._write_relations()
        self._write_specifications()
        self._add(2, "</REQ-IF-CONTENT>", "</CORE-CONTENT>", "</REQ-IF>")

    def _add(self, indent: int, *lines: str) -> None:
        self.lines.extend(f"{'  ' * indent}{line}" for line in lines)

    def _write_head(self) -> None:
        self._add(1, "<THE-HEADER>", '<REQ-IF-HEADER IDENTIFIER="header">', f"<CREATION-TIME>{_TIME}</CREATION-TIME>",
                  f"<REQ-IF-TOOL-ID>{TOOL}</REQ-IF-TOOL-ID>", "<REQ-IF-VERSION>1.0</REQ-IF-VERSION>",
                  f"<SOURCE-TOOL-ID>{TOOL}</SOURCE-TOOL-ID>", "<TITLE>Requirements</TITLE>", "</REQ-IF-HEADER>", "</THE-HEADER>",
                  "<CORE-CONTENT>", "<REQ-IF-CONTENT>", "<DATATYPES>",
                  f'<DATATYPE-DEFINITION-STRING IDENTIFIER="{_STRING}" LAST-CHANGE="{_TIME}" LONG-NAME="String" MAX-LENGTH="{_LENGTH_MAX}"/>',
                  "</DATATYPES>")  # fmt: skip

    def _write_types(self) -> None:
        self._add(2, "<SPEC-TYPES>")
        for kind in self._kinds:
            self._write_type("SPEC-OBJECT-TYPE", _make_id("kind", kind), kind, [(name, f"{kind}.{name}") for name in self._names])
        for role in self._roles:
            rows = [(name, f"role.{role}.{name}") for name in (RELATION_NAME, REVIEW)]
            self._write_type("SPEC-RELATION-TYPE", _make_id("role", role), role, rows)
        self._write_type("SPECIFICATION-TYPE", "type.document", "Document", [("Header", "document.header")])
        self._add(2, "</SPEC-TYPES>")

    def _write_type(self, tag: str, identifier: str, name: str, attributes: list[tuple[str, str]]) -> None:
        self._add(3, f"<{tag} IDENTIFIER={quoteattr(identifier)} LAST-CHANGE={quoteattr(_TIME)} LONG-NAME={_quote(name)}>", "<SPEC-ATTRIBUTES>")
        for long_name, key in attributes:
            self._add(4, f'<ATTRIBUTE-DEFINITION-STRING IDENTIFIER="{_make_id("field", key)}" LAST-CHANGE="{_TIME}" LONG-NAME={_quote(long_name)}>',
                      f"<TYPE><DATATYPE-DEFINITION-STRING-REF>{_STRING}</DATATYPE-DEFINITION-STRING-REF></TYPE>",
                      "</ATTRIBUTE-DEFINITION-STRING>")  # fmt: skip
        self._add(3, "</SPEC-ATTRIBUTES>", f"</{tag}>")

    def _write_objects(self) -> None:
        self._add(2, "<SPEC-OBJECTS>")
        seen = set()
        for item in self._project.items:
            if item.id in seen:
                raise InputError(f"{item.place}: {item.id} is defined a second time; mend it before the export")
            seen.add(item.id)
            values = {"ReqIF.ForeignID": item.id, "ReqIF.Name": item.title, "ReqIF.Text": item.statement or "", "Rationale": item.rationale}
            rows = [(f"{item.kind}.{name}", value) for name, value in {**values, **item.attributes}.items()]
            self._add(3, f"<SPEC-OBJECT IDENTIFIER={quoteattr(self._objects[item.id])} LAST-CHANGE={quoteattr(_TIME)} LONG-NAME={_quote(item.title)}>")
            self._write_values(rows, item)
            self._add(3, f"<TYPE><SPEC-OBJECT-TYPE-REF>{_make_id('kind', item.kind)}</SPEC-OBJECT-TYPE-REF></TYPE>", "</SPEC-OBJECT>")
        self._add(2, "</SPEC-OBJECTS>")

    def _write_values(self, rows: list[tuple[str, str]], item: ForeignItem | None = None) -> None:
        self._add(3, "<VALUES>")
        for key, value in rows:
            if _CONTROL.search(value):
                raise InputError(f"{item.place if item else key}: holds a character that XML cannot hold; take it out before the export")
            self._add(4, f"<ATTRIBUTE-VALUE-STRING THE-VALUE={_quote(value)}><DEFINITION><ATTRIBUTE-DEFINITION-STRING-REF>"
                      f"{_make_id('field', key)}</ATTRIBUTE-DEFINITION-STRING-REF></DEFINITION></ATTRIBUTE-VALUE-STRING>")  # fmt: skip
        self._add(3, "</VALUES>")

    def _write_relations(self) -> None:
        self._add(2, "<SPEC-RELATIONS>")
        for item in self._project.items:
            for number, each in enumerate(item.relations):
                if each.target not in self._objects:
                    raise InputError(f"{item.place.file}:{each.line}: {item.id} names {each.target}, which nothing defines; mend it before the export")
                identifier = _make_id("relation", f"{item.id} {number} {each.target}")
                self._add(3, f"<SPEC-RELATION IDENTIFIER={quoteattr(identifier)} LAST-CHANGE={quoteattr(_TIME)}>")
                self._write_values([(f"role.{each.role}.{RELATION_NAME}", each.name), (f"role.{each.role}.{REVIEW}", each.review)])
                self._add(3, f"<TYPE><SPEC-RELATION-TYPE-REF>{_make_id('role', each.role)}</SPEC-RELATION-TYPE-REF></TYPE>",
                          f"<SOURCE><SPEC-OBJECT-REF>{self._objects[item.id]}</SPEC-OBJECT-REF></SOURCE>",
                          f"<TARGET><SPEC-OBJECT-REF>{self._objects[each.target]}</SPEC-OBJECT-REF></TARGET>", "</SPEC-RELATION>")  # fmt: skip
        self._add(2, "</SPEC-RELATIONS>")

    def _write_specifications(self) -> None:
        self._add(2, "<SPECIFICATIONS>")
        for document in self._documents:
            self._add(3, f"<SPECIFICATION IDENTIFIER={quoteattr(_make_id('document', document))} LAST-CHANGE={quoteattr(_TIME)} LONG-NAME={_quote(document)}>",
                      "<TYPE><SPECIFICATION-TYPE-REF>type.document</SPECIFICATION-TYPE-REF></TYPE>")  # fmt: skip
            self._write_values([("document.header", self._project.headers.get(document, ""))])
            self._add(3, "<CHILDREN>")
            for item in self._project.items:
                if item.document == document:
                    self._add(4, f"<SPEC-HIERARCHY IDENTIFIER={quoteattr(_make_id('place', item.id))} LAST-CHANGE={quoteattr(_TIME)}><OBJECT>"
                              f"<SPEC-OBJECT-REF>{self._objects[item.id]}</SPEC-OBJECT-REF></OBJECT></SPEC-HIERARCHY>")  # fmt: skip
            self._add(3, "</CHILDREN>", "</SPECIFICATION>")
        self._add(2, "</SPECIFICATIONS>")


def _quote(value: str) -> str:
    return quoteattr(value)


def _make_id(kind: str, name: str) -> str:
    """A valid XML ID: readable as far as the name permits, and always with a hash of the name."""
    plain = re.sub(r"[^A-Za-z0-9.\-]", "_", name)[:60]
    return f"{kind}.{plain}.{hashlib.sha256(name.encode()).hexdigest()[:8]}"
