# SPDX-License-Identifier: Apache-2.0
"""Reads and writes requirements/trace.lock: one line per reviewed link, sorted, so that merges and diffs are simple.

@satisfies SWR-TRC-008      Design: docs/design/trace.md#suspect-links
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.files import UNREADABLE, get_shown_path, read_text
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.write import write_whole
from mamori_trace.model.lock import Review, ReviewLock

LOCK_PATH = "requirements/trace.lock"
_HEAD = "# mamori.lock/1: child, fingerprint, parent, fingerprint, date, reviewer. Written by `mamori trace review`.\n"
_COLUMNS = 6


def read_lock(root: Path, problems: list[Problem], path: Path | None = None) -> ReviewLock | None:
    """The lock, or None if the project has none. `path`: its location if that is not the default."""
    path = path or root / LOCK_PATH
    if not path.exists():
        return None
    shown = get_shown_path(path, root)
    lock = ReviewLock(file=shown)
    for number, line in enumerate(read_text(path, shown, problems).splitlines(), start=1):
        if not line.strip() or line.startswith("#"):
            continue
        cells = line.split(maxsplit=_COLUMNS - 1)
        if len(cells) != _COLUMNS:
            message = f"has {len(cells)} of {_COLUMNS} columns; review the link again with `mamori trace review`"
            problems.append(Problem(UNREADABLE, Place(shown, number), message))
            continue
        child, child_print, parent, parent_print, date, reviewer = cells
        lock.reviews[(child, parent)] = Review(child, parent, child_print, parent_print, date, reviewer)
        lock.lines[(child, parent)] = number
    return lock


def write_lock(root: Path, lock: ReviewLock, path: Path | None = None) -> None:
    """Writes the lock atomically, following a link at its path. Raises InputError."""
    rows = [
        f"{each.child} {each.child_fingerprint} {each.parent} {each.parent_fingerprint} {each.date} {each.reviewer}\n"
        for _, each in sorted(lock.reviews.items())
    ]
    write_whole(path or root / LOCK_PATH, _HEAD + "".join(rows))
