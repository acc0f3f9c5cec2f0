# SPDX-License-Identifier: Apache-2.0
# Goal: coverage of each format gives the same result for a function; code that its tests do not reach is reported; invalid files are rejected.
# Method: the clean sample with one source file and its coverage files from llvm-cov 19, LCOV 2, Cobertura and the project's gate.
from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Sample, record

from mamori_trace.checks import list_rule_ids
from mamori_trace.model.project import Project
from mamori_trace.readers.llvm_cov import calc_line_counts
from mamori_trace.readers.project import read_project

SOURCE = """#include "alive.hpp"

bool mamori::judge(int silent, int limit) {
    if (silent > limit && limit > 0) {
        return true;
    }
    return false;
}

void mamori::LateReporter::step() {
}
"""
NAME = "/home/someone/clone/safety/src/alive.cpp"
ELSEWHERE = "/usr/include/c++/12/bits/move.h"


def make_llvm(step_count: int = 3, second_shown: bool = True) -> str:
    mcdc = [[4, 9, 4, 36, 0, 5, [True, second_shown]]]
    segments = [[3, 43, 5, True, True, False], [4, 38, 2, True, True, False], [6, 6, 5, True, False, False], [7, 5, 3, True, True, False],
                [8, 2, 0, False, False, False], [10, 37, step_count, True, True, False], [11, 2, 0, False, False, False]]  # fmt: skip
    branches = [[4, 9, 4, 23, 3, 2, 0, 0, 6], [4, 27, 4, 36, 2, 1, 0, 0, 6]]
    functions = [{"name": "_ZN6mamori5judgeEii", "count": 5, "filenames": [NAME], "branches": branches, "mcdc_records": mcdc,
                  "regions": [[3, 43, 8, 2, 5, 0, 0, 0], [4, 38, 6, 6, 2, 0, 0, 0]]},
                 {"name": "_ZN6mamori12LateReporter4stepEv", "count": step_count, "filenames": [NAME], "branches": [], "mcdc_records": [],
                  "regions": [[10, 37, 11, 2, step_count, 0, 0, 0]]}]  # fmt: skip
    files = [{"filename": NAME, "segments": segments, "branches": branches, "mcdc_records": mcdc, "expansions": [], "summary": {}},
             {"filename": ELSEWHERE, "segments": [], "branches": [], "mcdc_records": [], "expansions": [], "summary": {}}]  # fmt: skip
    return json.dumps({"data": [{"files": files, "functions": functions, "totals": {}}], "type": "llvm.coverage.json.export", "version": "2.0.1"})


def make_lcov(step_count: int = 3, second_shown: bool = True) -> str:
    return f"""TN:
SF:{NAME}
FN:3,8,_ZN6mamori5judgeEii
FNDA:5,_ZN6mamori5judgeEii
FN:10,_ZN6mamori12LateReporter4stepEv
FNDA:{step_count},_ZN6mamori12LateReporter4stepEv
FNF:2
BRDA:4,0,0,3
BRDA:4,0,1,2
BRDA:4,0,2,2
BRDA:4,0,3,1
MCDC:4,2,t,1,0,silent > limit
MCDC:4,2,f,1,0,silent > limit
MCDC:4,2,t,1,1,limit > f(1, 2)
MCDC:4,2,f,{int(second_shown)},1,limit > f(1, 2)
DA:3,5
DA:4,5
DA:5,2
DA:6,2
DA:7,3
DA:8,5
DA:10,{step_count}
DA:11,{step_count}
LF:8
end_of_record
SF:{ELSEWHERE}
DA:9,1
end_of_record
"""


