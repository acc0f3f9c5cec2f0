# SPDX-License-Identifier: Apache-2.0
"""Goal: an inconclusive program is repeated at most twice, a failed one never. Method: handwritten result files."""

from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.host.junit import count_results
from verification.real_time.repeat import list_figures, read_verdict, repeat_inconclusive

FAILED = '<testcase name="b" classname="T"><failure message="no"/></testcase>'
PASSED = '<testcase name="c" classname="T"/>'
INCONCLUSIVE = (
    '<testcase name="a" classname="T"><skipped message="host"/><properties>'
    '<property name="verdict" value="inconclusive"/><property name="figure" value="7 stalls"/></properties></testcase>'
)
SKIPPED = '<testcase name="a" classname="T"><skipped message="no privilege"/></testcase>'


class Program:
    """Writes the next of its results at each run."""

    def __init__(self, path: Path, *results: str) -> None:
        self.path, self.results, self.runs = path, list(results), 0
        self.run()

    def run(self) -> None:
        self.runs += 1
        self.path.write_text(f"<testsuites><testsuite>{self.results.pop(0)}</testsuite></testsuites>", encoding="utf-8")


@pytest.mark.verifies("SWR-VER-023", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("results", "verdict", "runs"),
    [
        ((PASSED, FAILED), "passed", 1),
        ((SKIPPED, FAILED), "passed", 1),
        ((FAILED, PASSED), "failed", 1),
        ((FAILED + INCONCLUSIVE, PASSED), "failed", 1),
        ((INCONCLUSIVE, PASSED, FAILED), "passed", 2),
        ((INCONCLUSIVE, FAILED, PASSED), "failed", 2),
        ((INCONCLUSIVE, INCONCLUSIVE, PASSED, FAILED), "passed", 3),
        ((INCONCLUSIVE, INCONCLUSIVE, INCONCLUSIVE, FAILED), "inconclusive", 3),
    ],
)
def test_only_an_inconclusive_program_runs_again_and_at_most_twice(
    tmp_path: Path, results: tuple[str, ...], verdict: str, runs: int
) -> None:
    program = Program(tmp_path / "a.xml", *results)

    assert repeat_inconclusive(program.path, program.run)[0] == verdict
    assert program.runs == runs


@pytest.mark.verifies("SWR-VER-023", technique="requirements_based")
def test_an_inconclusive_result_counts_as_skipped_and_keeps_its_figure(tmp_path: Path) -> None:
    program = Program(tmp_path / "a.xml", INCONCLUSIVE + PASSED)

    assert str(count_results([program.path])) == "1 passed, 0 failed, 1 skipped"
    assert list_figures(program.path) == ["T.a: 7 stalls"]


@pytest.mark.verifies("SWR-VER-023", technique="error_guessing", polarity="violation")
def test_a_file_that_is_cut_off_is_failed_and_not_repeated(tmp_path: Path) -> None:
    path = tmp_path / "a.xml"
    path.write_text("<testsuites>", encoding="utf-8")
    assert read_verdict(path) == "failed"
    assert repeat_inconclusive(path, lambda: pytest.fail("repeated")) == ("failed", 0)
