# SPDX-License-Identifier: Apache-2.0
"""Coverage of an item on the page: its functions, and the coverage that its verifying tests reached.

@satisfies SWR-TRC-064      Design: docs/design/trace.md#coverage
"""

from __future__ import annotations

from dataclasses import dataclass

from mamori_trace.base.finding import Place
from mamori_trace.model.code import Function
from mamori_trace.model.coverage import Gap, Reached
from mamori_trace.model.project import Project


@dataclass(frozen=True, slots=True)
class FunctionCoverage:
    """One function that an item owns. `executed` None: there is no counter. Each pair is (reached, all); (0, 0): not measured.

    `accepted` is the reason why the function need not be called, or empty.
    """

    symbol: str
    place: Place
    executed: bool | None = None
    lines: tuple[int, int] = (0, 0)
    branches: tuple[int, int] = (0, 0)
    conditions: tuple[int, int] = (0, 0)
    gaps: tuple[Gap, ...] = ()
    accepted: str = ""


def make_coverage_views(project: Project) -> dict[str, list[FunctionCoverage]]:
    """Functions by item, unexecuted ones first; empty without coverage in the evidence."""
    if not project.evidence.coverage_runs:
        return {}
    return {key: _list_functions(project, key, functions) for key, functions in project.functions_of.items()}


def _list_functions(project: Project, key: str, functions: list[Function]) -> list[FunctionCoverage]:
    coverage = project.find_coverage([key])
    views = [_make_view(function, coverage.measure(function)) for function in functions]
    return sorted(views, key=lambda view: (view.executed is None, view.executed is True, view.place, view.symbol))


def _make_view(function: Function, reached: Reached) -> FunctionCoverage:
    return FunctionCoverage(
        symbol=function.name,
        place=function.place,
        executed=reached.executed if reached.functions_measured else None,
        lines=(reached.lines_reached, reached.lines),
        branches=(reached.branches_reached, reached.branches),
        conditions=(reached.conditions_shown, reached.conditions),
        gaps=tuple(reached.gaps),
        accepted=reached.accepted,
    )
