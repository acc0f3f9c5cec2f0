# SPDX-License-Identifier: Apache-2.0
"""Counts the results in JUnit files."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.finding import Problem
from mamori_trace.model.evidence import ERRORED, FAILED, PASSED, UNIT, TestResult
from mamori_trace.readers.junit import read_junit_file


@dataclass(frozen=True)
class Counts:
    """Numbers of results by verdict."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0

    def __add__(self, other: Counts) -> Counts:
        return Counts(self.passed + other.passed, self.failed + other.failed, self.skipped + other.skipped)

    @property
    def total(self) -> int:
        return self.passed + self.failed + self.skipped

    def __str__(self) -> str:
        return f"{self.passed} passed, {self.failed} failed, {self.skipped} skipped"


def count_results(files: Iterable[Path]) -> Counts:
    """Adds up all test cases in `files`. A file that is not a complete result file counts as one failure."""
    counts = Counts()
    for path in files:
        cases = _read_cases(path)
        counts += Counts(failed=1) if cases is None else sum((_count_case(case) for case in cases), Counts())
    return counts


def list_failures(files: Iterable[Path]) -> list[str]:
    """One line per failed case: its name and the reason."""
    failures = []
    for path in files:
        cases = _read_cases(path)
        if cases is None:
            failures.append(f"{path.name}: is no whole result file")
            continue
        failures += [f"{case.suite}.{case.name}: {' '.join(case.message.split())}" for case in cases if case.status in (FAILED, ERRORED)]
    return failures


def _read_cases(path: Path) -> list[TestResult] | None:
    """Each case once, for any number of named requirements; None for an incomplete file."""
    problems: list[Problem] = []
    results = read_junit_file(path, path.name, UNIT, path.parent, problems)
    return None if problems else [result for result in results if result.is_first]


def _count_case(case: TestResult) -> Counts:
    if case.status == PASSED:
        return Counts(passed=1)
    return Counts(failed=1) if case.status in (FAILED, ERRORED) else Counts(skipped=1)
