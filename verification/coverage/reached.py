# SPDX-License-Identifier: Apache-2.0
"""Evaluates an export of llvm-cov for each function: its decisions, and their coverage by the tests.

A decision with one condition is covered if it was true and false. In a decision with several conditions, each condition must have changed
the outcome independently (MC/DC). Instantiations of a template are merged: a condition is covered if any of them covers it.

@satisfies SWR-VER-001      Design: docs/design/test_strength.md#coverage
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

Span = tuple[int, int, int, int]  # first line, first column, last line, column after the last

EXPANSION = 1  # kinds of regions, as llvm::coverage numbers them
MCDC_BRANCH = 6
MAIN_FILE = 0


@dataclass
class Condition:
    """One condition and its observed values."""

    line: int
    text: str
    is_true_seen: bool = False
    is_false_seen: bool = False
    is_alone: bool = True  # the only condition of its decision
    is_effect_shown: bool = False  # it changed the outcome of its decision independently

    @property
    def missing(self) -> str:
        """The values that were not observed; empty if the condition is covered."""
        if not self.is_alone:
            return "" if self.is_effect_shown else "own effect on the decision"
        unseen = [word for word, seen in (("true", self.is_true_seen), ("false", self.is_false_seen)) if not seen]
        return " and ".join(unseen)

    def merge(self, other: Condition) -> None:
        self.is_true_seen |= other.is_true_seen
        self.is_false_seen |= other.is_false_seen
        self.is_effect_shown |= other.is_effect_shown


@dataclass
class Function:
    """One function of the source; all instantiations of a template count as one function."""

    file: str
    line: int
    name: str
    count: int = 0
    last_line: int = 0
    conditions: dict[tuple[object, ...], Condition] = field(default_factory=dict)


def read_functions(exported: dict[str, Any], root: Path) -> list[Function]:
    """Functions of the exported files below `root`, ordered by file and line."""
    wanted = {file["filename"] for data in exported["data"] for file in data["files"]}
    source = _Source()
    functions: dict[tuple[str, int, int], Function] = {}
    entries = [entry for data in exported["data"] for entry in data.get("functions", ())]
    names = _demangle(entry["name"].rpartition(":")[2] for entry in entries)
    for entry, name in zip(entries, names, strict=True):
        path = entry["filenames"][MAIN_FILE]
        if path not in wanted:
            continue
        file = Path(path).relative_to(root).as_posix()
        line, column = entry["regions"][0][:2]
        function = functions.setdefault((file, line, column), Function(file, line, name))
        function.count += entry["count"]
        function.last_line = max(function.last_line, entry["regions"][0][2])
        for key, condition in _read_conditions(entry, source):
            if key in function.conditions:
                function.conditions[key].merge(condition)
            else:
                function.conditions[key] = condition
    return [functions[key] for key in sorted(functions)]


def _read_conditions(entry: dict[str, Any], source: _Source) -> Iterator[tuple[tuple[object, ...], Condition]]:
    """Key (equal in all instantiations) and condition, of one instantiation."""
    branches: dict[int, list[list[int]]] = {}
    alone: dict[tuple[int, Span], int] = {}
    for branch in entry["branches"]:
        span, file_id = _span(branch), branch[6]
        if branch[8] == MCDC_BRANCH:
            branches.setdefault(file_id, []).append(branch)
            continue
        site, text = _describe(entry, source, span, file_id)
        number = alone[file_id, span] = alone.get((file_id, span), 0) + 1
        yield (site, span, number), Condition(site[0], text, branch[4] > 0, branch[5] > 0)
    for record in entry["mcdc_records"]:
        shown = record[-1]
        file_id = _find_file(branches, _span(record))
        if file_id is None:
            continue  # a constant expression, which the compiler has evaluated
        taken = _take_within(branches[file_id], _span(record), len(shown))
        for number, (branch, is_shown) in enumerate(zip(taken, _fit(shown, taken), strict=True), start=1):
            site, text = _describe(entry, source, _span(branch), file_id)
            if file_id != MAIN_FILE:
                text = f"condition {number} of {text}"
            yield ((site, _span(branch), number, "mcdc"),
                   Condition(site[0], text, branch[4] > 0, branch[5] > 0, is_alone=False, is_effect_shown=is_shown))


def _take_within(left: list[list[int]], span: Span, most: int) -> list[list[int]]:
    """Removes the conditions of the decision at `span` from the front of `left`. A condition that is constant in this template
    instantiation has no entry."""
    count = 0
    while count < min(most, len(left)) and span[:2] <= _span(left[count])[:2] and _span(left[count])[2:] <= span[2:]:
        count += 1
    taken = left[:count]
    del left[:count]
    return taken


def _fit(shown: list[bool], taken: list[list[int]]) -> list[bool]:
    """Whether the independent effect of each condition in `taken` was shown. llvm-cov does not evaluate decisions with a constant
    condition: a single remaining condition decides alone; of several, none counts as shown."""
    if len(taken) == len(shown):
        return shown
    return [len(taken) == 1 and branch[4] > 0 and branch[5] > 0 for branch in taken]


def _find_file(branches: dict[int, list[list[int]]], span: Span) -> int | None:
    """The file whose next decision is in `span`: the export contains the file of a branch, but not of a decision. None: no condition is
    left in `span`."""
    for file_id, left in sorted(branches.items()):
        if left and span[:2] <= _span(left[0])[:2] and _span(left[0])[2:] <= span[2:]:
            return file_id
    return None


def _describe(entry: dict[str, Any], source: _Source, span: Span, file_id: int) -> tuple[Span, str]:
    """Location in the file of the function, and the text there; for a macro expansion, the macro call."""
    if file_id == MAIN_FILE:
        return span, source.get_text(entry["filenames"][MAIN_FILE], span)
    while file_id != MAIN_FILE:
        region = next(each for each in entry["regions"] if each[7] == EXPANSION and each[6] == file_id)
        span, file_id = _span(region), region[5]
    return span, source.get_call(entry["filenames"][MAIN_FILE], span)


def _span(region: list[int]) -> Span:
    return region[0], region[1], region[2], region[3]


class _Source:
    """Texts of source files; columns count bytes from 1."""

    def __init__(self) -> None:
        self._lines: dict[str, list[bytes]] = {}

    def get_text(self, path: str, span: Span) -> str:
        first_line, first, last_line, end = span
        lines = self._read(path)[first_line - 1 : last_line]
        lines[-1] = lines[-1][: end - 1]
        lines[0] = lines[0][first - 1 :]
        return b" ".join(part for line in lines for part in line.split()).decode("utf-8")

    def get_call(self, path: str, span: Span) -> str:
        """The call that begins at `span`, including its closing bracket."""
        lines = self._read(path)[span[0] - 1 :]
        text = b"\n".join([lines[0][span[1] - 1 :], *lines[1:20]]).decode("utf-8")
        depth = 0
        for end, letter in enumerate(text, start=1):
            depth += (letter == "(") - (letter == ")")
            if letter == ")" and depth == 0:
                return " ".join(text[:end].split())
        return self.get_text(path, span)

    def _read(self, path: str) -> list[bytes]:
        if path not in self._lines:
            self._lines[path] = Path(path).read_bytes().split(b"\n")
        return self._lines[path]


_OPERATOR = re.compile(r"operator\s*(?:\(\)|\[\]|->\*?|<=>|<<=?|>>=?|<=?|>=?)")


def _demangle(names: Iterable[str]) -> list[str]:
    """Names as in the source: without namespace of the project, template arguments and parameters."""
    text = "\n".join(names)
    done = subprocess.run(("llvm-cxxfilt-19", "-p"), input=text, capture_output=True, text=True, check=True)
    return [_shorten(name) for name in done.stdout.splitlines()]


def _shorten(name: str) -> str:
    name = name.replace("(anonymous namespace)::", "")
    kept = ""
    depth = 0
    position = 0
    while position < len(name):
        operator = _OPERATOR.match(name, position)
        word = operator[0] if operator else name[position]
        position += len(word)
        if operator is None and word in "<>":
            depth += 1 if word == "<" else -1
        elif depth == 0:
            kept += word
    return kept.rpartition(" ")[2].removeprefix("mamori::")
