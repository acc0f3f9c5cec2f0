# SPDX-License-Identifier: Apache-2.0
"""Reads LCOV tracefiles (`.info`): lines, functions, branches, and the MC/DC of newer versions.

@satisfies SWR-TRC-032      Design: docs/design/trace.md#coverage
"""

from __future__ import annotations

from collections.abc import Iterable

from mamori_trace.base.errors import FormatError
from mamori_trace.model.coverage import Condition, CoverageRun, FileCoverage
from mamori_trace.readers.source_names import SourceNames


class _Record:
    """The data between `SF:` and `end_of_record`."""

    def __init__(self) -> None:
        self.file = FileCoverage()
        self.lines_of: dict[str, int] = {}
        self.senses: dict[tuple[int, ...], dict[str, int]] = {}
        self.texts: dict[tuple[int, ...], str] = {}

    def take(self, key: str, value: str) -> None:
        """One line. Raises ValueError and IndexError if it violates the format; unknown keys are ignored."""
        words = value.split(",")
        if key == "DA":
            self.file.lines[int(words[0])] = self.file.lines.get(int(words[0]), 0) + max(0, int(float(words[1])))
        elif key == "FN":
            self.lines_of[words[-1]] = int(words[0])
        elif key == "FNDA":
            self._count_call(words[1], words[0])
        elif key == "FNL":
            self.lines_of[f"#{words[0]}"] = int(words[1])
        elif key == "FNA":
            self._count_call(f"#{words[0]}", words[1])
        elif key == "BRDA":
            reached, known = self.file.branches.get(int(words[0]), (0, 0))
            self.file.branches[int(words[0])] = (reached + (words[-1] != "-" and int(words[-1]) > 0), known + 1)
        elif key == "MCDC":
            where = (int(words[0]), int(words[1].lstrip("e")), int(words[4]))
            self.senses.setdefault(where, {})[words[2]] = int(words[3])
            self.texts[where] = ",".join(words[5:])

    def _count_call(self, name: str, count: str) -> None:
        if name in self.lines_of:
            line = self.lines_of[name]
            self.file.calls[line] = self.file.calls.get(line, 0) + max(0, int(count))

    def finish(self) -> FileCoverage:
        for key, senses in self.senses.items():
            text = f"condition {key[2] + 1} of the decision of {key[1]}: {self.texts[key] or 'no text'}"
            self.file.conditions[key] = Condition(text, senses.get("t", 0) > 0 and senses.get("f", 0) > 0)
        return self.file


def take_lcov(lines: Iterable[str], names: SourceNames, run: CoverageRun) -> None:
    """Fills `run`. Raises FormatError, which names the line."""
    record, name = None, ""
    number = 0
    for number, line in enumerate(lines, start=1):
        key, _, value = line.strip().partition(":")
        if key == "SF":
            record, name = _Record(), names.find(value)
        elif key == "end_of_record" and record is not None:
            if name:
                run.get_file(name).add(record.finish())
            record = None
        elif record is not None:
            try:
                record.take(key, value)
            except (ValueError, IndexError):
                raise FormatError(f"line {number}: '{line.strip()[:80]}' is no LCOV; measure again") from None
        elif key not in ("", "TN", "VER") and not key.startswith("#"):
            raise FormatError(f"line {number}: '{line.strip()[:80]}' stands in no record (SF: ... end_of_record); measure again")
    if record is not None or number == 0:
        raise FormatError(f"line {max(number, 1)}: ends within a record; measure again")
