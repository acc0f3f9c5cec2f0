# SPDX-License-Identifier: Apache-2.0
"""Reads the memory of small systems: `size/size.json` (docs/design/proofs.md#size).

@satisfies SWR-VER-031      Design: docs/design/proofs.md#size
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.files import UNREADABLE, list_paths
from mamori_trace.base.finding import Problem
from mamori_trace.base.json_file import Each, Maybe, read_records
from mamori_trace.model.evidence import Evidence, SizeRun

SCHEMA = "mamori.size/1"

_SHAPE = {
    "compiler": str, "base": str,
    "images": [{"name": str, "title": str, "text": int, "ram": int, "data": int, "text_max": int, "ram_max": int,
                "text_aim": Maybe(int), "ram_aim": Maybe(int), "missed": bool, "parts": Each(int), "findings": [str]}],
}  # fmt: skip
"""The parts of the record that the page shows; the record may contain more."""


def read_size(folder: Path, root: Path, evidence: Evidence, problems: list[Problem]) -> None:
    """Reads the sizes. A record that violates the format, or that has no image of its base, is one problem."""
    files = list_paths(folder, "size/size.json", root, problems)
    for _, table, place in read_records(files, SCHEMA, _SHAPE, "run the size proof again", root, problems):
        if any(image["name"] == table["base"] for image in table["images"]):
            evidence.size_runs.append(SizeRun(table, place))
        else:
            problems.append(Problem(UNREADABLE, place, f"no image is the base '{table['base']}'; run the size proof again"))