def make_cobertura(step_count: int = 3, second_shown: bool = True) -> str:
    lines = "".join(f'<line number="{line}" hits="{hits}"/>' for line, hits in ((3, 5), (5, 2), (6, 2), (7, 3), (8, 5), (10, step_count), (11, step_count)))
    branch = '<line number="4" hits="5" branch="true" condition-coverage="100% (4/4)"/>'
    return f"""<?xml version="1.0" ?>
<!DOCTYPE coverage SYSTEM "http://cobertura.sourceforge.net/xml/coverage-04.dtd">
<coverage line-rate="1" version="1"><sources><source>/home/someone/clone</source></sources><packages><package name="safety">
<classes><class name="alive" filename="safety/src/alive.cpp"><methods><method name="judge"><lines>{branch}</lines></method></methods>
<lines>{branch}{lines}</lines></class></classes></package></packages></coverage>
"""


def make_record(step_count: int = 3, second_shown: bool = True, reason: str | None = None, step_reason: str | None = None) -> str:
    row = {"file": "safety/src/alive.cpp", "count": 5, "outcomes": 0, "outcomes_reached": 0, "conditions": 0, "conditions_shown": 0}
    judge = {**row, "name": "judge", "line": 3, "last_line": 8, "lines": [3, 4, 5, 6, 7, 8], "lines_missed": [], "outcomes": 4,
             "outcomes_reached": 4, "conditions": 2, "conditions_shown": 1 + second_shown}  # fmt: skip
    step = {**row, "name": "LateReporter::step", "line": 10, "last_line": 11, "count": step_count, "lines": [10, 11],
            "lines_missed": [] if step_count else [10, 11]}  # fmt: skip
    gap = {"file": "safety/src/alive.cpp", "line": 4, "function": "judge", "condition": "limit > 0", "missing": "own effect", "reason": reason}
    never = {"file": "safety/src/alive.cpp", "line": 10, "function": "step", "condition": "", "missing": "never called", "reason": step_reason}
    gaps = [gap] * (not second_shown) + [never] * (step_count == 0)
    return json.dumps({"schema": "mamori.coverage/1", "passed": True, "functions": [judge, step], "gaps": gaps})


FORMATS = {"a.json": make_llvm, "a.info": make_lcov, "a.xml": make_cobertura, "coverage.json": make_record}
WITH_MCDC = ("a.json", "a.info", "coverage.json")


@pytest.fixture
def covered(sample: Sample) -> Sample:
    """The clean sample with a source file: SWR-SUP-001 (SIL 3) owns its functions, SWR-SUP-002 owns one of them."""
    (sample.root / "safety/src").mkdir()
    (sample.root / "safety/src/alive.cpp").write_text(SOURCE, encoding="utf-8")
    (sample.root / "requirements/schema/code.toml").write_text('schema = "mamori.code/1"\ntraced = ["safety/src"]\n')
    text = (sample.root / "requirements/software/software.md").read_text()
    text = text.replace("- SIL: 2", "- SIL: 3").replace("- Design: -", "- Design: docs/design/arm.md#hazards")
    (sample.root / "requirements/software/software.md").write_text(text)
    sample.review()
    return sample


def write(sample: Sample, name: str, text: str | bytes) -> Path:
    path = sample.evidence / "coverage" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def load(sample: Sample) -> Project:
    record(sample.evidence)
    return read_project(sample.root, None, list_rule_ids())


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.verifies("SWR-TRC-032", technique="back_to_back", polarity="nominal")
def test_each_format_says_the_same_of_a_requirement_s_functions(covered: Sample, name: str) -> None:
    write(covered, name, FORMATS[name]())

    project = load(covered)
    reached = project.measure("SWR-SUP-001")

    assert [problem.message for problem in project.problems] == []
    assert (reached.functions, reached.functions_measured, reached.functions_executed) == (2, 2, 2)
    assert (reached.lines, reached.lines_reached) == (8, 8)
    assert (reached.branches, reached.branches_reached) == (4, 4)
    assert (reached.conditions, reached.conditions_shown) == ((2, 2) if name in WITH_MCDC else (0, 0))
    assert project.measure("SWR-SUP-002").lines == 2


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.verifies("SWR-TRC-032", technique="requirements_based", polarity="nominal")
def test_covered_code_gives_no_finding(covered: Sample, trace: Callable, name: str) -> None:
    write(covered, name, FORMATS[name]())

    outcome = trace("check", "--root", covered.root, "--output", "json")

    assert (outcome.status, outcome.content["findings"]) == (0, [])
    item = next(one for one in outcome.content["items"] if one["id"] == "SWR-SUP-001")
    assert item["coverage"]["functions_executed"] == 2 and item["coverage"]["gaps"] == []
    assert "functions executed 2/2, lines 8/8" in trace("show", "SWR-SUP-001", "--root", covered.root).out


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.verifies("SWR-TRC-033", technique="fault_injection", polarity="violation")
def test_a_function_that_no_test_executes_is_told(covered: Sample, trace: Callable, name: str) -> None:
    write(covered, name, FORMATS[name](step_count=0))

    outcome = trace("check", "--root", covered.root, "--output", "json")

    assert outcome.status == 1
    found = [(one["rule"], one["file"], one["line"]) for one in outcome.content["findings"]]
    assert found == [("function-unexecuted", "safety/src/alive.cpp", 10)]
    assert "LateReporter::step (SWR-SUP-002, SWR-SUP-001)" in outcome.content["findings"][0]["message"]


