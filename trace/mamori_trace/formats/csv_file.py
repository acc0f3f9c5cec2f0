# SPDX-License-Identifier: Apache-2.0
"""Reads and writes CSV: a head line with the names of the columns, then one item per row.

@satisfies SWR-TRC-045, SWR-TRC-048, SWR-TRC-050, SWR-TRC-107      Design: docs/design/trace_formats.md#formats
"""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path
from typing import TYPE_CHECKING

from mamori_trace.base.files import UNREADABLE
from mamori_trace.base.finding import Place, Problem
from mamori_trace.formats.files import read_texts
from mamori_trace.formats.model import ForeignItem, ForeignProject, Relation

if TYPE_CHECKING:
    from _csv import Reader

NAME = "csv"
TITLE = "CSV"
SUFFIXES = (".csv",)
MAP_NAME = "import_map.csv"

_ID = ("id", "uid", "identifier", "requirement id", "key")
_COLUMNS = {"title": ("title", "name", "summary"), "statement": ("statement", "text", "description", "content"),
            "rationale": ("rationale",), "kind": ("type", "kind"), "document": ("document",),
            "parents": ("parents", "parent", "links", "satisfies", "derived from")}  # fmt: skip
_FORMULA = re.compile(r"'*[=+\-@\t\r\n]")
_ESCAPED = re.compile(r"'+[=+\-@\t\r\n]")
_SPLIT = re.compile(r"[,;\s]+")


def escape_cell(cell: str) -> str:
    """Puts an apostrophe before a cell that a spreadsheet would execute as a formula, or that looks escaped: both are reversible."""
    return f"'{cell}" if _FORMULA.match(cell) else cell


def unescape_cell(cell: str) -> str:
    """The cell before `escape_cell`; ignores blanks around an unescaped cell."""
    return cell[1:] if _ESCAPED.match(cell) else cell.strip()


def looks_alike(name: str, text: str) -> bool:
    head = re.split(r"[,;\t]", text.partition("\n")[0].lower())
    return name.endswith(SUFFIXES) and any(cell.strip().strip('"') in _ID for cell in head)


def read(path: Path, root: Path, problems: list[Problem]) -> ForeignProject:
    """Rows of all files. The separator is the most frequent one in the head line: comma, semicolon or tabulator."""
    project = ForeignProject(NAME)
    for shown, text in read_texts(path, SUFFIXES, root, problems):
        head = text.partition("\n")[0]
        separator = max(",;\t", key=head.count)
        reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
        try:
            _read_rows(reader, shown, project, problems)
        except csv.Error as error:
            problems.append(Problem(UNREADABLE, Place(shown, max(reader.line_num, 1)), f"is not whole CSV ({error})"))
    return project


def _read_rows(reader: Reader, shown: str, project: ForeignProject, problems: list[Problem]) -> None:
    names = [unescape_cell(name) for name in next(reader, [])]
    lowered = [name.lower() for name in names]
    id_column = next((lowered.index(name) for name in _ID if name in lowered), -1)
    if id_column < 0:
        problems.append(Problem(UNREADABLE, Place(shown, 1), f"the head line names no column of ids; it needs one of {', '.join(_ID)}"))
        return
    known = {key: next((lowered.index(name) for name in words if name in lowered), -1) for key, words in _COLUMNS.items()}
    line = reader.line_num + 1
    for row in reader:
        if any(cell.strip() for cell in row):
            if len(row) != len(names) or not row[id_column].strip():
                what = f"has {len(row)} of {len(names)} cells" if len(row) != len(names) else "has no id"
                problems.append(Problem(UNREADABLE, Place(shown, line), f"row {what}"))
            else:
                project.items.append(_make_item([unescape_cell(cell) for cell in row], names, id_column, known, Place(shown, line)))
        line = reader.line_num + 1


def _make_item(row: list[str], names: list[str], id_column: int, known: dict[str, int], place: Place) -> ForeignItem:
    cells = {key: row[column] if column >= 0 else "" for key, column in known.items()}
    item = ForeignItem(row[id_column], cells["title"], place, rationale=cells["rationale"], kind=cells["kind"], document=cells["document"])
    item.statement = cells["statement"] if known["statement"] >= 0 else None
    item.statement_line = place.line
    item.relations = [Relation("Parent", word, place.line) for word in _SPLIT.split(cells["parents"]) if word and word != "-"]
    used = {id_column, *known.values()}
    item.attributes = {name: row[column] for column, name in enumerate(names) if column not in used}
    item.lines = dict.fromkeys(names, place.line)
    return item


def format_csv(project: ForeignProject) -> str:
    """One row per item; parents are separated by blanks."""
    names = list(dict.fromkeys(name for item in project.items for name in item.attributes))
    rows = [["ID", "Title", "Statement", "Rationale", "Type", "Document", "Parents", *names]]
    for item in project.items:
        parents = " ".join(each.target for each in item.relations)
        row = [item.id, item.title, item.statement or "", item.rationale, item.kind, item.document, parents]
        rows.append([*row, *(item.attributes.get(name, "") for name in names)])
    return "".join(f"{','.join(map(_format_cell, row))}\n" for row in rows)


def _format_cell(cell: str) -> str:
    """Quoted if necessary. Python's writer leaves a carriage return unquoted, which its reader rejects."""
    cell = escape_cell(cell)
    return '"' + cell.replace('"', '""') + '"' if any(sign in cell for sign in ',"\r\n') else cell
