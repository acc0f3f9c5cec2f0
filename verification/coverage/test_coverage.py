# SPDX-License-Identifier: Apache-2.0
# Goal: the tests of kernel, safety and ports cover every condition, or the list states why not; unlisted gaps are found.
# Method: one measurement of the shipped layers; small programs with a seeded gap, compiled and run like their tests.
from __future__ import annotations

import json
import os
import re
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from mamori_tools.host.project import ROOT, SANITIZED, Project
from mamori_trace.base.errors import WorkError
from verification.coverage.__main__ import check_layers, describe
from verification.coverage.gaps import Gap, Row, Verdict, find_gaps, judge, read_list
from verification.coverage.measure import LAYERS, export, has_counters, measure_layer, run
from verification.coverage.reached import read_functions
from verification.coverage.report import count, make_table

PROGRAM = """\
#include <sys/wait.h>
#include <unistd.h>
#define CHECK(number, condition) ((condition) ? static_cast<void>(0) : __builtin_trap())
template <typename T> bool are_both(T a, T b) { return a > 0 && b > 0; }
bool is_small(int a) { return a < 10 ? true : false; }
void demand(int a, int b) { CHECK(1, a < 2 && b < 2); }
int forgotten() { return 1; }
void demand_in_child(int a, int b) {
    const int child = fork();
    if (child == 0) { demand(a, b); _exit(0); }
    int status = 0;
    waitpid(child, &status, 0);
}
int main() {
    @CALLS@
}
"""
ALL_CALLS = ("are_both<int>(1, 1); are_both<int>(0, 1); are_both<long>(1, 1); are_both<long>(1, 0);",
             "is_small(1); is_small(10);", "demand(1, 1); demand_in_child(2, 1); demand_in_child(1, 2);", "forgotten();")  # fmt: skip
COMPILER = "clang++-19"
FLAGS = ("-fprofile-instr-generate=/dev/null", "-fprofile-update=atomic", "-fcoverage-mapping", "-fcoverage-mcdc")
FLUSH = Path(__file__).with_name("flush_on_death.cpp")
GUARD = Path(__file__).with_name("refuse_unmeasured.sh")
WRAPPED = "-Wl,--wrap=_exit,--wrap=_Exit,--wrap=raise"
FUNCTION_BODY = re.compile(r"\)[\w\s]*\{")
FORGOTTEN = "are_both<int>", "is_small(10)", "demand_in_child(1, 2)", "forgotten()"


def run_and_export(program: Path, profiles: Path, source: Path) -> dict[str, Any]:
    run((str(program),), LLVM_PROFILE_FILE=f"{profiles}/{program.name}-%m.profraw")
    return export((program,), profiles, (source,))


@pytest.fixture(scope="module")
def measured() -> tuple[Verdict, str]:
    """The measurement of the shipped layers."""
    return check_layers(Project(ROOT), os.cpu_count() or 1)


@pytest.fixture
def find_seeded(tmp_path: Path) -> Callable[[str], list[Gap]]:
    """Builds and runs PROGRAM with the given calls. @return its gaps, without those of main and its helper."""

    def find(calls: str) -> list[Gap]:
        source, flush, program = tmp_path / "seeded.cpp", tmp_path / "flush.o", tmp_path / "seeded"
        source.write_text(PROGRAM.replace("@CALLS@", calls), encoding="utf-8")
        run((COMPILER, "-c", str(FLUSH), "-o", str(flush)))
        run((COMPILER, *FLAGS, "-std=c++17", str(source), str(flush), WRAPPED, "-o", str(program)))
        functions = read_functions(run_and_export(program, tmp_path / "profiles", source), tmp_path)
        return [gap for gap in find_gaps(functions) if gap.function not in ("main", "demand_in_child")]

    return find


@pytest.mark.verifies("SWR-VER-001")
def test_every_condition_is_shown_or_listed(measured: tuple[Verdict, str]) -> None:
    verdict, table = measured
    print(table)

    assert [str(gap) for gap in verdict.unlisted] == []


