# SPDX-License-Identifier: Apache-2.0
"""Items as a table, for the terminal and for documents.

@satisfies SWR-TRC-079      Design: docs/design/trace.md#query
"""

from __future__ import annotations

from mamori_trace.model.item import Item
from mamori_trace.model.query import RETIRED_WORD
from mamori_trace.model.verdict import Verdict
from mamori_trace.reports.text import Paint


def format_table(items: list[Item], verdicts: dict[str, Verdict], paint: Paint) -> str:
    """One line each, and their number."""
    words = [verdicts.get(item.id, Verdict(RETIRED_WORD)).word for item in items]
    widths = [max(map(len, column), default=0) for column in ([item.id for item in items], words)]
    rows = [
        f"{item.id:<{widths[0]}}  SIL {item.sil or '?':<2}  {paint.verdict(word)}{' ' * (widths[1] - len(word))}  {item.title}\n"
        for item, word in zip(items, words, strict=True)
    ]
    return "".join(rows) + f"{len(items)} items\n"


def format_markdown(items: list[Item]) -> str:
    """Without verdicts, because they change with each run. A vertical bar would end the cell, so it is escaped."""
    rows = [f"| {item.id} | {_escape(item.title)} | {_escape(item.statement)} | {', '.join(item.parents)} |\n" for item in items]
    return "| id | title | statement | parents |\n|---|---|---|---|\n" + "".join(rows)


def _escape(text: str) -> str:
    return text.replace("|", "\\|")
