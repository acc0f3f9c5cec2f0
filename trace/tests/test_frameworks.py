# SPDX-License-Identifier: Apache-2.0
# Goal: for each framework, a tag is bound to the test below it under its name in the results, never to the test above.
# Method: installed frameworks are run; in addition, stored results of every framework are read.
from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from framework_samples import FRAMEWORKS, Framework
from trace_sample import SCHEMA, Sample, format_item

from mamori_trace.base.finding import Problem
from mamori_trace.readers.cpp_plain import find_dead_lines
from mamori_trace.readers.cpp_tests import parse_cpp_tests

ITEMS = ("SWR-FW-001", "SWR-FW-002", "SWR-FW-003")
TIMEOUT_S = 300


def make_project(root: Path, framework: Framework) -> Sample:
    """Three requirements, and one file with tests of the framework."""
    sample = Sample(root)
    (root / "requirements/schema").mkdir(parents=True)
    shutil.copy(SCHEMA, root / "requirements/schema")
    text = "".join(format_item(item, "T", "The arm shall stop.", Parents="STK-001", SIL="QM") for item in ITEMS)
    (root / "requirements/items.md").write_text("# Items\n\n" + format_item("STK-001", "N", "People need it.", SIL="QM", Verify="review") + text)
    file = root / framework.file
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(framework.source)
    (sample.evidence / "junit").mkdir(parents=True)
    return sample


def demand_bound(sample: Sample, trace: Callable) -> None:
    """The first tag has only passed results, the second a failed one; the third is in dead code."""
    content = trace("check", "--root", sample.root, "--output", "json").content
    statuses = {row["id"]: {one["status"] for one in row["results"]} for row in content["items"]}
    assert statuses["SWR-FW-001"] == {"passed"}, content["findings"]
    assert "failed" in statuses["SWR-FW-002"] or "error" in statuses["SWR-FW-002"], content["findings"]
    assert statuses["SWR-FW-003"] == set()
    assert not [one for one in content["findings"] if one["rule"] == "result-missing"]


@pytest.mark.parametrize("name", FRAMEWORKS)
@pytest.mark.verifies("SWR-TRC-104", technique="interface", polarity="nominal")
def test_results_of_a_framework_bind_to_the_tag_above_their_test(name: str, trace: Callable, tmp_path: Path) -> None:
    sample = make_project(tmp_path, FRAMEWORKS[name])
    (sample.evidence / "junit/results.xml").write_text(FRAMEWORKS[name].result)

    demand_bound(sample, trace)


@pytest.mark.parametrize("name", [name for name, each in FRAMEWORKS.items() if each.real])
def test_the_real_framework_writes_such_results(name: str, trace: Callable, tmp_path: Path) -> None:
    framework = FRAMEWORKS[name]
    for need in framework.needs:
        if not (Path("/usr/include") / need).exists() and shutil.which(need) is None:
            pytest.skip(f"{need} is not installed")
    sample = make_project(tmp_path, framework)

    command = [sys.executable if word == "{python}" else word for word in framework.command]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)

    assert (tmp_path / "results.xml").is_file(), done.stderr
    (tmp_path / "results.xml").rename(sample.evidence / "junit/results.xml")
    demand_bound(sample, trace)


@pytest.mark.parametrize("name", [name for name, each in FRAMEWORKS.items() if each.file.endswith((".cpp", ".c"))])
@pytest.mark.verifies("SWR-TRC-104", technique="fault_injection", polarity="violation")
def test_a_tagged_test_that_did_not_run_is_missing(name: str, trace: Callable, tmp_path: Path) -> None:
    """The adjacent tests above and below ran."""
    framework = FRAMEWORKS[name]
    sample = make_project(tmp_path, framework)
    kept = [part for part in framework.result.split("<testcase ") if not any(word in part.lower() for word in ("stops", "hold"))]
    end = "" if "</testsuite>" in kept[-1] else "</testsuite></testsuites>"
    (sample.evidence / "junit/results.xml").write_text("<testcase ".join(kept) + end)

    outcome = trace("check", "--root", sample.root, "--output", "json")

    missing = [one["item"] for one in outcome.content["findings"] if one["rule"] == "result-missing"]
    assert outcome.status == 1 and sorted(missing) == ["SWR-FW-001", "SWR-FW-002"]
    assert "verified" not in (outcome.get_verdict("SWR-FW-001"), outcome.get_verdict("SWR-FW-002"))


