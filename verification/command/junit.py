# SPDX-License-Identifier: Apache-2.0
"""Counts the results in JUnit files."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path


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
    """Adds up all test cases in `files`. A file that is no whole XML counts as one failure."""
    counts = Counts()
    for path in files:
        try:
            cases = list(ElementTree.parse(path).iter("testcase"))
        except (OSError, ElementTree.ParseError):
            counts += Counts(failed=1)
            continue
        for case in cases:
            counts += _count_case(case)
    return counts


def list_failures(files: Iterable[Path]) -> list[str]:
    """One line per failed case: its name and the first line of the reason."""
    failures = []
    for path in files:
        try:
            cases = list(ElementTree.parse(path).iter("testcase"))
        except (OSError, ElementTree.ParseError):
            failures.append(f"{path.name}: is no whole result file")
            continue
        for case in cases:
            cause = next((found for kind in ("failure", "error") if (found := case.find(kind)) is not None), None)
            if cause is not None:
                reason = " ".join((cause.get("message") or cause.text or "").split())
                failures.append(f"{case.get('classname', '')}.{case.get('name', '')}: {reason}")
    return failures


def _count_case(case: ElementTree.Element) -> Counts:
    if case.find("failure") is not None or case.find("error") is not None:
        return Counts(failed=1)
    # GoogleTest marks a disabled test by status="notrun" and a skipped one by an element.
    if case.find("skipped") is not None or case.get("status") == "notrun":
        return Counts(skipped=1)
    return Counts(passed=1)
