# SPDX-License-Identifier: Apache-2.0
"""Reads and writes requirements/ids.lock: one line per retired id, sorted, so that merges and diffs are simple.

@satisfies SWR-TRC-025      Design: docs/design/trace.md#ids
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.files import UNREADABLE, get_shown_path, read_text
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.write import write_whole
from mamori_trace.model.ids import FormerId

IDS_PATH = "requirements/ids.lock"
_HEAD = "# mamori.ids/1: id, fingerprint, date, title of items that are no more. Written by `mamori trace review`.\n"
_COLUMNS = 4
_NONE = "-"


def read_ids(root: Path, problems: list[Problem]) -> dict[str, FormerId]:
    """Retired ids; none without a ledger. An invalid line is a problem."""
    path = root / IDS_PATH
    if not path.exists():
        return {}
    shown = get_shown_path(path, root)
    former: dict[str, FormerId] = {}
    for number, line in enumerate(read_text(path, shown, problems).splitlines(), start=1):
        if not line.strip() or line.startswith("#"):
            continue
        place = Place(shown, number)
        cells = line.split(maxsplit=_COLUMNS - 1)
        if len(cells) != _COLUMNS:
            problems.append(Problem(UNREADABLE, place, f"has {len(cells)} of {_COLUMNS} columns; restore the line from the history"))
            continue
        key, fingerprint, date, title = cells
        former[key] = FormerId(key, fingerprint, date, "" if title == _NONE else title, place)
    return former


def write_ids(root: Path, former: dict[str, FormerId]) -> None:
    """Writes the ledger atomically, following a link at its path; writes no file if no id was ever retired."""
    if former or (root / IDS_PATH).exists():
        rows = [f"{each.id} {each.fingerprint} {each.date} {each.title or _NONE}\n" for _, each in sorted(former.items())]
        write_whole(root / IDS_PATH, _HEAD + "".join(rows))