@pytest.mark.parametrize("macro", ["BOOST_AUTO_TEST_CASE(next)", 'TEST_CASE("next")', "ZTEST(arm, next)", "OWN_TEST(next)"])
@pytest.mark.verifies("SWR-TRC-104", technique="fault_injection", polarity="violation")
def test_a_failed_test_is_not_hidden_by_the_googletest_above(macro: str, trace: Callable, tmp_path: Path) -> None:
    source = f"// @verifies SWR-FW-001\nTEST(Arm, First) {{}}\n// @verifies SWR-FW-001\n{macro} {{}}\n"
    sample = make_project(tmp_path, Framework("arm_test.cpp", source, ""))
    suite = {"B": "", "T": "t.global", "Z": "arm", "O": "p"}[macro[0]]
    (sample.evidence / "junit/results.xml").write_text(
        f'<testsuite><testcase classname="Arm" name="First"/><testcase classname="{suite}" name="next"><failure/></testcase></testsuite>'
    )

    assert trace("check", "--root", sample.root, "--output", "json").get_verdict("SWR-FW-001") == "failed"


@pytest.mark.verifies("SWR-TRC-104", technique="error_guessing", polarity="violation")
def test_a_tag_that_is_above_no_test_is_missing_though_another_test_passed(trace: Callable, tmp_path: Path) -> None:
    source = "// @verifies SWR-FW-001\nTEST(Arm, First) {}\n// @verifies SWR-FW-001\nstatic int helper() { return 1; }\n"
    sample = make_project(tmp_path, Framework("arm_test.cpp", source, ""))
    (sample.evidence / "junit/results.xml").write_text('<testsuite><testcase classname="Arm" name="First"/></testsuite>')

    outcome = trace("check", "--root", sample.root, "--output", "json")

    found = [(one["line"], one["item"]) for one in outcome.content["findings"] if one["rule"] == "result-missing"]
    assert (outcome.status, found, outcome.get_verdict("SWR-FW-001")) == (1, [(3, "SWR-FW-001")], "incomplete")


@pytest.mark.verifies("SWR-TRC-104", technique="error_guessing", polarity="violation")
def test_two_tests_of_one_name_do_not_stand_for_each_other(trace: Callable, tmp_path: Path) -> None:
    sample = make_project(tmp_path, Framework("one/test_arm.py", "# @verifies SWR-FW-001\ndef test_stops():\n    pass\n", ""))
    (tmp_path / "two").mkdir()
    (tmp_path / "two/test_arm.py").write_text("# @verifies SWR-FW-002\ndef test_stops():\n    pass\n")
    (sample.evidence / "junit/results.xml").write_text('<testsuite><testcase classname="two.test_arm" name="test_stops"/></testsuite>')

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert [one["item"] for one in outcome.content["findings"] if one["rule"] == "result-missing"] == ["SWR-FW-001"]


@pytest.mark.verifies("SWR-TRC-104", technique="fault_injection", polarity="violation")
def test_the_failure_of_a_whole_suite_is_that_of_each_of_its_tests(sample: Sample, trace: Callable) -> None:
    path = sample.evidence / "junit/safety.xml"
    path.write_text(path.read_text().replace("  </testsuite>", '<testcase name="" classname=""><failure message="SetUp"/></testcase></testsuite>'))

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert {outcome.get_verdict(item) for item in ("SWR-SUP-001", "SWR-SUP-002")} == {"failed"}
    assert outcome.get_verdict("SWR-TLS-001") == "verified"


