# SPDX-License-Identifier: Apache-2.0
# Goal: each test of `ctest -N` has a result of this run, for every kind of test, name and end; missing results fail the step.
# Method: one small project with every kind of test, built once and run by the step of `mamori verify PROJECT`.
from __future__ import annotations

import hashlib
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from mamori_tools.host import gtest_program, project_run
from mamori_tools.host.project import Project
from mamori_tools.host.records import _make_rows
from mamori_tools.host.steps import Context
from mamori_trace.base.errors import WorkError

ODD_NAME = 'w/x "q" ]=] é ' + "n" * 300


SOURCE = """
#include <gtest/gtest.h>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <unistd.h>
TEST(Arm, Holds) { std::this_thread::sleep_for(std::chrono::milliseconds(20)); }
TEST(Arm, Stops) {}
TEST(Arm, DISABLED_Dances) {}
TEST(Arm, LeavesEarly) {
    if (std::getenv("LEAVES") != nullptr) { _exit(0); }
    if (std::getenv("CRASHES") != nullptr) { std::raise(SIGSEGV); }
    if (std::getenv("FAILS") != nullptr) { FAIL(); }
    if (std::getenv("SKIPS") != nullptr) { GTEST_SKIP(); }
}
struct AtEnd {  // the result file is complete by then
    ~AtEnd() {
        if (std::getenv("DIES_AT_END") != nullptr) { _exit(9); }
        if (std::getenv("TEARS") != nullptr) {
            const int unused = std::system("for f in $(printf %s ${GTEST_OUTPUT#xml:})*.xml; do head -c 200 $f >t.part; cp t.part $f; done");
            static_cast<void>(unused);
            if (std::getenv("AND_CRASHES") != nullptr) { std::abort(); }
        }
    }
} at_end;
"""

ALL = (*(("Arm", name) for name in ("Holds", "Stops", "DISABLED_Dances", "LeavesEarly")),)


