# SPDX-License-Identifier: Apache-2.0
"""Figures of the coverage per file: as a table for readers and as `coverage.json` for tools.

@satisfies SWR-VER-001      Design: docs/design/test_strength.md#coverage
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from mamori_trace.base.text_file import write_text
from verification.coverage.gaps import Gap, Verdict
from verification.coverage.reached import Function

SCHEMA = "mamori.coverage/1"


@dataclass
class Figures:
    """Covered and total numbers of one file."""

    file: str
    lines: int = 0
    lines_reached: int = 0
    functions: int = 0
    functions_reached: int = 0
    outcomes: int = 0
    outcomes_reached: int = 0
    conditions: int = 0
    conditions_shown: int = 0


def count(exported: dict[str, Any], functions: Sequence[Function], root: Path) -> list[Figures]:
    """Figures of each file, by name. Branch outcomes and conditions count once per source location, not per instantiation."""
    files: dict[str, Figures] = {}
    for data in exported["data"]:
        for entry in data["files"]:
            path = Path(entry["filename"])
            if path.is_relative_to(root):
                name = path.relative_to(root).as_posix()
                lines = entry["summary"]["lines"]
                files[name] = Figures(name, lines["count"], lines["covered"])
    for function in functions:
        one = files[function.file]
        one.functions += 1
        one.functions_reached += function.count > 0
        for condition in function.conditions.values():
            one.outcomes += 2
            one.outcomes_reached += condition.is_true_seen + condition.is_false_seen
            one.conditions += 1
            one.conditions_shown += not condition.missing
    return [files[name] for name in sorted(files)]


def add_up(files: Sequence[Figures]) -> Figures:
    total = Figures("all files")
    for one in files:
        for name, value in asdict(one).items():
            if name != "file":
                setattr(total, name, getattr(total, name) + value)
    return total


def make_table(files: Sequence[Figures], verdict: Verdict) -> str:
    """One line per file and one for all."""
    width = max(len(one.file) for one in files)
    lines = [f"{'file':{width}}  {'lines':>17}  {'branch outcomes':>17}  {'MC/DC':>17}  gaps listed / not listed"]
    for one in (*files, add_up(files)):
        listed = _count_gaps(one.file, [gap for gap, _ in verdict.accepted])
        unlisted = _count_gaps(one.file, verdict.unlisted)
        lines.append(
            f"{one.file:{width}}  {_share(one.lines_reached, one.lines)}  {_share(one.outcomes_reached, one.outcomes)}"
            f"  {_share(one.conditions_shown, one.conditions)}  {listed} / {unlisted}"
        )
    return "\n".join(lines)


def _count_gaps(file: str, gaps: Sequence[Gap]) -> int:
    return sum(file in (gap.file, "all files") for gap in gaps)


def _share(part: int, whole: int) -> str:
    return f"{f'{part}/{whole}':>9} {f'{100.0 * part / whole:.1f} %' if whole else '-':>7}"


def write_evidence(
    folder: Path, files: Sequence[Figures], verdict: Verdict, table: str, functions: Sequence[dict[str, Any]]
) -> None:
    """Writes coverage.json and coverage.txt, each atomically. @param functions the rows of record.make_rows."""
    content = {
        "schema": SCHEMA,
        "passed": verdict.passed,
        "total": asdict(add_up(files)),
        "files": [asdict(one) for one in files],
        "functions": list(functions),
        "gaps": [{**asdict(gap), "reason": row.reason} for gap, row in verdict.accepted]
        + [{**asdict(gap), "reason": None} for gap in verdict.unlisted],
        "unused_rows": [asdict(row) for row in verdict.unused],
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in (("coverage.json", json.dumps(content, indent=1)), ("coverage.txt", table + "\n")):
        write_text(folder / name, text)
