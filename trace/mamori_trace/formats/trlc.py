# SPDX-License-Identifier: Apache-2.0
"""Reads TRLC: the record objects of .trlc files. Only the names of enumerations are read from .rsl files.

Unknown syntax ends the reading of the file with a message for its line: a partly read record could hide a link.

@satisfies SWR-TRC-045, SWR-TRC-048      Design: docs/design/trace_formats.md#formats
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from mamori_trace.base.files import UNREADABLE
from mamori_trace.base.finding import Place, Problem
from mamori_trace.formats.files import read_texts
from mamori_trace.formats.model import ForeignItem, ForeignProject, Relation

NAME = "trlc"
TITLE = "TRLC"
SUFFIXES = (".trlc",)

_TOKEN = re.compile(
    r"""(?P<space>\s+|//[^\n]*|/\*.*?\*/)|(?P<text>\'\'\'.*?\'\'\'|\"\"\".*?\"\"\"|"(?:\\.|[^"\\\n])*")|(?P<number>-?\d[\d_.]*)"""
    r"""|(?P<name>[A-Za-z]\w*(?:\.[A-Za-z]\w*){0,2})|(?P<mark>[{}=\[\](),@;:])""",
    re.DOTALL,
)
_ENUM = re.compile(r"^\s*enum\s+(\w+)", re.MULTILINE)
_STATEMENT = ("description", "statement", "text")
_TITLE = ("title", "summary")
_DEPTH_MAX = 30


class _NotUnderstood(Exception):
    """The found token and its line."""


@dataclass(frozen=True, slots=True)
class _Token:
    kind: str
    value: str
    line: int


@dataclass(slots=True)
class _Record:
    """`names` may be references: (attribute, name, line)."""

    item: ForeignItem
    package: str
    names: list[tuple[str, str, int]] = field(default_factory=list)


def looks_alike(name: str, text: str) -> bool:
    return name.endswith((".trlc", ".rsl"))


def read(path: Path, root: Path, problems: list[Problem]) -> ForeignProject:
    """The records of every .trlc file below `path`."""
    folder = path if path.is_dir() else path.parent
    enums = {name for _, text in read_texts(folder, (".rsl",), root, problems) for name in _ENUM.findall(text)}
    records: list[_Record] = []
    for shown, text in read_texts(path, SUFFIXES, root, problems):
        parser = _Parser(text, shown)
        try:
            parser.run()
        except _NotUnderstood as error:
            problems.append(Problem(UNREADABLE, Place(shown, parser.line), f"{error}; the rest of the file was not read"))
        records += parser.records
    return ForeignProject(NAME, [_finish(record, enums) for record in records])


def _finish(record: _Record, enums: set[str]) -> ForeignItem:
    """A name is a word of an enumeration (with or without its package), or a reference. Without a package, it is in that of the record."""
    item = record.item
    for attribute, name, line in record.names:
        head, dot, word = name.rpartition(".")
        if dot and head.rpartition(".")[2] in enums:
            item.attributes[attribute] = f"{item.attributes[attribute]}, {word}" if attribute in item.attributes else word
        else:
            item.relations.append(Relation(attribute, name if dot else f"{record.package}.{name}", line))
    return item


class _Parser:
    """One file: package, imports, sections and records."""

    def __init__(self, text: str, shown: str) -> None:
        self.records: list[_Record] = []
        self.line = 1
        self._text = text
        self._shown = shown
        self._tokens: list[_Token] = []
        self._next = 0
        self._package = ""

    def run(self) -> None:
        self._split()
        self._expect("package")
        self._package = self._take("name").value
        while self._peek() == "import":
            self._next += 1
            self._take("name")
        self._read_items(0)
        if self._next < len(self._tokens):
            self._refuse(self._tokens[self._next])

    def _split(self) -> None:
        position = 0
        while position < len(self._text):
            match = _TOKEN.match(self._text, position)
            if match is None:
                raise _NotUnderstood(f"'{self._text[position : position + 20].splitlines()[0]}' was not understood")
            if match.lastgroup != "space":
                self._tokens.append(_Token(str(match.lastgroup), match[0], self.line))
            self.line += match[0].count("\n")
            position = match.end()

    def _peek(self) -> str:
        return self._tokens[self._next].value if self._next < len(self._tokens) else ""

    def _refuse(self, token: _Token) -> None:
        self.line = token.line
        raise _NotUnderstood(f"'{token.value[:20]}' was not understood")

    def _take(self, kind: str) -> _Token:
        if self._next >= len(self._tokens):
            raise _NotUnderstood("ends in the middle of a record; the file is cut off")
        token = self._tokens[self._next]
        if token.kind != kind:
            self._refuse(token)
        self._next += 1
        return token

    def _expect(self, value: str) -> _Token:
        token = self._take("name" if value[0].isalpha() else "mark")
        if token.value != value:
            self._refuse(token)
        return token

    def _read_items(self, depth: int) -> None:
        while self._peek() not in ("", "}"):
            if self._peek() == "section":
                if depth >= _DEPTH_MAX:
                    self._refuse(self._tokens[self._next])
                self._next += 1
                self._take("text")
                self._expect("{")
                self._read_items(depth + 1)
                self._expect("}")
            else:
                self._read_record()

    def _read_record(self) -> None:
        kind, name = self._take("name"), self._take("name")
        item = ForeignItem(f"{self._package}.{name.value}", name.value, Place(self._shown, name.line), "", name.line, kind=kind.value)
        record = _Record(item, self._package)
        self._expect("{")
        while self._peek() != "}":
            attribute = self._take("name")
            self._expect("=")
            item.lines[attribute.value] = attribute.line
            self._read_value(attribute.value, record, 0)
        self._expect("}")
        self._name_parts(item)
        self.records.append(record)

    def _read_value(self, attribute: str, record: _Record, depth: int) -> None:
        """A text, number, name, list or tuple."""
        token = self._tokens[self._next] if self._next < len(self._tokens) else self._take("name")
        self._next += 1
        if token.value in ("[", "("):
            if depth >= _DEPTH_MAX:
                self._refuse(token)
            close = "]" if token.value == "[" else ")"
            while self._peek() != close:
                self._read_value(attribute, record, depth + 1)
                if self._peek() != close:
                    self._expect(",")
            self._expect(close)
        elif token.kind == "name" and token.value not in ("true", "false", "null"):
            record.names.append((attribute, token.value, token.line))
        elif token.kind in ("text", "number", "name"):
            attributes, value = record.item.attributes, _unquote(token.value) if token.kind == "text" else token.value
            attributes[attribute] = f"{attributes[attribute]}, {value}" if attribute in attributes else value
        else:
            self._refuse(token)
        while self._peek() in ("@", ";", ":"):  # a tuple with separators, as in `name @ 3`
            self._next += 1
            self._read_value(attribute, record, depth + 1)

    def _name_parts(self, item: ForeignItem) -> None:
        for name in _STATEMENT:
            if name in item.attributes and not item.statement:
                item.statement, item.statement_line = item.attributes.pop(name), item.lines[name]
        for name in _TITLE:
            item.title = item.attributes.pop(name, item.title) or item.title
        item.rationale = item.attributes.pop("rationale", "")


def _unquote(text: str) -> str:
    if text.startswith(("'''", '"""')):
        return text[3:-3].strip()
    return re.sub(r"\\(.)", r"\1", text[1:-1])
