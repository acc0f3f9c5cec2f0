# SPDX-License-Identifier: Apache-2.0
"""Anchors of the headings of a Markdown file, as common forges create them.

@satisfies SWR-TRC-001      Design: docs/design/trace.md#items
"""

from __future__ import annotations

import re
from pathlib import Path

from mamori_trace.base.files import read_text

_HEADING = re.compile(r" {0,3}#{1,6}[ \t]+(.*?)(?:[ \t]+#+)?[ \t]*$")
_FENCE = re.compile(r" {0,3}(```+|~~~+)")
_LINK = re.compile(r"!?\[([^\]]*)\]\([^)]*\)")
_DROPPED = re.compile(r"[^\w\- ]")


def read_anchors(root: Path, file: str) -> list[str] | None:
    """Anchors in order, or None if `file` is not a file inside the project."""
    path = root / file
    if not file or not path.is_file() or not path.resolve().is_relative_to(root.resolve()):
        return None
    return list_anchors(read_text(path, file, []))


def list_anchors(text: str) -> list[str]:
    """`## Verdict: who decides?` -> `verdict-who-decides`; a repeated heading gets `-1`, `-2`, ... as on the forges."""
    return [anchor for anchor, _, _ in list_headings(text)]


def list_headings(text: str) -> list[tuple[str, int, int]]:
    """(anchor, depth, line) of each heading; depth is the number of its hash signs, lines count from 1."""
    headings: list[tuple[str, int, int]] = []
    counts: dict[str, int] = {}
    fence = ""
    for number, line in enumerate(text.splitlines(), start=1):
        mark = _FENCE.match(line)
        if mark and (not fence or mark[1].startswith(fence)):
            fence = "" if fence else mark[1]
        heading = None if fence else _HEADING.match(line)
        if heading:
            slug = _make_slug(heading[1])
            count = counts.get(slug, 0)
            counts[slug] = count + 1
            depth = len(line.lstrip()) - len(line.lstrip().lstrip("#"))
            headings.append((f"{slug}-{count}" if count else slug, depth, number))
    return headings


def _make_slug(heading: str) -> str:
    plain = _LINK.sub(r"\1", heading).replace("`", "")
    return _DROPPED.sub("", plain.lower()).strip().replace(" ", "-")
