# SPDX-License-Identifier: Apache-2.0
# Goal: results of other tools get the correct outcome and requirement; malicious files need little memory and do not affect other files.
from __future__ import annotations

import os
import resource
from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Sample, format_gtest_case

from mamori_trace.base.finding import Problem
from mamori_trace.model.evidence import TestResult
from mamori_trace.readers.cpp_tests import parse_cpp_tests
from mamori_trace.readers.junit import parse_junit, read_junit
from mamori_trace.readers.python_sources import read_python

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
JUNIT = "build/host-release/evidence/junit"


def parse(text: str | bytes) -> tuple[list[TestResult], list[Problem]]:
    problems: list[Problem] = []
    data = text if isinstance(text, bytes) else text.encode()
    return parse_junit(data, "a.xml", "unit", Path("."), problems), problems


def wrap(cases: str) -> str:
    return f'{HEAD}<testsuite name="S">\n{cases}</testsuite>\n'


@pytest.mark.parametrize(
    ("case", "status", "message"),
    [
        ('<testcase name="t" classname="t" time="1" status="run"><system-out>ok</system-out></testcase>', "passed", ""),
        ('<testcase name="t" classname="t" time="1" status="fail"><failure message=""/><system-out>log</system-out></testcase>', "failed", ""),
        ('<testcase name="t" classname="t" status="fail"/>', "failed", ""),
        ('<testcase name="t" classname="t" status="notrun"><skipped message="Disabled"/></testcase>', "skipped", "disabled"),
        ('<testcase name="t" classname="t" status="disabled"/>', "skipped", "disabled"),
        ('<testcase name="t" classname="t" status="run" result="skipped"><skipped message="no device"/></testcase>', "skipped", "no device"),
        ('<testcase name="t" classname="t"><rerunFailure message="a"/><failure message="b"/></testcase>', "failed", "b"),
        ('<testcase name="t" classname="t" time="nan" line="\u00b2" file="a.py"/>', "passed", ""),
        ('<testcase name="t" classname="t" line="99999999999999999999" file="' + "a" * 5000 + '"/>', "passed", ""),
    ],
    ids=["ctest-run", "ctest-fail", "ctest-bare-fail", "ctest-notrun", "ctest-disabled", "gtest-skip", "rerun-failed", "numbers", "long"],
)
@pytest.mark.verifies("SWR-TRC-041", technique="equivalence_classes", polarity="nominal")
def test_each_writer_s_outcome_is_read_as_what_it_is(case: str, status: str, message: str) -> None:
    results, problems = parse(wrap(case))

    assert problems == []
    assert [(one.status, one.message, one.flaky) for one in results] == [(status, message, False)]
    assert results[0].time_s >= 0.0


@pytest.mark.parametrize("tag", ["flakyFailure", "flakyError", "rerunFailure", "rerunError"])
@pytest.mark.verifies("SWR-TRC-041", technique="requirements_based", polarity="violation")
def test_a_test_that_passed_at_the_second_try_is_told(sample: Sample, trace: Callable, tag: str) -> None:
    sample.replace(f"{JUNIT}/safety.xml", '<testcase name="SilenceIsReported" status="run" result="completed" time="0.001" classname="AliveTest">\n',
                   '<testcase name="SilenceIsReported" status="run" result="completed" time="0.001" classname="AliveTest">\n'
                   f'<{tag} message="1 != 2">trace</{tag}>\n')  # fmt: skip

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules, outcome.get_verdict("SWR-SUP-001")) == (0, {"result-flaky"}, "verified")


@pytest.mark.verifies("SWR-TRC-041", technique="requirements_based", polarity="violation")
def test_of_repeated_runs_of_one_test_the_worst_counts(sample: Sample, trace: Callable) -> None:
    failed = format_gtest_case("AliveTest", "SilenceIsReported", "SWR-SUP-001", inner='<failure message="in round 2"/>')
    again = format_gtest_case("AliveTest", "SilenceIsReported", "SWR-SUP-001")
    sample.replace(f"{JUNIT}/safety.xml", "  </testsuite>", f"{failed}{again}  </testsuite>")

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules, outcome.get_verdict("SWR-SUP-001")) == (1, {"result-failed"}, "failed")


@pytest.mark.verifies("SWR-TRC-041", technique="requirements_based", polarity="violation")
def test_a_failure_of_the_whole_suite_is_a_failed_result() -> None:
    results, _ = parse(wrap('<failure message="no device"/><testcase name="t" classname="S"/>'))

    assert [(one.title, one.status, one.message) for one in results] == [("S.(whole suite)", "failed", "no device"), ("S.t", "passed", "")]


@pytest.mark.verifies("SWR-TRC-040", technique="interface", polarity="nominal")
def test_properties_of_other_tools_name_requirements() -> None:
    rows = ('<property name="FullyVerifies" value="SWR-ABC-001, SWR-ABC-002"/><property name="PartiallyVerifies" value="SWR-ABC-003"/>'
            '<property name="Verifies" value="SWR-ABC-001"/><property name="lobster-tracing" value="SWR-ABC-004"/>')  # fmt: skip

    results, _ = parse(wrap(f'<testcase name="t" classname="S"><properties>{rows}</properties><failure message="f"/></testcase>'))

    assert [(one.requirement, one.status) for one in results] == [(f"SWR-ABC-00{number}", "failed") for number in (1, 2, 3, 4)]