@pytest.mark.verifies("SWR-TRC-104", technique="fault_injection", polarity="violation")
def test_a_failed_test_that_names_two_items_fails_both(trace: Callable, tmp_path: Path) -> None:
    """GoogleTest stores only the last property of a name."""
    source = 'TEST(Arm, Both) {\n  verifies("SWR-FW-001");\n  verifies("SWR-FW-002");\n}\nTEST(Arm, Good) { verifies("SWR-FW-001"); }\n'
    sample = make_project(tmp_path, Framework("arm_test.cpp", source, ""))
    prop = '<properties><property name="requirement" value="{}"/></properties>'
    (sample.evidence / "junit/results.xml").write_text(
        f'<testsuite><testcase classname="Arm" name="Both"><failure/>{prop.format("SWR-FW-002")}</testcase>'
        f'<testcase classname="Arm" name="Good">{prop.format("SWR-FW-001")}</testcase></testsuite>'
    )

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert [outcome.get_verdict(item) for item in ("SWR-FW-001", "SWR-FW-002")] == ["failed", "failed"]


CONDITIONS = [
    ("#if 0\nX\n#endif", {2}), ("#if 1\nY\n#else\nX\n#endif", {4}), ("#if 0\nX\n#elif FOO\nY\n#else\nZ\n#endif", {2}),
    ("#if 0\n#if 1\nX\n#endif\nX\n#endif\nY", {2, 3, 4, 5}), ("#if 1\nY\n#elif FOO\nX\n#else\nX\n#endif", {4, 6}),
    ("#if FOO\nY\n#elif 0\nX\n#else\nY\n#endif", {4}), ("#ifdef FOO\nY\n#else\nY\n#endif", set()), ("#if 0 && FOO\nX\n#endif", {2}),
    ("#if (FOO || 1)\nY\n#else\nX\n#endif", {4}), ("#if !1\nX\n#endif", {2}), ("#if defined(FOO)\nY\n#endif", set()), ("#if false\nX\n#endif", {2}),
    ("// #if 0\nY\n// #endif", set()), ("#if 0\nX", {2}), ("/*\n#if 0\n*/\nY\n/*\n#endif\n*/", set()), ("#endif\nY\n#else\nY", set()),
    ("#if " + "(" * 5000 + "0\nY\n#endif", set()), ("#if " + "!" * 5000 + "0\nY\n#endif", set()),
]  # fmt: skip


@pytest.mark.parametrize(("text", "dead"), CONDITIONS, ids=range(len(CONDITIONS)))
@pytest.mark.verifies("SWR-TRC-105", technique="equivalence_classes", polarity="violation")
def test_dead_branches_are_known(text: str, dead: set[int]) -> None:
    lines = text.splitlines()
    found = {number for number in find_dead_lines(text) if not lines[number - 1].startswith("#")}
    assert found == {number for number in dead if not lines[number - 1].startswith("#")}


@pytest.mark.verifies("SWR-TRC-105", technique="requirements_based", polarity="nominal")
def test_tags_and_calls_of_live_branches_count() -> None:
    text = '#if FOO\n// @verifies SWR-FW-001\nTEST(A, B) {}\n#else\nTEST(A, C) { verifies("SWR-FW-002"); }\n#endif\n'
    text += '#if 0\nTEST(A, D) { verifies("SWR-FW-003"); }\n#endif\n'
    found = [(test.requirement, test.name) for test in parse_cpp_tests(text, "a_test.cpp")]
    assert sorted(found) == [("SWR-FW-001", "B"), ("SWR-FW-002", "C")]


@pytest.mark.verifies("SWR-TRC-105", technique="fault_injection", polarity="violation")
def test_code_tags_in_dead_branches_do_not_count(sample: Sample, trace: Callable) -> None:
    sample.replace("safety/include/alive.hpp", "/// @satisfies SWR-SUP-002\n", "#if 0\n/// @satisfies SWR-SUP-002\n#endif\n")

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.rules, outcome.get_verdict("SWR-SUP-002")) == ({"code-missing"}, "incomplete")
    assert not [one for one in parse_cpp_tests('R"(\nverifies("SWR-X-1");\n)";', "a_test.cpp") if isinstance(one, Problem)]
