# SPDX-License-Identifier: Apache-2.0
"""Coverage by executed tests: of each source file, each function, and the functions of a requirement.

@satisfies SWR-TRC-032, SWR-TRC-033      Design: docs/design/trace.md#coverage
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable
from dataclasses import dataclass, field

from mamori_trace.base.finding import Place
from mamori_trace.model.code import Function


@dataclass(slots=True)
class Condition:
    """One condition of a decision. `reason` states why a missing proof is accepted."""

    text: str
    shown: bool
    reason: str = ""


@dataclass(slots=True)
class FileCoverage:
    """Counters of one file, by line. `calls`: entries into the function that begins there; `accepted`: why that function need not be
    called; `branches`: reached and all branches. The key of a condition begins with its line."""

    lines: dict[int, int] = field(default_factory=dict)
    calls: dict[int, int] = field(default_factory=dict)
    accepted: dict[int, str] = field(default_factory=dict)
    branches: dict[int, tuple[int, int]] = field(default_factory=dict)
    conditions: dict[tuple[int, ...], Condition] = field(default_factory=dict)

    def add(self, other: FileCoverage) -> None:
        """Adds the coverage of another run. A reason applies if any run gives it."""
        for mine, others in ((self.lines, other.lines), (self.calls, other.calls)):
            for line, count in others.items():
                mine[line] = mine.get(line, 0) + count
        self.accepted.update(other.accepted)
        for line, (reached, known) in other.branches.items():
            old = self.branches.get(line, (0, 0))
            self.branches[line] = (max(old[0], reached), max(old[1], known))
        for key, condition in other.conditions.items():
            known_one = self.conditions.setdefault(key, Condition(condition.text, False))
            known_one.shown |= condition.shown
            known_one.reason = known_one.reason or condition.reason


@dataclass(slots=True)
class CoverageRun:
    """One coverage file. `test` is the title of the only test that it covers; empty for all tests."""

    place: Place
    test: str = ""
    files: dict[str, FileCoverage] = field(default_factory=dict)

    def get_file(self, name: str) -> FileCoverage:
        return self.files.setdefault(name, FileCoverage())


@dataclass(frozen=True, slots=True)
class Gap:
    """A condition whose independent effect no test has shown. `reason` states why that is accepted."""

    place: Place
    text: str
    reason: str = ""


@dataclass(slots=True)
class Reached:
    """Coverage of one function, or of all functions of one requirement. `functions_measured` are the functions with counters."""

    functions: int = 0
    functions_measured: int = 0
    functions_executed: int = 0
    lines: int = 0
    lines_reached: int = 0
    branches: int = 0
    branches_reached: int = 0
    conditions: int = 0
    conditions_shown: int = 0
    gaps: list[Gap] = field(default_factory=list)
    accepted: str = ""

    @property
    def executed(self) -> bool:
        return self.functions_executed > 0

    def add(self, other: Reached) -> None:
        for name in _NUMBERS:
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.gaps += other.gaps


_NUMBERS = ("functions", "functions_measured", "functions_executed", "lines", "lines_reached", "branches", "branches_reached",
            "conditions", "conditions_shown")  # fmt: skip


@dataclass(slots=True)
class _Index:
    """One file with sorted lines of each kind, so that the lines of a function are found quickly."""

    coverage: FileCoverage
    lines: list[int]
    calls: list[int]
    branches: list[int]
    conditions: list[tuple[int, ...]]


class Coverage:
    """The merged coverage of several runs."""

    def __init__(self, runs: Iterable[CoverageRun]) -> None:
        merged: dict[str, FileCoverage] = {}
        for run in runs:
            for name, file in run.files.items():
                merged.setdefault(name, FileCoverage()).add(file)
        self._files = {
            name: _Index(one, sorted(one.lines), sorted(one.calls), sorted(one.branches), sorted(one.conditions))
            for name, one in merged.items()
        }

    def has_file(self, name: str) -> bool:
        return name in self._files

    def measure(self, function: Function) -> Reached:
        """The coverage of the function."""
        result = Reached(functions=1)
        index = self._files.get(function.file)
        if index is None:
            return result
        file, first, last = index.coverage, function.first, function.last
        counts = [file.lines[line] for line in _cut(index.lines, function.body, last)]
        calls = [file.calls[line] for line in _cut(index.calls, first, last)]
        result.functions_measured = int(bool(counts or calls))
        result.functions_executed = int(any(count > 0 for count in (*counts, *calls)))
        result.lines, result.lines_reached = len(counts), sum(count > 0 for count in counts)
        result.accepted = next((file.accepted[line] for line in _cut(index.calls, first, last) if line in file.accepted), "")
        for line in _cut(index.branches, first, last):
            reached, known = file.branches[line]
            result.branches_reached += reached
            result.branches += known
        start = bisect_left(index.conditions, (first,))
        for key in index.conditions[start : bisect_left(index.conditions, (last + 1,))]:
            self._count_condition(result, Place(function.file, key[0]), file.conditions[key])
        return result

    def _count_condition(self, result: Reached, place: Place, condition: Condition) -> None:
        result.conditions += 1
        result.conditions_shown += condition.shown
        if not condition.shown:
            result.gaps.append(Gap(place, condition.text, condition.reason or result.accepted))


def _cut(lines: list[int], first: int, last: int) -> list[int]:
    return lines[bisect_left(lines, first) : bisect_right(lines, last)]