CPP = """// @relation(SWR-ABC-009, scope=file, role=Verifies)
#include <gtest/gtest.h>

/// Watching.
/// @verifies SWR-ABC-001, SWR-ABC-002
TEST(WatchTest, Works) {
    EXPECT_TRUE(true);  // [utest->SWR-ABC-003]
    const char* text = "@verifies SWR-ABC-999";
}

// @satisfies SWR-ABC-999
TEST_F(LateTest, Works) {
    /* lobster-trace: SWR-ABC-004 */
}
"""


@pytest.mark.verifies("SWR-TRC-040", technique="requirements_based", polarity="nominal")
def test_comments_of_cpp_tests_name_requirements() -> None:
    tests = parse_cpp_tests(CPP, "watch_test.cpp")

    assert [(one.requirement, one.title, one.place.line) for one in tests] == [
        ("SWR-ABC-009", "watch_test.cpp", 1),
        ("SWR-ABC-001", "WatchTest.Works", 5),
        ("SWR-ABC-002", "WatchTest.Works", 5),
        ("SWR-ABC-003", "WatchTest.Works", 7),
        ("SWR-ABC-004", "LateTest.Works", 13),
    ]


@pytest.mark.verifies("SWR-TRC-040", technique="requirements_based", polarity="nominal")
def test_docstrings_and_comments_of_python_tests_name_requirements(tmp_path: Path) -> None:
    (tmp_path / "test_a.py").write_text(
        '# @verifies SWR-ABC-001\n@wrapped\ndef test_one():\n    """Works.\n\n    @relation(SWR-ABC-002, scope=function)\n    """\n\n\n'
        'class TestGroup:\n    def test_two(self):\n        """[itest->SWR-ABC-003]"""\n        text = "@verifies SWR-ABC-999"\n'
    )

    _, tests = read_python(tmp_path, [])

    assert [(one.requirement, one.title, one.place.line) for one in tests] == [
        ("SWR-ABC-001", "test_a.test_one", 1),
        ("SWR-ABC-002", "test_a.test_one", 6),
        ("SWR-ABC-003", "test_a.TestGroup.test_two", 12),
    ]


@pytest.mark.parametrize(("outcome", "rules", "verdict"), [("", set(), "verified"), ('<failure message="f"/>', {"result-failed"}, "failed")])
@pytest.mark.verifies("SWR-TRC-040", technique="state_transition", polarity="nominal")
def test_a_result_finds_the_requirement_that_a_comment_names(
    sample: Sample, trace: Callable, outcome: str, rules: set[str], verdict: str
) -> None:
    sample.replace("safety/tests/alive_test.cpp", 'TEST_P(LateTest, LatenessIsReported) {\n    verifies("SWR-SUP-002");\n',
                   "// @verifies SWR-SUP-002\nTEST_P(LateTest, LatenessIsReported) {\n")  # fmt: skip
    path = sample.root / JUNIT / "safety.xml"
    old = format_gtest_case("Limits/LateTest", "LatenessIsReported/0", "SWR-SUP-002")
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, f'<testcase name="LatenessIsReported/0" classname="Limits/LateTest">{outcome}</testcase>'))

    told = trace("check", "--root", sample.root, "--output", "json")

    assert (told.rules, told.get_verdict("SWR-SUP-002")) == (rules, verdict)


@pytest.mark.verifies("SWR-TRC-041", technique="fault_injection", polarity="violation")
def test_a_test_that_crashed_before_it_named_its_requirement_fails_it(sample: Sample, trace: Callable) -> None:
    path = sample.root / JUNIT / "safety.xml"
    old = format_gtest_case("AliveTest", "SilenceIsReported", "SWR-SUP-001")
    for inner, rule, verdict in (('<error message="crash"/>', "result-failed", "failed"), ("", "result-missing", "incomplete")):
        new = f'<testcase name="SilenceIsReported" classname="AliveTest">{inner}</testcase>'
        path.write_text(path.read_text().replace(old, new))
        old = new
        outcome = trace("check", "--root", sample.root, "--output", "json")
        assert rule in outcome.rules and outcome.get_verdict("SWR-SUP-001") == verdict


