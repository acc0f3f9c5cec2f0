# SPDX-License-Identifier: Apache-2.0
"""The checked list of mutants that no test can kill, each with its reason.

@satisfies SWR-VER-007      Design: docs/design/test_strength.md#equivalent-mutants
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import WorkError
from verification.mutation.operators import Mutant

LIST = Path(__file__).resolve().with_name("equivalent.toml")
KEYS = {"file", "before", "after", "reason"}


@dataclass(frozen=True)
class Row:
    """A mutant, identified by the code of its changed line, so that the row stays valid after changes elsewhere in its file. The comment at
    the end of the line and the spaces between its tokens are ignored."""

    file: str
    before: str
    after: str
    reason: str

    def __str__(self) -> str:
        return f"{self.file}: '{self.before}' -> '{self.after}'"


def read_list(path: Path = LIST) -> list[Row]:
    """@raise WorkError for an incomplete row, a row without a reason, or a duplicate row."""
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8")).get("mutant", [])
    except tomllib.TOMLDecodeError as error:
        raise WorkError(f"{path}: {error}") from error
    rows: list[Row] = []
    for number, table in enumerate(tables, start=1):
        if set(table) != KEYS:
            raise WorkError(f"{path}: row {number} needs {', '.join(sorted(KEYS))}; it has {', '.join(sorted(table))}")
        row = Row(table["file"], table["before"].strip(), table["after"].strip(), table["reason"].strip())
        if not row.reason:
            raise WorkError(f"{path}: row {number} ({row}) gives no reason")
        if any(str(row) == str(other) for other in rows):
            raise WorkError(f"{path}: row {number} ({row}) is there twice")
        rows.append(row)
    return rows


def match(rows: Sequence[Row], mutants: Sequence[Mutant], sources: Mapping[str, bytes]) -> tuple[dict[Mutant, Row], list[Row]]:
    """@return the row of each mutant that has one, and the rows for `sources` that match no mutant."""
    by_change = {(row.file, _keep_code(row.before), _keep_code(row.after)): row for row in rows}
    found: dict[Mutant, Row] = {}
    for mutant in mutants:
        before, after = mutant.get_change(sources[mutant.file])
        row = by_change.get((mutant.file, _keep_code(before), _keep_code(after)))
        if row is not None:
            found[mutant] = row
    used = set(map(str, found.values()))
    return found, [row for row in rows if row.file in sources and str(row) not in used]


def _keep_code(line: str) -> str:
    return " ".join(re.sub(r"\s//.*", "", line).split())
