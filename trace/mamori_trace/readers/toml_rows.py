# SPDX-License-Identifier: Apache-2.0
"""Reads the small handwritten TOML files: tables of named rows, each with its location.

@satisfies SWR-TRC-021, SWR-TRC-022      Design: docs/design/trace.md#rule-packs
"""

from __future__ import annotations

import datetime
import difflib
import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import FormatError
from mamori_trace.base.files import UNREADABLE, get_shown_path, read_text
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.toml_file import parse_toml

_LINE = re.compile(r"\(at line (\d+)")


@dataclass(frozen=True, slots=True)
class Columns:
    """The columns of a row: texts, and lists of texts. Columns in `needed` are required and must not be empty."""

    texts: tuple[str, ...]
    lists: tuple[str, ...] = ()
    needed: tuple[str, ...] = ()


def read_rows(path: Path, schema: str, name: str, columns: Columns, root: Path, problems: list[Problem]) -> list[tuple[dict[str, Any], Place]]:
    """Rows `[[name]]` of an optional file. An invalid file, and each invalid row, is a problem and is omitted.

    The returned rows have every column: empty text or tuple if the row does not specify it.
    """
    if not os.path.lexists(path):  # a link without a target exists but cannot be read
        return []
    shown = get_shown_path(path, root)
    before = len(problems)
    text = read_text(path, shown, problems)
    if len(problems) > before:
        return []
    try:
        table = parse_toml(text)
    except FormatError as error:
        line = _LINE.search(str(error))
        problems.append(Problem(UNREADABLE, Place(shown, int(line[1]) if line else text.count("\n") + 1), f"is not TOML: {error}"))
        return []
    rows = table.pop(name, [])
    fault = _find_fault(table, rows, schema, name)
    if fault:
        problems.append(Problem(UNREADABLE, Place(shown, 1), fault))
        return []
    return list(_list_whole(zip(rows, _list_places(text, shown, name, len(rows)), strict=True), columns, problems))


def suggest(word: str, known: Iterable[str]) -> str:
    """`; nearest: a, b`, or empty if no name is similar."""
    near = difflib.get_close_matches(word, list(known), n=3, cutoff=0.6)
    return f"; nearest: {', '.join(near)}" if near else ""


def _find_fault(table: dict[str, Any], rows: Any, schema: str, name: str) -> str:
    """Problems of the complete file."""
    found = table.pop("schema", None)
    if found != schema:
        return f"schema is {found!r}; this tool reads {schema!r}"
    if table:
        return f"unknown entry '{next(iter(table))}'; the file holds `schema` and rows [[{name}]]"
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        return f"'{name}' is no list of rows; begin each with [[{name}]]"
    return ""


def _list_places(text: str, shown: str, name: str, count: int) -> list[Place]:
    """The line of the head of each row; line 1 if the rows have another notation."""
    head = re.compile(rf"\s*\[\[\s*\"?{re.escape(name)}\"?\s*\]\]")
    lines = [number for number, line in enumerate(text.splitlines(), start=1) if head.match(line)]
    return [Place(shown, line) for line in lines] if len(lines) == count else [Place(shown, 1)] * count


def _list_whole(
    rows: Iterable[tuple[dict[str, Any], Place]], columns: Columns, problems: list[Problem]
) -> Iterator[tuple[dict[str, Any], Place]]:
    known = columns.texts + columns.lists
    for row, place in rows:
        values = {key: value.isoformat() if isinstance(value, datetime.date) else value for key, value in row.items()}
        fault = _find_row_fault(values, columns, known)
        if fault:
            problems.append(Problem(UNREADABLE, place, fault))
            continue
        whole = {key: values.get(key, "").strip() for key in columns.texts}
        yield whole | {key: tuple(values.get(key, ())) for key in columns.lists}, place


def _find_row_fault(row: dict[str, Any], columns: Columns, known: tuple[str, ...]) -> str:
    for key, value in row.items():
        if key not in known:
            return f"unknown entry '{key}'; known are {', '.join(known)}{suggest(key, known)}"
        if key in columns.texts and not isinstance(value, str):
            return f"'{key}' is no text; put it into quotation marks"
        if key in columns.lists and not (isinstance(value, list) and all(isinstance(each, str) for each in value)):
            return f"'{key}' is no list of texts"
    missing = [key for key in columns.needed if not row.get(key) or not str(row[key]).strip()]
    return f"says no {' and no '.join(missing)}" if missing else ""


def is_date(text: str) -> bool:
    """Whether `text` is a calendar day in ISO 8601 format: 2026-11-30."""
    try:
        return datetime.date.fromisoformat(text).isoformat() == text
    except ValueError:
        return False
