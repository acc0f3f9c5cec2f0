# SPDX-License-Identifier: Apache-2.0
"""Test results and tagged code as plain HTML rows, which are readable without a script.

Python creates the rows, not the template, because there are ten thousand results.

@satisfies SWR-TRC-061      Design: docs/design/trace.md#data-in-the-page
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from markupsafe import Markup, escape

from mamori_trace.model.evidence import PASSED, CodeTag, TestResult
from mamori_trace.reports.static_view import format_badge
from mamori_trace.reports.view import SuiteView

Link = Callable[[str], str]
"""Mapping from item id to its link."""


def format_suites(suites: Iterable[SuiteView], link: Link) -> Markup:
    """One list for each suite."""
    return Markup("".join(
        f'<h3>{escape(suite.name)} <span class="quiet">{suite.kind}, {len(suite.results)} in {suite.time_s:.2f} s</span></h3>\n'
        f'<ul class="plain">{"".join(_format_result(result, link) for result in suite.results)}</ul>\n'
        for suite in suites
    ))  # fmt: skip


def _format_result(result: TestResult, link: Link) -> str:
    item = f" {link(result.requirement)}" if result.requirement else ""
    why = f'<br><span class="quiet pre">{escape(result.message)}</span>' if result.status != PASSED and result.message else ""
    return f"<li>{format_badge(result.status)} {escape(result.name)}{item}{why}</li>"


def format_files(files: Iterable[tuple[str, list[CodeTag]]], link: Link) -> Markup:
    """One table row for each file."""
    return Markup("".join(
        f"<tr><td><code>{escape(file)}</code></td><td>{', '.join(_format_tag(tag, link) for tag in tags)}</td></tr>\n"
        for file, tags in files
    ))  # fmt: skip


def _format_tag(tag: CodeTag, link: Link) -> str:
    symbol = f' <span class="quiet">{escape(tag.symbol)}</span>' if tag.symbol != "file" else ""
    return f"{link(tag.requirement)}{symbol}"
