# SPDX-License-Identifier: Apache-2.0
"""Gaps of the coverage, and the checked list of accepted gaps with their reasons.

@satisfies SWR-VER-001, SWR-VER-002      Design: docs/design/test_strength.md#list-of-gaps
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import WorkError
from verification.coverage.reached import Function

LIST = Path(__file__).resolve().with_name("gaps.toml")
NEVER_CALLED = "never called"


@dataclass(frozen=True, order=True)
class Gap:
    """A function or condition that no test has covered."""

    file: str
    line: int
    function: str
    condition: str  # empty: the complete function
    missing: str

    def __str__(self) -> str:
        what = f"'{self.condition}' was not seen: {self.missing}" if self.condition else self.missing
        return f"{self.file}:{self.line}: {self.function}: {what}"


@dataclass(frozen=True)
class Row:
    """An accepted gap. It contains no line number, so that it stays valid after changes elsewhere in its file."""

    file: str
    function: str
    condition: str
    reason: str
    by_chance: bool = False  # the order of threads decides whether a run covers the condition, so the gap may be absent

    def __str__(self) -> str:
        return f"{self.file}: {self.function}: {self.condition or NEVER_CALLED}"

    def covers(self, gap: Gap) -> bool:
        return (self.file, self.function, self.condition) == (gap.file, gap.function, gap.condition)


@dataclass(frozen=True)
class Verdict:
    """The result of comparing the gaps with the list."""

    accepted: tuple[tuple[Gap, Row], ...]
    unlisted: tuple[Gap, ...]
    unused: tuple[Row, ...]

    @property
    def passed(self) -> bool:
        return not (self.unlisted or self.unused)


def find_gaps(functions: Iterable[Function]) -> list[Gap]:
    """Functions that were never called, and uncovered conditions of the other functions."""
    gaps = []
    for function in functions:
        if function.count == 0:
            gaps.append(Gap(function.file, function.line, function.name, "", NEVER_CALLED))
            continue
        for condition in function.conditions.values():
            if condition.missing:
                gaps.append(Gap(function.file, condition.line, function.name, condition.text, condition.missing))
    return sorted(gaps)


def read_list(path: Path = LIST) -> list[Row]:
    """@raise WorkError for an incomplete row, a row without a reason, or a duplicate row."""
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8")).get("gap", [])
    except tomllib.TOMLDecodeError as error:
        raise WorkError(f"{path}: {error}") from error
    rows: list[Row] = []
    for number, table in enumerate(tables, start=1):
        if set(table) - {"condition", "conditions", "by_chance"} != {"file", "function", "reason"} or {"condition", "conditions"} <= set(table):
            raise WorkError(f"{path}: row {number} needs file, function and reason, and may have by_chance, and condition or conditions;"
                            f" it has {sorted(table)}")
        for condition in table.get("conditions", [table.get("condition", "")]):
            row = Row(table["file"], table["function"], condition, table["reason"].strip(), table.get("by_chance", False))
            if not row.reason:
                raise WorkError(f"{path}: row {number} ({row}) gives no reason")
            if any(str(row) == str(other) for other in rows):
                raise WorkError(f"{path}: row {number} ({row}) is there twice")
            rows.append(row)
    return rows


HOST_DEPENDENT = ("ports/conformance/", "ports/posix_rt/")
"""Layers without a verdict: privileges and scheduling of the host decide which of their conditions a run shows."""


def judge(gaps: Sequence[Gap], rows: Sequence[Row]) -> Verdict:
    """Compares `gaps` with `rows`, in both directions. A difference in a layer of HOST_DEPENDENT is no fault."""
    accepted = []
    unlisted = []
    for gap in gaps:
        row = next((row for row in rows if row.covers(gap)), None)
        if row is None and not gap.file.startswith(HOST_DEPENDENT):
            unlisted.append(gap)
        elif row is not None:
            accepted.append((gap, row))
    required = [row for row in rows if not row.by_chance and not row.file.startswith(HOST_DEPENDENT)]
    unused = [row for row in required if not any(row is used for _, used in accepted)]
    return Verdict(tuple(accepted), tuple(unlisted), tuple(unused))
