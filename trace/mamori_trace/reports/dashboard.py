# SPDX-License-Identifier: Apache-2.0
"""Counts for the first view: verdicts by level and by SIL, findings by rule, results by kind.

@satisfies SWR-TRC-060      Design: docs/design/trace.md#report
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlencode

from mamori_trace.base.finding import ERROR, Finding
from mamori_trace.checks import list_rules
from mamori_trace.model.evidence import CAMPAIGN, INTEGRATION, NOT_SHOWN, PASSED, SKIPPED, UNBOUND, UNIT
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import VERIFIED, WORST_FIRST, Verdict

_KINDS = ((UNIT, "Unit tests"), (INTEGRATION, "Integration tests"), (CAMPAIGN, "Campaign, by results alone"))


@dataclass(frozen=True, slots=True)
class Share:
    """A segment of a bar: its word, count, share of the bar [%] and the view that a click opens."""

    word: str
    count: int
    percent: float
    target: str


@dataclass(frozen=True, slots=True)
class Bar:
    """One row of a card. `count` is the counted number; `note` follows."""

    name: str
    count: int
    note: str
    target: str
    shares: tuple[Share, ...]


def list_level_bars(project: Project, verdicts: Mapping[str, Verdict]) -> list[Bar]:
    """Verdicts of each level that has items, from the top of the V down."""
    bars = []
    for level in project.schema.levels.values():
        words = Counter(verdict.word for key, verdict in verdicts.items() if project.items[key].level == level.key)
        if words:
            shares = _make_shares(words, tuple(reversed(WORST_FIRST)), "matrix", level=level.key)
            bars.append(Bar(level.name, words[VERIFIED], f"of {words.total():,} verified", _address("matrix", level=level.key), shares))
    return bars


def list_sil_bars(project: Project, verdicts: Mapping[str, Verdict]) -> list[Bar]:
    """Verdicts of each safety integrity level that has items, highest first; empty if there is only one level."""
    groups: dict[str, Counter] = {sil: Counter() for sil in (*reversed(project.schema.sil), "")}
    for key, verdict in verdicts.items():
        groups.setdefault(project.items[key].sil, Counter())[verdict.word] += 1
    bars = []
    for sil, words in groups.items():
        if words:
            shares = _make_shares(words, tuple(reversed(WORST_FIRST)), "matrix", sil=sil or "none")
            name = f"SIL {sil}" if sil.isdecimal() else sil or "no SIL"
            bars.append(Bar(name, words[VERIFIED], f"of {words.total():,} verified", _address("matrix", sil=sil or "none"), shares))
    return bars if len(bars) > 1 else []


def list_result_bars(project: Project) -> list[Bar]:
    """Results of each kind of test."""
    bars = []
    for kind, name in _KINDS:
        words = Counter("failed" if result.failing else result.status for result in project.results if result.kind == kind)
        if words:
            shares = _make_shares(words, (PASSED, NOT_SHOWN, UNBOUND, SKIPPED, "failed"), "tests", kind=kind)
            bars.append(Bar(name, words[PASSED], f"of {words.total():,} passed", _address("tests", kind=kind), shares))
    missing = len(project.tests_without_result)
    if missing:
        share = Share("not run", missing, 100.0, _address("tests", status="not run"))
        bars.append(Bar("Tests without a result", missing, "not run", share.target, (share,)))
    return bars


def list_finding_bars(findings: list[Finding], count_max: int = 8) -> list[Bar]:
    """The rules with the most findings, errors before warnings. Bars are shares of the maximum count."""
    counts = Counter(finding.rule for finding in findings)
    severities = {finding.rule: finding.severity for finding in findings}
    order = [rule.id for rule in list_rules()]
    order += sorted(set(counts) - set(order))
    rules = sorted(counts, key=lambda rule: (severities[rule] != ERROR, -counts[rule], order.index(rule)))[:count_max]
    most = max(counts.values(), default=1)
    return [
        Bar(rule, counts[rule], severities[rule] + ("" if counts[rule] == 1 else "s"), _address("findings", rule=rule),
            (Share(severities[rule], counts[rule], round(100 * counts[rule] / most, 2), _address("findings", rule=rule)),))
        for rule in rules
    ]  # fmt: skip


def _make_shares(words: Counter, order: tuple[str, ...], view: str, **filters: str) -> tuple[Share, ...]:
    key = "verdict" if view == "matrix" else "status"
    return tuple(
        Share(word, words[word], round(100 * words[word] / words.total(), 2), _address(view, **filters, **{key: word}))
        for word in order
        if words[word]
    )


def _address(view: str, **filters: str) -> str:
    return f"#{view}?{urlencode(filters)}"