@pytest.mark.verifies("SWR-TRC-033", technique="fault_injection", polarity="violation")
def test_a_source_file_that_no_coverage_names_is_told(covered: Sample, trace: Callable) -> None:
    write(covered, "a.info", make_lcov())
    (covered.root / "safety/src/late.cpp").write_text("/// @satisfies SWR-SUP-002\nvoid late() {}\n")

    outcome = trace("check", "--root", covered.root, "--output", "json")

    assert [(one["rule"], one["file"]) for one in outcome.content["findings"]] == [("function-unexecuted", "safety/src/late.cpp")]


@pytest.mark.verifies("SWR-TRC-033", technique="requirements_based", polarity="violation")
def test_a_function_counts_only_when_a_test_of_its_requirement_executes_it(covered: Sample, trace: Callable) -> None:
    write(covered, "all.info", make_lcov())
    write(covered, "by_test/AliveTest.SilenceIsReported.info", make_lcov(step_count=0))
    write(covered, "by_test/Other.test.info", make_lcov())

    findings = trace("check", "--root", covered.root, "--output", "json").content["findings"]
    assert [(one["rule"], one["line"]) for one in findings] == [("function-unexecuted", 10)]
    assert "by a test that verifies these" in findings[0]["message"]

    write(covered, "by_test/Limits%2FLateTest.LatenessIsReported%2F0.info", make_lcov())
    assert trace("check", "--root", covered.root).status == 0


@pytest.mark.verifies("SWR-TRC-033", technique="requirements_based", polarity="nominal")
def test_a_reason_of_the_gate_excuses_function_and_gap(covered: Sample, trace: Callable) -> None:
    write(covered, "coverage.json", make_record(step_count=0, second_shown=False, reason="the compiler decides it", step_reason="never returns"))

    outcome = trace("check", "--root", covered.root, "--output", "json")

    assert (outcome.status, outcome.content["findings"]) == (0, [])
    item = next(one for one in outcome.content["items"] if one["id"] == "SWR-SUP-001")
    assert [(gap["line"], gap["reason"]) for gap in item["coverage"]["gaps"]] == [(4, "the compiler decides it")]


@pytest.mark.parametrize("name", WITH_MCDC)
@pytest.mark.verifies("SWR-TRC-034", technique="fault_injection", polarity="violation")
def test_a_gap_in_a_function_of_sil_3_is_told(covered: Sample, trace: Callable, name: str) -> None:
    write(covered, name, FORMATS[name](second_shown=False))

    outcome = trace("check", "--root", covered.root, "--output", "json")

    assert outcome.status == 1
    found = [(one["rule"], one["file"], one["line"], one["item"]) for one in outcome.content["findings"]]
    assert found == [("mcdc-gap", "safety/src/alive.cpp", 4, "SWR-SUP-001")]


