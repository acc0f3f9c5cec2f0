# SPDX-License-Identifier: Apache-2.0
# Goal: each static-analysis finding is reported once at its location, except suppressed findings; invalid results are rejected.
from __future__ import annotations

import json
from collections.abc import Callable

import pytest
from trace_sample import Sample

HEADER = "safety/include/alive.hpp"
ELSEWHERE = f"/home/someone/clone/{HEADER}"


def make_sarif(**more: object) -> str:
    place = {"physicalLocation": {"artifactLocation": {"uri": f"file://{ELSEWHERE}"}, "region": {"startLine": 7}}}
    result = {"ruleId": "bugprone-x", "message": {"text": "narrows\nmore"}, "locations": [place], **more}
    return json.dumps({"version": "2.1.0", "runs": [{"tool": {"driver": {"name": "tool"}}, "results": [result]}, {"tool": {}}]})


CPPCHECK = f"""<?xml version="1.0" encoding="UTF-8"?>
<results version="2"><cppcheck version="2.10"/><errors>
<error id="bugprone-x" severity="warning" msg="narrows" verbose="narrows much"><location file="{HEADER}" line="7" column="3"/>
<location file="other.hpp" line="1"/></error>
<error id="missingInclude" severity="information" msg="Include file not found"/>
</errors></results>
"""
TIDY_TEXT = f"""[1/2] clang-tidy-19 -p build {ELSEWHERE}
{ELSEWHERE}:7:3: warning: narrows [bugprone-x,-warnings-as-errors]
    7 | int a = 3.0;
      |         ^
{ELSEWHERE}:3:1: note: declared here
{ELSEWHERE}:7:3: warning: narrows [bugprone-x]
2 warnings generated.
"""


def make_yaml(sample: Sample) -> str:
    path = sample.root / HEADER
    offset = len("\n".join(path.read_text().split("\n")[:6])) + 1
    return f"""---
MainSourceFile:  '{path}'
Diagnostics:
  - DiagnosticName:  bugprone-x
    DiagnosticMessage:
      Message:         narrows
      FilePath:        '{path}'
      FileOffset:      {offset}
      Replacements:    []
    Level:           Warning
  - DiagnosticName:  bugprone-y
    DiagnosticMessage: {{Message: remark, FilePath: '', FileOffset: 0}}
    Level:           Remark
...
"""


MAKERS: dict[str, Callable[[Sample], str]] = {
    "tool.sarif": lambda sample: make_sarif(),
    "tool.sarif.json": lambda sample: make_sarif(level="error", suppressions=[{"kind": "external", "status": "rejected"}]),
    "cppcheck.xml": lambda sample: CPPCHECK,
    "tidy.txt": lambda sample: TIDY_TEXT,
    "tidy.log": lambda sample: TIDY_TEXT,
    "tidy.yaml": make_yaml,
}


def check(sample: Sample, trace: Callable, name: str, text: str) -> tuple[int, list[tuple[str, str, int, str]]]:
    (sample.evidence / "static").mkdir(exist_ok=True)
    (sample.evidence / "static" / name).write_text(text, encoding="utf-8")
    outcome = trace("check", "--root", sample.root, "--output", "json")
    return outcome.status, [(one["rule"], one["file"], one["line"], one["message"]) for one in outcome.content["findings"]]


@pytest.mark.parametrize("name", MAKERS)
@pytest.mark.verifies("SWR-TRC-043", technique="back_to_back", polarity="violation")
def test_a_finding_of_each_tool_is_told_once_at_its_place(sample: Sample, trace: Callable, name: str) -> None:
    assert check(sample, trace, name, MAKERS[name](sample)) == (1, [("analysis-finding", HEADER, 7, "bugprone-x: narrows")])


@pytest.mark.verifies("SWR-TRC-043", technique="requirements_based", polarity="violation")
def test_the_same_finding_of_two_files_is_one_and_a_foreign_place_is_told_where_it_was_read(sample: Sample, trace: Callable) -> None:
    check(sample, trace, "a.txt", TIDY_TEXT)
    _, found = check(sample, trace, "b.txt", TIDY_TEXT + "/usr/include/c++/12/vector:9:1: error: broken [clang-diagnostic-error]\n")

    assert [(rule, file, line) for rule, file, line, _ in found] == [
        ("analysis-finding", "build/host-release/evidence/static/b.txt", 1), ("analysis-finding", HEADER, 7),
    ]  # fmt: skip
    assert "/usr/include/c++/12/vector:9: broken" in found[0][3]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.sarif", make_sarif(suppressions=[{"kind": "inSource"}])),
        ("a.sarif", make_sarif(level="note")),
        ("a.sarif", make_sarif(kind="pass")),
        ("a.sarif", make_sarif(baselineState="absent")),
        ("a.sarif", '{"version": "2.1.0", "runs": []}'),
        ("a.xml", '<results version="2"><cppcheck version="2.10"/><errors/></results>'),
        ("a.txt", "2310 warnings generated.\n"),
        ("a.yaml", "MainSourceFile: ''\nDiagnostics: []\n"),
        ("readme.md", "not a result"),
    ],
)
@pytest.mark.verifies("SWR-TRC-043", technique="equivalence_classes", polarity="nominal")
def test_what_is_no_open_finding_is_not_told(sample: Sample, trace: Callable, name: str, text: str) -> None:
    assert check(sample, trace, name, text) == (0, [])


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.sarif", make_sarif()[:-4]),
        ("a.sarif", "[]"),
        ("a.sarif", '{"version": "1.0.0", "runs": []}'),
        ("a.sarif", '{"version": "2.1.0", "runs": [{"results": [{"ruleId": "x"}]}]}'),
        ("a.json", "[" * 100_000),
        ("a.xml", CPPCHECK[:-30]),
        ("a.xml", "<testsuites/>"),
        ("a.xml", CPPCHECK.replace('line="7"', 'line="seven"')),
        ("a.xml", '<!DOCTYPE results [<!ENTITY a "b">]><results/>'),
        ("a.yaml", "Diagnostics: [\n"),
        ("a.yaml", "3\n"),
        ("a.yaml", "Diagnostics: " + "[" * 100_000),
        ("a.yaml", "!!python/object/apply:os.getcwd []\n"),
    ],
)
@pytest.mark.verifies("SWR-TRC-043", technique="error_guessing", polarity="violation")
def test_a_broken_result_is_one_finding(sample: Sample, trace: Callable, name: str, text: str) -> None:
    status, found = check(sample, trace, name, text)

    assert (status, [(rule, file) for rule, file, _, _ in found]) == (2, [("unreadable-input", f"build/host-release/evidence/static/{name}")])