BOMB = "".join(f'<!ENTITY a{number} "{f"&a{number - 1};" * 10 if number else "ha"}">' for number in range(12))
HOSTILE: dict[str, tuple[str | bytes, int, str]] = {
    "bomb": (f"{HEAD}<!DOCTYPE a [{BOMB}]>\n<testsuite>&a11;</testsuite>", 2, "DTD"),
    "bomb-of-values": ('<!DOCTYPE a [<!ENTITY % b "x">]>\n<testsuite/>', 1, "DTD"),
    "cut-tag": (wrap('<testcase name="t')[:-14], 3, "not whole XML"),
    "cut-suite": (f'{HEAD}<testsuites><testsuite name="S"><testcase name="t"/></testsuite>', 2, "not whole XML"),
    "two-roots": (wrap("") * 2, 4, "not whole XML"),
    "zero-bytes": (wrap("<testcase/>").encode() + b"\0\0", 4, "not whole XML"),
    "only-zeros": (b"\0" * 100, 1, "not whole XML"),
    "latin-1": (wrap('<testcase name="t"><failure message="f\xfcr"/></testcase>').encode("latin-1"), 3, "not whole XML"),
    "control": (wrap('<testcase name="t"><failure>\x1b[31m</failure></testcase>'), 3, "not whole XML"),
    "encoding": (b'<?xml version="1.0" encoding="klingon"?>\n<testsuite/>', 1, "not whole XML"),
    "html": ("<html><body/></html>", 1, "no JUnit"),
    "deep": (f"{HEAD}<testsuite>" + "<a>" * 10_000, 2, "nests"),
    "long-tag": (f"{HEAD}<testsuite><testcase name='" + "a" * 40_000_000, 2, "MB"),
}  # fmt: skip


@pytest.mark.parametrize("name", HOSTILE)
@pytest.mark.verifies("SWR-TRC-042", technique="error_guessing", polarity="violation")
def test_a_hostile_file_is_refused_with_one_finding(name: str) -> None:
    text, line, message = HOSTILE[name]

    results, problems = parse(text)

    assert results == []
    assert [(problem.rule, problem.place.line) for problem in problems] == [("unreadable-input", line)], problems
    assert message in problems[0].message


@pytest.mark.verifies("SWR-TRC-042", technique="interface", polarity="nominal")
def test_other_encodings_that_a_file_declares_are_read() -> None:
    text = '<?xml version="1.0" encoding="{0}"?>\n<testsuite><testcase name="f\u00fcr" classname="S"/></testsuite>'
    for encoding in ("iso-8859-1", "utf-16", "windows-1252"):
        results, problems = parse(text.format(encoding).encode(encoding))
        assert (problems, [one.name for one in results]) == ([], ["f\u00fcr"])


@pytest.mark.verifies("SWR-TRC-042", technique="boundary_values", polarity="violation")
def test_a_file_of_100_mb_is_read_in_little_memory_and_its_messages_are_cut(tmp_path: Path) -> None:
    line = "x" * 99 + "\n"
    case = f'<testcase name="t{{0}}" classname="S"><failure>{line * 500}</failure><system-out>{line * 10_000}</system-out></testcase>\n'
    with (tmp_path / "large.xml").open("w") as file:
        file.write(f"{HEAD}<testsuite>\n")
        for number in range(96):
            file.write(case.format(number))
        file.write("</testsuite>\n")
    assert (tmp_path / "large.xml").stat().st_size > 100_000_000
    before_kb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    problems: list[Problem] = []

    results = read_junit(tmp_path, tmp_path, problems)

    assert (problems, len(results)) == ([], 96)
    assert all(one.status == "failed" and len(one.message) <= 2000 for one in results)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before_kb < 30_000


@pytest.mark.verifies("SWR-TRC-042", technique="error_guessing", polarity="violation")
def test_loops_of_links_and_pipes_end(sample: Sample, trace: Callable) -> None:
    root = sample.root
    (root / "safety/loop").symlink_to("..")
    (root / "safety/self.cpp").symlink_to("self.cpp")
    (root / "safety/pipe.hpp").symlink_to("/dev/null")
    os.mkfifo(root / "safety/pipe.py")
    (root / JUNIT / "again").symlink_to("..")
    (root / JUNIT / "self.xml").symlink_to("self.xml")
    (root / JUNIT / "folder.xml").mkdir()
    os.mkfifo(root / JUNIT / "pipe.xml")

    outcome = trace("check", "--root", root, "--output", "json")

    assert outcome.status == 2
    assert [(one["rule"], one["file"]) for one in outcome.content["findings"]] == [
        ("unreadable-input", f"{JUNIT}/folder.xml"),
        ("unreadable-input", f"{JUNIT}/pipe.xml"),
        ("unreadable-input", f"{JUNIT}/self.xml"),
        ("unreadable-input", "safety/pipe.hpp"),
        ("unreadable-input", "safety/pipe.py"),
        ("unreadable-input", "safety/self.cpp"),
    ]
    assert outcome.get_verdict("SWR-SUP-001") == "verified"


@pytest.mark.parametrize("file", ["safety/zero.cpp", "tools/zero.py", "safety/tests/zero_test.cpp", "tools/tests/test_zero.py", "cmake/zero.cmake"])
@pytest.mark.verifies("SWR-TRC-042", technique="error_guessing", polarity="violation")
def test_zero_bytes_in_sources_are_no_crash(sample: Sample, trace: Callable, file: str) -> None:
    (sample.root / file).parent.mkdir(exist_ok=True)
    (sample.root / file).write_bytes(b"# @satisfies SWR-SUP-001\n\0// @verifies SWR-SUP-001\n")

    assert trace("check", "--root", sample.root).status in (0, 1, 2)
