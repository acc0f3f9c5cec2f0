# SPDX-License-Identifier: Apache-2.0
"""Allocates ids that were never used and forms the draft of an item.

@satisfies SWR-TRC-078      Design: docs/design/trace.md#new-items
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass

from mamori_trace.base.errors import FormatError
from mamori_trace.model.item import DRAFT, Level
from mamori_trace.model.project import Project

_NUMBER = re.compile(r"(\d{3})(?!\d)")
_LAST = 999


@dataclass(frozen=True, slots=True)
class Wish:
    """The request of the user; empty fields get default values."""

    kind: str
    area: str = ""
    new_area: bool = False
    title: str = ""
    statement: str = ""
    rationale: str = ""
    parents: tuple[str, ...] = ()
    sil: str = ""
    verify: str = ""
    polarity: str = ""
    design: str = ""


def find_prefix(project: Project, wish: Wish) -> tuple[Level, str]:
    """The level and the beginning of the id, such as `SWR-SUP-`. Raises FormatError."""
    level = project.schema.levels.get(wish.kind.upper())
    if level is None:
        raise FormatError(f"there is no kind '{wish.kind}'" + _hint(wish.kind.upper(), project.schema.levels))
    if level.pattern.fullmatch(f"{level.key}-001"):
        if wish.area:
            raise FormatError(f"{level.key} items have no area; leave --area out")
        return level, f"{level.key}-"
    areas = sorted({item.id.split("-")[1] for item in project.all_items if item.level == level.key})
    area = wish.area.upper()
    if not area:
        raise FormatError(f"{level.key} items have an area: --area, one of {', '.join(areas) or 'your own with --new-area'}")
    if not level.pattern.fullmatch(f"{level.key}-{area}-001"):
        raise FormatError(f"'{wish.area}' cannot be an area; ids have the form {level.pattern.pattern}")
    if area not in areas and not wish.new_area:
        raise FormatError(f"there is no area '{area}'{_hint(area, areas)}; --new-area begins it")
    return level, f"{level.key}-{area}-"


def allocate(prefix: str, texts: Iterable[str]) -> str:
    """The first id above all ids in `texts`. Raises FormatError if no number is left."""
    highest = find_highest(prefix, texts)
    if highest >= _LAST:
        raise FormatError(f"no number is left above {prefix}{highest}; begin another area")
    return f"{prefix}{highest + 1:03d}"


def find_highest(prefix: str, texts: Iterable[str]) -> int:
    """The maximum number after `prefix` in `texts`; 0 if there is none."""
    highest = 0
    for text in texts:
        position = text.find(prefix)
        while position >= 0:
            match = _NUMBER.match(text, position + len(prefix))
            if match:
                highest = max(highest, int(match[1]))
            position = text.find(prefix, position + len(prefix))
    return highest


def format_draft(project: Project, level: Level, item_id: str, wish: Wish) -> str:
    """The item block. Raises FormatError if a parent is missing or its level may not be a parent."""
    for name in wish.parents:
        _demand_parent(project, level, name)
    if level.parents and not any(name.partition("-")[0] in level.parents for name in wish.parents):
        raise FormatError(f"{level.key} items have a parent of level {' or '.join(level.parents)}: --parents")
    default = "The item shall be stated." if level.shall else "The item is to be stated."
    values = {
        "Rationale": wish.rationale or "To be argued.",
        "Parents": ", ".join(wish.parents) or "-",
        "SIL": wish.sil or _get_highest_sil(project, wish.parents),
        "Verify": wish.verify or ("review" if level.from_children else "test"),
        "Polarity": wish.polarity or project.schema.polarity[0],
        "Design": wish.design or "-",
        "Status": DRAFT,
    }
    rows = "".join(f"- {name}: {values.get(name, '-')}\n" for name in project.schema.attributes)
    return f"## {item_id} {wish.title or 'New item'}\n\n{wish.statement or default}\n\n{rows}"


def _demand_parent(project: Project, level: Level, name: str) -> None:
    parent = project.items.get(name)
    if parent is None:
        near = ", ".join(project.suggest(name))
        raise FormatError(f"parent {name} is defined nowhere" + (f"; nearest: {near}" if near else ""))
    if parent.retired:
        raise FormatError(f"parent {name} is retired")
    allowed = (*level.parents, *level.also)
    if parent.level not in allowed:
        levels = ", ".join(allowed) or "none"
        raise FormatError(f"parent {name} is of level {parent.level}; {level.key} items have parents of level {levels}")


def _get_highest_sil(project: Project, parents: tuple[str, ...]) -> str:
    order = project.schema.sil
    known = [project.items[name].sil for name in parents if project.items[name].sil in order]
    return max(known, key=order.index, default=order[0])


def _hint(word: str, known: Iterable[str]) -> str:
    names = sorted(known)
    near = difflib.get_close_matches(word, names, n=3, cutoff=0.4) or names[:8]
    return f"; nearest: {', '.join(near)}" if near else ""
