# SPDX-License-Identifier: Apache-2.0
"""The course of a run: everything that a program of a fault campaign recorded (schema mamori.fault_course/1).

Design: docs/design/test_strength.md#courses
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from itertools import accumulate
from pathlib import Path
from typing import Any, TypeVar

from mamori_trace.base.errors import WorkError
from verification.faults.evaluation.host_causes import HostFigures, Spans

SCHEMA = "mamori.fault_course/1"
HOW_TO_FIX = "record the run again"

Row = TypeVar("Row")


@dataclass(frozen=True)
class Course:
    """One parsed course. Each method raises WorkError if an entry is missing or has another type."""

    name: str  # origin of the data, for messages
    content: Mapping[str, Any]

    def get_number(self, key: str) -> int:
        return int(self._get(key, int))

    def get_flag(self, key: str) -> bool:
        return bool(self._get(key, bool))

    def get_text(self, key: str) -> str:
        return str(self._get(key, str))

    def get_names(self, key: str) -> list[str]:
        return [str(name) for name in self._get(key, list)]

    def get_host(self) -> HostFigures:
        host = self._get("host", dict)
        names = [field.name for field in fields(HostFigures)]
        if sorted(host) != sorted(names) or not all(type(value) is int for value in host.values()):
            raise self._complain("host", f"expected the integers {', '.join(names)}")
        return HostFigures(**host)

    def get_spans(self, key: str) -> Spans:
        table = self._get_columns(key, ("begin_ns", "end_ns"))
        return Spans(table["begin_ns"], table["end_ns"])

    def get_rows(self, key: str, kind: type[Row]) -> list[Row]:
        """One object of the class `kind` (a named tuple) for each row; its fields are the columns."""
        names = kind.__annotations__
        columns = self._get_columns(key, tuple(names))
        return [kind(*values) for values in zip(*(columns[name] for name in names), strict=True)]

    def _get_columns(self, key: str, names: Sequence[str]) -> dict[str, list[int]]:
        """The values of a table; the file stores their differences from row to row."""
        table = self._get(key, dict)
        if sorted(table) != sorted(names):
            raise self._complain(key, f"has the columns {', '.join(sorted(table))}, expected {', '.join(names)}")
        if not all(isinstance(column, list) and all(type(value) is int for value in column) for column in table.values()):
            raise self._complain(key, "a column is not a list of integers")
        if len({len(column) for column in table.values()}) > 1:
            raise self._complain(key, "columns of different lengths")
        return {name: list(accumulate(table[name])) for name in names}

    def _get(self, key: str, kind: type) -> Any:
        value = self.content.get(key)
        if type(value) is not kind:
            raise self._complain(key, "missing" if value is None else f"not of type {kind.__name__}")
        return value

    def _complain(self, key: str, text: str) -> WorkError:
        return WorkError(f"{self.name}: {key}: {text}; {HOW_TO_FIX}")


def read_course(path: Path) -> Course:
    """@raise WorkError if the file is not a complete course."""
    try:
        content = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError) as error:
        raise WorkError(f"{path.name}: not a complete course: {error}; {HOW_TO_FIX}") from None
    schema = content.get("schema") if isinstance(content, dict) else None
    if schema != SCHEMA:
        raise WorkError(f"{path.name}: schema {schema}, expected {SCHEMA}; {HOW_TO_FIX}")
    return Course(path.name, content)
