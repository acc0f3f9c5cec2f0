# SPDX-License-Identifier: Apache-2.0
"""Queries git for the commits that changed each item: one call, read as a stream, with limits for commits, bytes and time.

@satisfies SWR-TRC-063      Design: docs/design/trace.md#display
"""

from __future__ import annotations

import re
import tempfile
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from mamori_trace.base.git_run import run_git

COMMITS_MAX = 2000
CHANGES_MAX = 20
_SECONDS_MAX = 20
_LINES_MAX = 2_000_000
_COMMIT = "\x1e"
_HUNK = re.compile(r"@@ -\S+ \+\S+ @@ ?(.*)")
_HEADING = re.compile(r" {0,3}## +(\S+)")


@dataclass(frozen=True, slots=True)
class Change:
    """One commit that changed the block of an item. `commit` is abbreviated, `date` is ISO 8601."""

    commit: str
    date: str
    subject: str


def read_item_history(root: Path) -> dict[str, list[Change]]:
    """Changes of each item, the newest first, at most CHANGES_MAX of each. Empty if git has no history."""
    if not (root / "requirements").is_dir():
        return {}
    with tempfile.NamedTemporaryFile("w", suffix=".attributes") as attributes:
        # git then names the heading above each hunk, which belongs to the item that contains the hunk.
        attributes.write("*.md diff=markdown\n")
        attributes.flush()
        command = [
            "-c", f"core.attributesFile={attributes.name}", "-c", "core.quotePath=false", "log",
            f"--max-count={COMMITS_MAX}", "--no-color", "--no-ext-diff", "--no-textconv", "--no-renames", "--unified=0",
            f"--format={_COMMIT}%h%x1f%cs%x1f%s", "--abbrev=12", "--patch", "--", "requirements",
        ]  # fmt: skip
        answer = run_git(root, command, _SECONDS_MAX)
    return {} if answer is None else find_changes(answer.decode("utf-8", errors="replace").split("\n"))


def find_changes(lines: Iterable[str]) -> dict[str, list[Change]]:
    """Changes by item, from the lines of `git log --patch --unified=0`."""
    changes: dict[str, list[Change]] = defaultdict(list)
    commit = Change("", "", "")
    item = ""
    in_hunk = is_told = False  # is_told: the item already has this commit, so only the next heading matters
    for line in islice(lines, _LINES_MAX):
        if line[:1] in ("+", "-"):
            if not in_hunk or (is_told and "##" not in line) or not line[1:].strip():
                continue
            heading = _HEADING.match(line, 1)
            item = heading[1] if heading else item
            if item:
                _add_change(changes[item], commit)
            is_told = True
        elif line.startswith(_COMMIT):
            commit = Change(*[*line[1:].split("\x1f", 2), "", ""][:3])
            in_hunk = False
        elif hunk := _HUNK.match(line):
            heading = _HEADING.match(hunk[1])
            item = heading[1] if heading else ""
            in_hunk, is_told = True, False
        elif line.startswith("diff --git "):
            in_hunk = False
    return dict(changes)


def _add_change(known: list[Change], commit: Change) -> None:
    if len(known) < CHANGES_MAX and (not known or known[-1] is not commit):
        known.append(commit)