@pytest.mark.verifies("SWR-VER-001")
def test_evidence_holds_each_file_of_each_layer(measured: tuple[Verdict, str]) -> None:
    evidence = json.loads((Project(ROOT).evidence / "coverage" / "coverage.json").read_text(encoding="utf-8"))

    sources = [path for layer in LAYERS for path in (ROOT / layer / "src").rglob("*.cpp")]
    with_functions = {path.relative_to(ROOT).as_posix() for path in sources if FUNCTION_BODY.search(path.read_text(encoding="utf-8"))}
    with_functions.discard("ports/lcm/src/no_lcm_link.cpp")  # compiled only without liblcm
    assert len(with_functions) > 40
    assert with_functions <= {file["file"] for file in evidence["files"]}
    assert evidence["total"]["conditions"] > 100
    assert all(gap["reason"] for gap in evidence["gaps"])


@pytest.mark.verifies("SWR-VER-002")
def test_every_row_of_the_list_names_a_gap(measured: tuple[Verdict, str]) -> None:
    assert [str(row) for row in measured[0].unused] == []


@pytest.mark.verifies("SWR-VER-001")
def test_what_is_shown_in_one_instantiation_or_in_a_dying_child_counts(find_seeded: Callable[[str], list[Gap]]) -> None:
    assert find_seeded(" ".join(ALL_CALLS)) == []


SEEDED = {
    "condition of a template": (0, "are_both<int>(1, 1); are_both<int>(0, 1);", "are_both", "b > 0", "own effect on the decision"),
    "outcome of a lone condition": (1, "is_small(1);", "is_small", "a < 10", "false"),
    "condition of a check": (2, "demand(1, 1); demand_in_child(2, 1);", "demand",
                             "condition 2 of CHECK(1, a < 2 && b < 2)", "own effect on the decision"),
    "function": (3, "", "forgotten", "", "never called"),
}  # fmt: skip


@pytest.mark.parametrize("name", SEEDED)
@pytest.mark.verifies("SWR-VER-001", technique="fault_injection", polarity="violation")
def test_seeded_gap_is_found_with_its_place(find_seeded: Callable[[str], list[Gap]], name: str) -> None:
    place, call, function, condition, missing = SEEDED[name]
    calls = [*ALL_CALLS[:place], call, *ALL_CALLS[place + 1 :]]

    (gap,) = find_seeded(" ".join(calls))

    line = next(number for number, text in enumerate(PROGRAM.splitlines(), start=1) if f" {function}(" in text)
    assert gap == Gap("seeded.cpp", line, function, condition, missing)
    (message,) = describe(judge([gap], []))
    assert message.startswith(f"seeded.cpp:{line}: {function}: ")
    assert condition in message


@pytest.mark.verifies("SWR-VER-001", technique="error_guessing", polarity="violation")
def test_failing_test_program_is_no_measurement(tmp_path: Path) -> None:
    program = tmp_path / "failing"
    program.write_text("#!/bin/sh\necho 1 test failed\nexit 1\n", encoding="utf-8")
    program.chmod(0o755)
    (tmp_path / "kernel").mkdir()
    (tmp_path / "kernel" / "CTestTestfile.cmake").write_text(f"add_test(failing {program})\n", encoding="utf-8")

    with pytest.raises(WorkError, match=r"(?s)ended with status 8:.*1 test failed"):
        measure_layer(ROOT, "kernel", tmp_path, 1)


@pytest.mark.verifies("SWR-VER-001", technique="boundary_values")
def test_counters_of_an_earlier_build_do_not_count(tmp_path: Path) -> None:
    program, counters = tmp_path / "kernel_test", tmp_path / "kernel_test-1_0.profraw"
    for path in (program, counters):
        path.touch()
    os.utime(program, (1000, 1000))

    for age, expected in ((1000, False), (1001, True)):
        os.utime(counters, (age, age))
        assert has_counters(tmp_path, "kernel_test", program) is expected
    assert not has_counters(tmp_path, "kernel_payload_test", program)