@pytest.mark.verifies("SWR-TRC-034", technique="boundary_values", polarity="nominal")
def test_below_sil_3_no_mcdc_is_demanded(covered: Sample, trace: Callable) -> None:
    text = (covered.root / "requirements/software/software.md").read_text()
    (covered.root / "requirements/software/software.md").write_text(text.replace("- SIL: 3", "- SIL: 2"))
    covered.review()
    write(covered, "a.json", make_llvm(second_shown=False))

    assert trace("check", "--root", covered.root).status == 0


@pytest.mark.verifies("SWR-TRC-032", technique="requirements_based", polarity="nominal")
def test_runs_and_instantiations_add_up(covered: Sample) -> None:
    write(covered, "one.json", make_llvm(step_count=0, second_shown=False))
    write(covered, "two.info", make_lcov(step_count=1))

    reached = load(covered).measure("SWR-SUP-002")

    assert (reached.functions_executed, reached.lines_reached) == (1, 2)


@pytest.mark.verifies("SWR-TRC-032", technique="boundary_values", polarity="nominal")
def test_lines_are_counted_as_llvm_cov_shows_them() -> None:
    segments = [[1, 1, 7, True, True, False], [3, 5, 0, True, True, False], [3, 9, 7, True, False, False],
                [4, 1, 0, False, True, False], [5, 1, 7, True, False, False], [7, 2, 0, False, False, False]]  # fmt: skip

    assert calc_line_counts(segments) == {1: 7, 2: 7, 3: 7, 6: 7, 7: 7}
    assert calc_line_counts([]) == {}


BROKEN: dict[str, tuple[str, str | bytes, str]] = {
    "json-cut": ("a.json", make_llvm()[:-9], "not whole JSON"),
    "json-other": ("a.json", '{"type": "other"}', "neither"),
    "json-list": ("a.json", "[1]", "no coverage"),
    "json-deep": ("a.json", "[" * 200000, "nested"),
    "json-shape": ("a.json", '{"type": "llvm.coverage.json.export", "data": [{"files": [{"filename": 3}]}]}', "format"),
    "json-summary": ("a.json", make_llvm().replace('"segments"', '"other"'), "summary-only"),
    "record-shape": ("coverage.json", make_record().replace('"last_line": 8', '"last_line": "8"'), "last_line"),
    "lcov-cut": ("a.info", make_lcov().rpartition("end_of_record")[0], "within a record"),
    "lcov-number": ("a.info", make_lcov().replace("DA:5,2", "DA:5,two"), "line 18"),
    "lcov-other": ("a.info", "hello\n", "line 1"),
    "lcov-empty": ("a.info", "", "line 1"),
    "lcov-bytes": ("a.info", make_lcov().encode("utf-16"), "UTF-8"),
    "xml-cut": ("a.xml", make_cobertura()[:-20], "not whole XML"),
    "xml-bomb": ("a.xml", '<?xml version="1.0"?>\n<!DOCTYPE coverage [<!ENTITY a "aa"><!ENTITY b "&a;&a;">]>\n<coverage>&b;</coverage>', "DTD"),
    "xml-other": ("a.xml", "<testsuites/>", "no Cobertura"),
    "xml-line": ("a.xml", make_cobertura().replace('hits="2"', 'hits="x"'), "number and hits"),
}  # fmt: skip


@pytest.mark.parametrize("name", BROKEN)
@pytest.mark.verifies("SWR-TRC-032", technique="error_guessing", polarity="violation")
def test_a_broken_file_is_one_finding_and_gives_nothing(covered: Sample, trace: Callable, name: str) -> None:
    file, text, named = BROKEN[name]
    path = write(covered, file, text)

    outcome = trace("check", "--root", covered.root, "--output", "json")

    assert outcome.status == 2
    found = [one for one in outcome.content["findings"] if one["rule"] == "unreadable-input"]
    assert [one["file"] for one in found] == [path.relative_to(covered.root).as_posix()]
    assert named in f"line {found[0]['line']}: {found[0]['message']}"
    assert load(covered).evidence.coverage_runs == []
