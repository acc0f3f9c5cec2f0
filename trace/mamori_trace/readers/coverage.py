# SPDX-License-Identifier: Apache-2.0
"""Reads the folder `coverage` of the evidence, and `coverage/by_test` for single tests.

@satisfies SWR-TRC-032, SWR-TRC-033      Design: docs/design/trace.md#coverage
"""

from __future__ import annotations

import json
import urllib.parse
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import FormatError
from mamori_trace.base.files import UNREADABLE, get_shown_path, list_paths, read_text
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.json_file import Maybe, find_misfit
from mamori_trace.model.coverage import Condition, CoverageRun
from mamori_trace.model.evidence import Evidence
from mamori_trace.readers.cobertura import take_cobertura
from mamori_trace.readers.lcov import take_lcov
from mamori_trace.readers.llvm_cov import TYPE, take_llvm
from mamori_trace.readers.source_names import SourceNames

SCHEMA = "mamori.coverage/1"
SUFFIXES = (".json", ".info", ".lcov", ".xml")
_FUNCTION = {"file": str, "name": str, "line": int, "last_line": int, "count": int, "lines": [int], "lines_missed": [int],
             "outcomes": int, "outcomes_reached": int, "conditions": int, "conditions_shown": int}  # fmt: skip
_GAP = {"file": str, "line": int, "function": str, "condition": str, "missing": str, "reason": Maybe(str)}
_FITTING_ERRORS = (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError)


def read_coverage(folder: Path, root: Path, names: SourceNames, evidence: Evidence, problems: list[Problem]) -> None:
    """Reads the runs, sorted by file. A file that violates its format is one problem and gives no coverage."""
    for path in sorted(each for pattern in ("coverage/*", "coverage/by_test/*") for each in list_paths(folder, pattern, root, problems)):
        if path.suffix in SUFFIXES and path.is_file():
            test = urllib.parse.unquote(path.stem) if path.parent.name == "by_test" else ""
            run = CoverageRun(Place(get_shown_path(path, root), 1), test)
            if _read_file(path, names, run, problems):
                evidence.coverage_runs.append(run)


def _read_file(path: Path, names: SourceNames, run: CoverageRun, problems: list[Problem]) -> bool:
    if path.suffix == ".xml":
        return take_cobertura(path, names, run, problems)
    before = len(problems)
    text = read_text(path, run.place.file, problems)
    if len(problems) > before:
        return False
    try:
        if path.suffix == ".json":
            _take_json(text, names, run)
        else:
            take_lcov(text.splitlines(), names, run)
        return True
    except json.JSONDecodeError as error:
        message, line = f"is not whole JSON ({error.msg}); measure again", error.lineno
    except RecursionError:
        message, line = "is nested too deeply to be coverage; measure again", 1
    except FormatError as error:
        message, line = str(error), 1
    except _FITTING_ERRORS as error:
        message, line = f"does not keep to its format ({type(error).__name__} {error}); measure again", 1
    problems.append(Problem(UNREADABLE, Place(run.place.file, line), message))
    return False


def _take_json(text: str, names: SourceNames, run: CoverageRun) -> None:
    content = json.loads(text)
    if not isinstance(content, dict):
        raise FormatError("is no coverage; measure again")
    if content.get("type") == TYPE:
        take_llvm(content, names, run)
    elif content.get("schema") == SCHEMA:
        _take_record(content, names, run)
    else:
        raise FormatError(f"is neither an export of llvm-cov (type {TYPE!r}) nor of this project (schema {SCHEMA!r})")


def _take_record(content: dict[str, Any], names: SourceNames, run: CoverageRun) -> None:
    """Output of the coverage gate of this project: figures of each function, and its gaps with their reasons."""
    misfit = find_misfit(content, {"functions": [_FUNCTION], "gaps": [_GAP]}, "")
    if misfit:
        raise FormatError(f"{misfit}; measure again")
    for row in content["functions"]:
        name = names.find(row["file"])
        if name:
            _take_function(row, name, run)
    for number, gap in enumerate(content["gaps"]):
        name = names.find(gap["file"])
        if name and gap["condition"]:
            text = f"'{gap['condition']}': {gap['missing']}"
            run.get_file(name).conditions[gap["line"], 1, number] = Condition(text, False, gap["reason"] or "")
        elif name and gap["reason"]:
            run.get_file(name).accepted[gap["line"]] = gap["reason"]


def _take_function(row: dict[str, Any], name: str, run: CoverageRun) -> None:
    """Covered conditions count at the line of the function, because the record contains only locations of gaps."""
    file = run.get_file(name)
    line = row["line"]
    file.calls[line] = file.calls.get(line, 0) + row["count"]
    missed = set(row["lines_missed"])
    file.lines.update({one: int(one not in missed) for one in row["lines"]})
    if row["outcomes"]:
        reached, known = file.branches.get(line, (0, 0))
        file.branches[line] = (reached + row["outcomes_reached"], known + row["outcomes"])
    unlisted = row["conditions"] if row["count"] == 0 else row["conditions_shown"]  # the record lists no conditions of uncalled functions
    for number in range(unlisted):
        file.conditions[line, 0, len(file.conditions), number] = Condition("a condition of what was never called", row["count"] > 0)
