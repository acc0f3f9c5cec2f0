# SPDX-License-Identifier: Apache-2.0
"""The chain of one item, from hazards and needs to results, and its history.

@satisfies SWR-TRC-081      Design: docs/design/trace.md#query
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from mamori_trace.model.item import Item
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import Verdict
from mamori_trace.readers.history import Event
from mamori_trace.reports.text import Paint

Row = tuple[str, int, bool]  # id, depth, whether it is already listed


def format_chain(project: Project, item: Item, verdicts: dict[str, Verdict], paint: Paint) -> str:
    """The items above and below as two trees; repeated items are only named."""
    lines: list[str] = []
    for title, rows in (("chain above", _list_above(project, item)), ("chain below", _list_below(project, item))):
        if rows:
            lines += ["", f"  {title}"]
        for key, depth, again in rows:
            lines.append(f"    {'  ' * depth}{_name(project, key, verdicts, paint)}{' (see above)' if again else ''}")
            if not again and title == "chain below":
                lines += [f"    {'  ' * depth}    {text}" for text in _list_evidence(project, key)]
    return "".join(f"{line}\n" for line in lines)


def make_chain(project: Project, item: Item, verdicts: dict[str, Verdict]) -> dict[str, Any]:
    """The same as plain values; each item once, at its smallest depth."""
    return {
        "above": [_make_row(project, row, verdicts) for row in _list_above(project, item) if not row[2]],
        "below": [_make_row(project, row, verdicts) for row in _list_below(project, item) if not row[2]],
    }


def format_history(events: list[Event], gap: str) -> str:
    """One line for each commit, newest first."""
    rows = [f"    {event.commit[:12]} {event.date} {event.author}: {event.what} ({event.subject})\n" for event in events]
    if not rows:
        rows = ["    no commit holds the item yet\n"]
    return "\n  history\n" + "".join(rows) + (f"    {gap}\n" if gap else "")


def _list_above(project: Project, item: Item) -> list[Row]:
    return _walk(item.id, lambda key: project.items[key].parents if key in project.items else ())


def _list_below(project: Project, item: Item) -> list[Row]:
    return _walk(item.id, lambda key: [child.id for child in project.children_of.get(key, [])])


def _walk(start: str, follow: Callable[[str], Iterable[str]]) -> list[Row]:
    """Depth first; a repeated item is not entered again, which also stops cycles."""
    rows: list[Row] = []
    seen = {start}
    stack = [(key, 0) for key in reversed(list(follow(start)))]
    while stack:
        key, depth = stack.pop()
        rows.append((key, depth, key in seen))
        if key not in seen:
            seen.add(key)
            stack.extend((below, depth + 1) for below in reversed(list(follow(key))))
    return rows


def _list_evidence(project: Project, key: str) -> list[str]:
    """Short list of code, results and cases."""
    rows = [f"code: {tag.place} ({tag.symbol})" for tag in project.tags_of.get(key, [])]
    rows += [f"{result.status}: {result.title}" for result in project.results_of.get(key, [])]
    rows += [f"no result: {test.title}" for test in project.unexecuted_of.get(key, [])]
    return rows + [f"{case.status}: {case.id}" for case in project.cases_of.get(key, [])]


def _name(project: Project, key: str, verdicts: dict[str, Verdict], paint: Paint) -> str:
    item = project.items.get(key)
    if item is None:
        return f"{key} (defined nowhere)"
    return f"{key} {item.title}  [{paint.verdict(verdicts[key].word if key in verdicts else 'retired')}]"


def _make_row(project: Project, row: Row, verdicts: dict[str, Verdict]) -> dict[str, Any]:
    key, depth, _ = row
    item = project.items.get(key)
    return {"id": key, "depth": depth, "title": item.title if item else "", "verdict": verdicts[key].word if key in verdicts else ""}
