# SPDX-License-Identifier: Apache-2.0
"""Matrix and items as plain HTML rows, which are readable without a script and on paper.

Python creates the rows, not the template, because there are ten thousand items.

@satisfies SWR-TRC-061      Design: docs/design/trace.md#data-in-the-page
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from html import escape
from urllib.parse import quote

from markupsafe import Markup

from mamori_trace.base.finding import Finding, Place
from mamori_trace.model.evidence import PASSED
from mamori_trace.model.item import Item
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import Verdict
from mamori_trace.readers.item_history import Change

_SAFE_IN_FRAGMENT = "/?:@!$'()*+,;=-._~"


@dataclass(frozen=True, slots=True)
class StaticView:
    """Looks up the contents of the rows of an item."""

    project: Project
    verdicts: Mapping[str, Verdict]
    findings: Mapping[str, list[Finding]]
    anchors: Mapping[str, str]
    history: Mapping[str, list[Change]]
    links: dict[str, str] = field(default_factory=dict)
    """Links of items, cached because each occurs in several rows."""

    def format_matrix(self, items: Iterable[Item]) -> Markup:
        """One table row for each item."""
        return Markup("".join(self._format_matrix_row(item) for item in items))

    def format_items(self, items: Iterable[Item]) -> Markup:
        """One small table for each item."""
        return Markup("".join(self._format_item(item) for item in items))

    def _format_matrix_row(self, item: Item) -> str:
        project = self.project
        results = project.results_of.get(item.id, [])
        passed = sum(result.status == "passed" for result in results)
        count = len(results) + len(project.unexecuted_of.get(item.id, []))
        cases = project.cases_of.get(item.id, [])
        good = sum(case.status == PASSED for case in cases)
        return (
            f"<tr><td>{self.link_item(item.id)} {escape(item.title)}<td>{escape(item.sil)}<td>{len(project.tags_of.get(item.id, [])) or ''}"
            f"<td>{f'{passed}/{count}' if count else ''}<td>{f'{good}/{len(cases)}' if cases else ''}"
            f"<td>{format_badge(self.verdicts[item.id].word)}</tr>\n"
        )

    def _format_item(self, item: Item) -> str:
        verdict = self.verdicts[item.id]
        facts = ", ".join(filter(None, (_name_sil(item.sil), item.status, f"verify: {', '.join(item.verify) or '–'}",
                                        f"polarity: {', '.join(item.polarity) or '–'}", f"design: {item.design or '–'}")))  # fmt: skip
        rows = (
            ("Statement", escape(item.statement)),
            ("Rationale", escape(item.rationale)),
            ("Against it", escape("; ".join(verdict.reasons))),
            ("Comes from", self._link_items(item.parents)),
            ("Refined by", self._link_items([child.id for child in self.project.children_of.get(item.id, [])])),
            ("Code", "<br>".join(self._list_code(item))),
            ("Tests", "<br>".join(self._list_tests(item))),
            ("Campaign", "<br>".join(self._list_cases(item))),
            ("Findings", "<br>".join([f"{format_badge(row.severity)} {escape(row.message)} {format_place(row.place)}"
                                      for row in self.findings.get(item.id, [])])),
            ("History", "<br>".join(map(_format_change, self.history.get(item.id, [])))),
            ("Facts", f"{escape(facts)}, {format_place(item.place)}"),
        )  # fmt: skip
        body = "".join([f"<tr><th>{name}<td>{text}" for name, text in rows if text])
        return (
            f'<article class="still" id="item/{escape(item.id)}"><h4><b class="id">{escape(item.id)}</b> {escape(item.title)} '
            f"{format_badge(verdict.word)}</h4><table>{body}</table></article>\n"
        )

    def _list_code(self, item: Item) -> list[str]:
        tags = sorted(self.project.tags_of.get(item.id, []), key=lambda tag: tag.place)
        return [format_place(tag.place) + (f" {escape(tag.symbol)}" if tag.symbol != "file" else "") for tag in tags]

    def _list_tests(self, item: Item) -> list[str]:
        results = sorted(self.project.results_of.get(item.id, []), key=lambda result: (result.title, result.place))
        tests = sorted(self.project.unexecuted_of.get(item.id, []), key=lambda test: test.place)
        return [
            *(f"{format_badge(result.status)} {escape(result.title)} <i>{escape(result.polarity or 'nominal')}</i>" for result in results),
            *(f"{format_badge('not run')} {escape(test.title)} <i>{escape(test.polarity)}</i>" for test in tests),
        ]

    def _list_cases(self, item: Item) -> list[str]:
        cases = sorted(self.project.cases_of.get(item.id, []), key=lambda case: case.id)
        return [
            f'{format_badge(case.status)} <a href="#{escape(self.anchors.get(case.id, "campaign"))}">{escape(case.id)}</a>'
            f" <i>{escape(case.get_polarity(item.id))}</i>"
            for case in cases
        ]

    def _link_items(self, ids: Iterable[str]) -> str:
        return ", ".join(map(self.link_item, dict.fromkeys(ids)))

    def link_item(self, item_id: str) -> str:
        """A link to the item in the page, or the plain id if there is no such item."""
        if item_id not in self.links:
            start, end = ('<span class="unknown">', "span")
            if item_id in self.verdicts:
                start, end = (f'<a class="id" href="{get_address(item_id)}">', "a")
            self.links[item_id] = f"{start}{escape(item_id)}</{end}>"
        return self.links[item_id]


def get_address(item_id: str) -> str:
    """Fragment of an item's page."""
    return f"#item/{quote(item_id, safe=_SAFE_IN_FRAGMENT)}"


@cache
def _format_change(change: Change) -> str:
    return f"{change.date} <code>{escape(change.commit)}</code> {escape(change.subject)}"


@cache
def _name_sil(sil: str) -> str:
    """Without the prefix SIL for QM, which is not a safety integrity level."""
    return f"SIL {sil}" if sil.isdecimal() else sil


def format_badge(word: str) -> str:
    return f'<span class="badge {word.replace(" ", "-")}">{escape(word)}</span>'


def format_place(place: Place) -> str:
    return f'<code class="place">{escape(place.file)}:{place.line}</code>'
