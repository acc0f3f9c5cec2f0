# SPDX-License-Identifier: Apache-2.0
"""Evidence of another commit, or of no known one."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.evidence import get_sources
from mamori_trace.model.project import Project

RULE = Rule(
    "evidence-stale", ERROR, "The evidence says where it comes from, and comes from the sources that are checked out."
)

_SHORT = 12
_HASH = re.compile(r"[0-9a-f]{7,64}")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    evidence = project.evidence
    if evidence.present:
        yield from _check_environment(project)
    told = get_sources(evidence.environment)
    for record in evidence.records.values():
        now = record.now or project.sources
        if now and record.sources not in ("", told, now):
            yield Place(record.shown, 1), "was made from other sources than those that are here; run the tests again", ""


def _check_environment(project: Project) -> Iterator[tuple[Place, str, str]]:
    evidence = project.evidence
    if not evidence.environment:
        told = any(problem.place.file == evidence.environment_place.file for problem in project.problems)
        recorded = evidence.records and all(record.sources for record in evidence.records.values())
        if not project.allow_missing and not told and not recorded:
            yield evidence.environment_place, "is missing: nothing tells on which commit the evidence was made", ""
    else:
        yield from _compare(project, evidence.environment, evidence.environment_place)
    if evidence.has_campaign and evidence.campaign_environment:
        yield from _compare(project, evidence.campaign_environment, evidence.campaign_place)


def _compare(project: Project, environment: dict[str, Any], place: Place) -> Iterator[tuple[Place, str, str]]:
    """A known hash of the sources decides, because it also detects uncommitted changes. Otherwise the commit decides."""
    made = str(environment.get("commit") or "")
    sources = get_sources(environment)
    if project.sources and sources:
        if sources != project.sources:
            at = f" (commit {made[:_SHORT]})" if made else ""
            yield place, f"evidence was made from other sources{at} than those that are here; run the tests again", ""
    elif project.head and not _HASH.fullmatch(made):
        yield place, f"commit is '{made}', which is no commit: nothing tells what the evidence was made of", ""
    elif project.head and not project.head.startswith(made) and not made.startswith(project.head):
        made_at, now_at = made[:_SHORT], project.head[:_SHORT]
        yield place, f"evidence was made at commit {made_at}, the source is at {now_at}; run the tests again", ""
