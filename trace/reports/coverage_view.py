# SPDX-License-Identifier: Apache-2.0
"""Coverage of an item as the page shows it: its functions, and what the tests that verify it reached of them.

@satisfies SWR-TRC-064      Design: docs/design/trace_report.md#coverage-of-an-item
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from mamori.trace.model.finding import Place
from mamori.trace.model.project import Project


@dataclass(frozen=True, slots=True)
class FunctionCoverage:
    """One function that an item owns. `executed` None: unknown. Each pair is (covered, all); (0, 0): not measured."""

    symbol: str
    place: Place
    executed: bool | None = None
    lines: tuple[int, int] = (0, 0)
    branches: tuple[int, int] = (0, 0)
    conditions: tuple[int, int] = (0, 0)


def get_coverage(project: Project) -> Mapping[str, list[FunctionCoverage]]:
    """Functions by item, as the project offers them under `coverage_views`; empty where coverage was not read."""
    return getattr(project, "coverage_views", None) or {}