@pytest.mark.verifies("SWR-VER-001", technique="interface")
def test_table_counts_each_place_once(tmp_path: Path) -> None:
    source, program = tmp_path / "seeded.cpp", tmp_path / "seeded"
    source.write_text(PROGRAM.replace("@CALLS@", ALL_CALLS[0] + ALL_CALLS[1]), encoding="utf-8")
    run((COMPILER, *FLAGS, "-std=c++17", str(source), "-o", str(program)))
    exported = run_and_export(program, tmp_path / "profiles", source)
    functions = read_functions(exported, tmp_path)
    verdict = judge(find_gaps(functions), [])

    (figures,) = count(exported, functions, tmp_path)
    assert (figures.functions, figures.functions_reached) == (6, 3)
    assert (figures.conditions, figures.conditions_shown) == (6, 3)
    assert "3/6  50.0 %" in make_table([figures], verdict)


ROW = Row("a.cpp", "f", "a > 0", "Needs 2^32 calls.")


@pytest.mark.verifies("SWR-VER-002", technique="fault_injection", polarity="violation")
def test_row_without_a_gap_fails() -> None:
    verdict = judge([], [ROW])

    assert not verdict.passed
    assert describe(verdict) == ["verification/coverage/gaps.toml: row names no gap any more, remove it: a.cpp: f: a > 0"]
    assert judge([], [replace(ROW, by_chance=True)]).passed


@pytest.mark.verifies("SWR-VER-002", technique="equivalence_classes")
def test_row_accepts_its_gap_wherever_it_stands() -> None:
    gaps = [Gap("a.cpp", line, "f", "a > 0", "true") for line in (3, 30)]

    assert judge(gaps, [ROW]).passed
    assert not judge([*gaps, Gap("a.cpp", 3, "g", "a > 0", "true")], [ROW]).passed


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[[gap]]\nfile = "a"\nfunction = "f"\n', "row 1 needs file, function and reason"),
        ('[[gap]]\nfile = "a"\nfunction = "f"\nreason = " "\n', "gives no reason"),
        ('[[gap]]\nfile = "a"\nfunction = "f"\nreason = "r"\nline = 3\n', "row 1 needs"),
        ('[[gap]]\nfile = "a"\nfunction = "f"\nreason = "r"\n' * 2, "row 2 .* is there twice"),
        ("[[gap]\n", "gaps.toml"),
    ],
)
@pytest.mark.verifies("SWR-VER-002", technique="equivalence_classes", polarity="violation")
def test_list_that_is_not_whole_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "gaps.toml"
    path.write_text(text, encoding="utf-8")

    with pytest.raises(WorkError, match=message):
        read_list(path)


@pytest.mark.verifies("SWR-VER-003")
def test_build_measures_with_the_flags_of_these_tests() -> None:
    presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
    (preset,) = (each["cacheVariables"] for each in presets if each["name"] == SANITIZED)
    functions = (ROOT / "cmake" / "MamoriTargets.cmake").read_text(encoding="utf-8")

    assert preset["CMAKE_CXX_COMPILER"] == COMPILER
    assert preset["MAMORI_MEASURE_COVERAGE"] == "ON"
    assert " ".join(FLAGS) in functions
    assert WRAPPED in functions


@pytest.mark.verifies("SWR-VER-003", technique="fault_injection", polarity="violation")
def test_expression_that_cannot_be_measured_does_not_compile(tmp_path: Path) -> None:
    done = compile_guarded(tmp_path, "bool f(bool);\nbool g(bool a, bool b, bool c) {\n    return c && f(a || b);\n}\n")

    assert done.returncode == 1
    assert re.search(r"seeded\.cpp:3:\d+: .*unsupported MC/DC", done.stderr)


@pytest.mark.parametrize(("text", "status"), [("int f(int a) { return 0; }\n", 0), ("int f(int a) { return b; }\n", 1)])
@pytest.mark.verifies("SWR-VER-003", technique="error_guessing")
def test_other_words_of_a_compiler_are_passed_on(tmp_path: Path, text: str, status: int) -> None:
    done = compile_guarded(tmp_path, text)

    assert done.returncode == status
    assert "seeded.cpp:1:" in done.stderr


def compile_guarded(folder: Path, text: str) -> subprocess.CompletedProcess[str]:
    source = folder / "seeded.cpp"
    source.write_text(text, encoding="utf-8")
    argv = (str(GUARD), COMPILER, *FLAGS, "-Wall", "-Wextra", "-c", str(source), "-o", str(folder / "seeded.o"))
    return subprocess.run(argv, text=True, capture_output=True, check=False)
