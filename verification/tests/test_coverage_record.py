# SPDX-License-Identifier: Apache-2.0
# Goal: the trace tool reads the record of the coverage gate for each function.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_trace.base.finding import Place, Problem
from mamori_trace.model.code import Function as TracedFunction
from mamori_trace.model.coverage import Coverage, Gap
from mamori_trace.model.evidence import Evidence
from mamori_trace.readers.coverage import read_coverage
from mamori_trace.readers.source_names import SourceNames
from verification.coverage.gaps import Row, find_gaps, judge
from verification.coverage.reached import Condition, Function
from verification.coverage.record import make_rows
from verification.coverage.report import Figures, write_evidence

FILE = "safety/src/alive.cpp"


@pytest.mark.verifies("SWR-TRC-032", technique="interface")
def test_the_trace_tool_reads_what_the_gate_writes(tmp_path: Path) -> None:
    conditions: dict[tuple[object, ...], Condition]
    conditions = {(1,): Condition(4, "silent > limit", True, True, False, True), (2,): Condition(5, "limit > 0", True, False, False, False)}
    functions = [Function(FILE, 3, "judge", 5, 8, conditions), Function(FILE, 10, "never", 0, 11), Function(FILE, 20, "alone", 2, 21)]
    segments = [[3, 43, 5, True, True, False], [6, 1, 0, True, True, False], [7, 1, 5, True, False, False], [8, 2, 0, False, False, False],
                [10, 9, 0, True, True, False], [11, 2, 0, False, False, False], [20, 9, 0, True, True, False], [21, 2, 0, False, False, False]]  # fmt: skip
    exported = {"data": [{"files": [{"filename": str(tmp_path / FILE), "segments": segments}]}, {"files": [], "functions": []}]}
    verdict = judge(find_gaps(functions), [Row(FILE, "never", "", "only the compiler calls it")])
    rows = make_rows(exported, functions, tmp_path)
    write_evidence(tmp_path / "evidence" / "coverage", [Figures(FILE)], verdict, "table", rows)

    evidence = Evidence()
    problems: list[Problem] = []
    read_coverage(tmp_path / "evidence", tmp_path, SourceNames(tmp_path, [FILE]), evidence, problems)
    coverage = Coverage(evidence.coverage_runs)
    judge_, never, alone = (coverage.measure(TracedFunction(FILE, one.name, one.line, one.last_line, one.line)) for one in functions)

    assert problems == []
    assert (judge_.executed, judge_.lines_reached, judge_.lines, judge_.branches_reached, judge_.branches) == (True, 5, 6, 3, 4)
    assert (judge_.conditions_shown, judge_.conditions) == (1, 2)
    assert judge_.gaps == [Gap(Place(FILE, 5), "'limit > 0': own effect on the decision")]
    assert (never.executed, never.accepted, never.lines_reached, never.lines) == (False, "only the compiler calls it", 0, 2)
    assert (alone.executed, alone.lines) == (True, 0)  # the lines of all programs together do not include it