def with_environment(name: str, text: str, *words: str) -> str:
    command = " ".join(["arm_test", *words])
    return f"add_test(NAME {name} COMMAND {command})\nset_tests_properties({name} PROPERTIES ENVIRONMENT {text})\n"


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The compiled test program."""
    folder = tmp_path_factory.mktemp("built")
    (folder / "arm_test.cpp").write_text(SOURCE)
    subprocess.run(["g++", "-O0", "-std=c++17", "arm_test.cpp", "-o", "arm_test", "-lgtest", "-lgtest_main", "-pthread"],
                   cwd=folder, check=True, timeout=300)  # fmt: skip
    return folder / "arm_test"


class Sample:
    """A project of ready-made test programs."""

    def __init__(self, root: Path, built: Path) -> None:
        self.project = Project(root)
        self.built = built
        self.failure = ""
        self.log = ""

    def run(self, cmake: str, jobs: int = 4) -> dict[str, list[tuple[str, str]]]:
        """@return the outcome of each case, by result file."""
        project = self.project
        (project.root / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.22)\nproject(sample NONE)\nenable_testing()\n"
            f"add_executable(arm_test IMPORTED)\nset_target_properties(arm_test PROPERTIES IMPORTED_LOCATION {self.built})\n{cmake}"
        )
        subprocess.run(["cmake", "-S", str(project.root), "-B", str(project.build), "-G", "Ninja"], check=True, capture_output=True)
        project.junit.mkdir(parents=True, exist_ok=True)
        project.logs.mkdir(parents=True, exist_ok=True)
        path = project.logs / "tests.log"
        with path.open("w") as log:
            try:
                project_run.run_project_tests(Context(project, jobs), lambda _: None, log)
                self.failure = ""
            except WorkError as error:
                self.failure = str(error)
        self.log = path.read_text()
        return self.read()

    def read(self) -> dict[str, list[tuple[str, str]]]:
        found = {}
        for path in sorted(self.project.junit.glob("*.xml")):
            cases = ElementTree.parse(path).iter("testcase")
            found[path.name] = [(f"{case.get('classname')}.{case.get('name')}", judge(case)) for case in cases]
        return found


def judge(case: ElementTree.Element) -> str:
    if case.find("failure") is not None:
        return "failed"
    return "skipped" if case.find("skipped") is not None or case.get("status") == "notrun" else "passed"


@pytest.fixture
def sample(tmp_path: Path, built: Path) -> Sample:
    return Sample(tmp_path, built)


@pytest.mark.verifies("SWR-CLI-032", technique="fault_injection")
def test_processes_of_one_program_in_parallel_keep_all_their_results(sample: Sample) -> None:
    tests = "".join(f"add_test(NAME arm.{number} COMMAND arm_test)\n" for number in range(63))

    found = sample.run(tests, jobs=32)

    assert sample.failure == ""
    assert len(found) == 63
    assert all(len(cases) == len(ALL) for cases in found.values())


@pytest.mark.verifies("SWR-CLI-032", technique="equivalence_classes")
def test_every_kind_of_test_has_its_result(sample: Sample) -> None:
    cmake = (
        f"add_test(NAME [==[{ODD_NAME}]==] COMMAND arm_test)\n"
        "add_test(NAME one.case COMMAND arm_test --gtest_filter=Arm.Holds)\n"
        "add_test(NAME script COMMAND sh -c true)\n"
        "add_test(NAME off COMMAND arm_test)\nset_tests_properties(off PROPERTIES DISABLED ON)\n"
        "add_test(NAME left.out COMMAND sh -c \"exit 77\")\nset_tests_properties(left.out PROPERTIES SKIP_RETURN_CODE 77)\n"
        "add_test(NAME alone COMMAND arm_test)\nset_tests_properties(alone PROPERTIES RUN_SERIAL ON)\n"
        "add_test(NAME refuses COMMAND sh -c false)\nset_tests_properties(refuses PROPERTIES WILL_FAIL ON)\n"
        + with_environment("must.fail", "FAILS=1") + "set_tests_properties(must.fail PROPERTIES WILL_FAIL ON)\n"
        + with_environment("skips", "SKIPS=1", "--gtest_filter=Arm.LeavesEarly")
    )  # fmt: skip

    found = [cases for _, cases in sorted(sample.run(cmake).items())]

    assert sample.failure == ""
    every = [("Arm.Holds", "passed"), ("Arm.Stops", "passed"), ("Arm.DISABLED_Dances", "skipped"), ("Arm.LeavesEarly", "passed")]
    assert found == [
        every, [("Arm.Holds", "passed")], [("script.script", "passed")], [("off.off", "skipped")],
        [("left.out.left.out", "skipped")], every, [("refuses.refuses", "passed")], [("must.fail.must.fail", "passed")],
        [("Arm.LeavesEarly", "skipped")],
    ]  # fmt: skip


@pytest.mark.verifies("SWR-CLI-032", technique="equivalence_classes")
def test_a_project_that_sets_the_output_itself_keeps_its_results(sample: Sample) -> None:
    cmake = (
        with_environment("by.environment", "GTEST_OUTPUT=xml:mine.xml")
        + "add_test(NAME by.change COMMAND arm_test)\n"
        "set_tests_properties(by.change PROPERTIES ENVIRONMENT_MODIFICATION \"A=set:b;GTEST_OUTPUT=set:json:mine.json\")\n"
        "add_test(NAME by.word COMMAND arm_test --gtest_output=xml:word.xml)\n"
        "add_test(NAME twin COMMAND arm_test)\nfile(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/sub)\nadd_subdirectory(sub)\n"
    )  # fmt: skip
    (sample.project.root / "sub").mkdir()
    (sample.project.root / "sub" / "CMakeLists.txt").write_text("add_test(NAME twin COMMAND arm_test)\n")

    found = sample.run(cmake)

    assert sample.failure == ""
    assert [len(cases) for cases in found.values()] == [len(ALL)] * 5


@pytest.mark.verifies("SWR-CLI-032", technique="fault_injection", polarity="violation")
def test_a_process_without_a_result_file_has_one_failed_result(sample: Sample) -> None:
    cmake = (
        with_environment("crash", "CRASHES=1") + with_environment("torn", '"TEARS=1;AND_CRASHES=1"')
        + with_environment("slow", "X=1") + "add_test(NAME hang COMMAND sleep 60)\nset_tests_properties(hang PROPERTIES TIMEOUT 1)\n"
        "add_test(NAME no.program COMMAND /no/such/program)\n"
        "add_test(NAME no.fixture COMMAND arm_test)\nset_tests_properties(no.fixture PROPERTIES FIXTURES_REQUIRED F)\n"
        "add_test(NAME fixture COMMAND sh -c false)\nset_tests_properties(fixture PROPERTIES FIXTURES_SETUP F)\n"
    )  # fmt: skip

    found = sample.run(cmake)

    outcomes = {cases[0][0]: [verdict for _, verdict in cases] for cases in found.values()}
    assert sample.failure == ""  # the failed results report it
    assert outcomes == {
        "crash.crash": ["failed"], "torn.torn": ["failed"], "Arm.Holds": ["passed", "passed", "skipped", "passed"],
        "hang.hang": ["failed"], "no.program.no.program": ["failed"], "no.fixture.no.fixture": ["failed"],
        "fixture.fixture": ["failed"],
    }  # fmt: skip


@pytest.mark.verifies("SWR-CLI-032", technique="fault_injection", polarity="violation")
def test_a_process_that_fails_after_its_result_file_has_a_failed_result_too(sample: Sample) -> None:
    found = sample.run(with_environment("late", "DIES_AT_END=1"))

    verdicts = [verdict for cases in found.values() for _, verdict in cases]
    assert sorted(verdicts) == ["failed", "passed", "passed", "passed", "skipped"]


@pytest.mark.verifies("SWR-CLI-033", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("cmake", "message"),
    [(with_environment("leaves", "LEAVES=1"), "test 'leaves' passed with 0 of 4 cases (no result: Arm.Holds"),
     (with_environment("torn", "TEARS=1"), "test 'torn' passed, and its result file arm_test.xml is malformed"),
     ("add_test(NAME own COMMAND arm_test --gtest_output=json:o.json)\n", "remove --gtest_output from its command"),
     ("".join(f"add_test(NAME own.{n} COMMAND arm_test --gtest_output=xml:o.xml)\n" for n in range(2)), "give it a file of its own"),
     ("", "ctest finds no test")],
    ids=["leaves-early", "torn", "json", "same-file", "no-test"],
)  # fmt: skip
def test_a_passed_test_without_its_cases_is_missing(sample: Sample, cmake: str, message: str) -> None:
    sample.run(cmake)

    assert message in sample.failure
    assert sample.failure.startswith("result-missing: ") or not cmake


@pytest.mark.verifies("SWR-CLI-033", technique="boundary_values", polarity="violation")
def test_one_case_less_than_listed_is_missing(sample: Sample, monkeypatch: pytest.MonkeyPatch) -> None:
    one_more = lambda *_: [*ALL, ("Arm", "Added")]  # noqa: E731
    monkeypatch.setattr(gtest_program, "list_cases", one_more)

    sample.run("add_test(NAME arm COMMAND arm_test)\n")

    assert "passed with 4 of 5 cases (no result: Arm.Added)" in sample.failure


@pytest.mark.verifies("SWR-CLI-032", technique="error_guessing")
def test_a_filter_of_the_callers_shell_leaves_no_case_out(sample: Sample, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GTEST_FILTER", "Arm.Holds")

    found = sample.run("add_test(NAME arm COMMAND arm_test)\n")

    assert [len(cases) for cases in found.values()] == [len(ALL)]


@pytest.mark.verifies("SWR-TRC-036", technique="interface")
def test_the_record_of_a_result_names_the_hash_of_its_program(sample: Sample) -> None:
    found = sample.run("add_test(NAME arm COMMAND arm_test)\n")

    rows = _make_rows(sample.project, [sample.project.junit / name for name in found], {})

    assert [row["binary"] for row in rows.values()] == [calc_hash(sample.built)]


def calc_hash(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.mark.verifies("SWR-CLI-032", technique="equivalence_classes")
def test_the_environment_of_a_listing_is_that_of_the_test() -> None:
    changes = ["A=set:1", "B=unset:", "C=reset:", "P=path_list_prepend:/x", "Q=path_list_append:/y", "S=string_append:z", "L=cmake_list_append:m"]

    made = gtest_program.modify({"B": "b", "C": "c", "P": "/p"}, ["C=changed", "S=s", "L=k"], changes)

    assert made == {"A": "1", "C": "c", "P": "/x:/p", "Q": "/y", "S": "sz", "L": "k;m"}
