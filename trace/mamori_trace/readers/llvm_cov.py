# SPDX-License-Identifier: Apache-2.0
"""Reads the JSON export of llvm-cov: lines, branches and MC/DC.

@satisfies SWR-TRC-032      Design: docs/design/trace.md#coverage
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import Any

from mamori_trace.base.errors import FormatError
from mamori_trace.model.coverage import Condition, CoverageRun, FileCoverage
from mamori_trace.readers.source_names import SourceNames

TYPE = "llvm.coverage.json.export"
_MAIN_FILE = 0


def take_llvm(content: dict[str, Any], names: SourceNames, run: CoverageRun) -> None:
    """Fills `run`. Raises FormatError, KeyError, TypeError, ValueError or IndexError if the export violates its format."""
    for data in content["data"]:
        for entry in data["files"]:
            name = names.find(entry["filename"])
            if name:
                if "segments" not in entry:
                    raise FormatError("is a summary without lines; export it without -summary-only")
                _take_file(entry, run.get_file(name))
        for function in data.get("functions", ()):
            name = names.find(function["filenames"][_MAIN_FILE])
            if name and name in run.files:
                line = int(function["regions"][0][0])
                calls = run.files[name].calls
                calls[line] = calls.get(line, 0) + int(function["count"])


def _take_file(entry: dict[str, Any], file: FileCoverage) -> None:
    taken = FileCoverage(lines=calc_line_counts(entry["segments"]))
    seen: dict[tuple[int, int, int, int], list[bool]] = defaultdict(lambda: [False, False])
    for branch in entry.get("branches", ()):
        place = (int(branch[0]), int(branch[1]), int(branch[2]), int(branch[3]))
        both = seen[place]
        both[0] |= branch[4] > 0
        both[1] |= branch[5] > 0
    for place, both in seen.items():
        reached, known = taken.branches.get(place[0], (0, 0))
        taken.branches[place[0]] = (reached + sum(both), known + 2)
    for record in entry.get("mcdc_records", ()):
        shown = next((part for part in record if isinstance(part, list)), [])
        for number, is_shown in enumerate(shown):
            key = (*map(int, record[:4]), len(shown), number)
            text = f"condition {number + 1} of the decision of {len(shown)} in column {record[1]}"
            old = taken.conditions.setdefault(key, Condition(text, False))
            old.shown |= bool(is_shown)
    file.add(taken)


def calc_line_counts(segments: Iterable[list[Any]]) -> dict[int, int]:
    """Executions of each line with code, as llvm-cov shows them: the maximum of all regions that begin in the line, otherwise the count of
    the region that continues from above. A segment is line, column, count, whether it counts, begins a region, fills a gap."""
    by_line: dict[int, list[list[Any]]] = defaultdict(list)
    for segment in segments:
        by_line[int(segment[0])].append(segment)
    counts: dict[int, int] = {}
    above: list[Any] | None = None
    lines = sorted(by_line)
    for line, following in zip(lines, [*lines[1:], None], strict=False):
        here = by_line[line]
        begun = [int(one[2]) for one in here if one[3] and one[4] and not one[5]]
        is_skipped = not here[0][3] and here[0][4]
        inside = int(above[2]) if above is not None and above[3] else None
        if (begun or inside is not None) and not is_skipped:
            counts[line] = max([*begun, inside or 0])
        above = here[-1]
        if above[3] and following is not None:
            counts.update(dict.fromkeys(range(line + 1, following), int(above[2])))
    return counts
