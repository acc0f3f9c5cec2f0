# SPDX-License-Identifier: Apache-2.0
"""A system table as a Markdown page, for example for the safety manual of a machine.

@satisfies SWR-CYC-033      Design: docs/design/cost.md#text
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from mamori_tools.table.document import Table
from mamori_tools.table.text import Row, make_findings, make_headline, make_sections, select_columns

MARKS = re.compile(r"[\\`*~&\[\]<>|]|(?<!\w)_|_(?!\w)")
"""Letters with a meaning in Markdown; an underscore inside a word has none."""


def make_page(table: Table) -> str:
    lines = ["# System table", "", _escape(make_headline(table))]
    for title, rows in make_sections(table):
        lines += ["", *([f"## {_escape(title[0].upper() + title[1:])}", ""] if title else []), *_make_rows(select_columns(rows))]
    heading, *findings = (_escape(line.strip()) for line, _ in make_findings(table))
    lines += ["", "## Rules", "", heading, *([""] if findings else []), *(f"* {finding}" for finding in findings)]
    return "".join(f"{line}\n" for line in lines)


def _make_rows(rows: list[Row]) -> Iterator[str]:
    for number, row in enumerate(rows):
        yield f"| {' | '.join(_escape(cell) for cell in row)} |"
        if number == 0:
            yield "|" + "---|" * len(row)


def _escape(text: str) -> str:
    return MARKS.sub(r"\\\g<0>", text)
