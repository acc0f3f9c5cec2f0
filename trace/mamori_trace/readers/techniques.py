# SPDX-License-Identifier: Apache-2.0
"""Reads requirements/schema/techniques.toml.

@satisfies SWR-TRC-027      Design: docs/design/trace.md#techniques
"""

from __future__ import annotations

import os
from pathlib import Path

from mamori_trace.base.files import UNREADABLE
from mamori_trace.base.finding import Problem
from mamori_trace.model.technique import PHASES, Technique
from mamori_trace.readers.toml_rows import Columns, read_rows, suggest

TECHNIQUES_PATH = "requirements/schema/techniques.toml"
_COLUMNS = Columns(texts=("name", "clause", "phase"), lists=("items", "tests", "documents"), needed=("name", "clause", "phase"))


def read_techniques(root: Path, problems: list[Problem]) -> list[Technique] | None:
    """Techniques in file order, or None if the project lists none. An invalid row is a problem and is omitted."""
    path = root / TECHNIQUES_PATH
    if not os.path.lexists(path):
        return None
    techniques: list[Technique] = []
    for row, place in read_rows(path, "mamori.techniques/1", "technique", _COLUMNS, root, problems):
        technique = Technique(place=place, **row)
        if technique.phase in PHASES:
            techniques.append(technique)
        else:
            fault = f"phase '{technique.phase}' is not one of {', '.join(PHASES)}{suggest(technique.phase, PHASES)}"
            problems.append(Problem(UNREADABLE, place, fault))
    return techniques
