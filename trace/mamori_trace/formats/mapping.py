# SPDX-License-Identifier: Apache-2.0
"""Meaning of the words of a format: the shipped table of the format, and the entries of the user, which take precedence.

@satisfies SWR-TRC-046      Design: docs/design/trace_formats.md#levels-from-data
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import InputError
from mamori_trace.base.toml_file import load_toml
from mamori_trace.model.item import Level

_FOLDER = Path(__file__).parent / "schemas"
_SCHEMA = "mamori.foreign/1"
_LISTS = ("parent_roles", "child_roles", "ignored_roles", "sil", "status", "verify", "polarity", "test_groups", "code_groups")
_SHARES = ("parent", "link", "child", "shall", "statement")
_FLAGS = ("shall", "needs_child", "needs_code", "from_children", "through_children")


@dataclass(frozen=True, slots=True)
class Mapping:
    """`lists`, `shares` and `words`: see schemas/common.toml; `levels` is empty if the data determine the levels."""

    group_by: str
    lists: dict[str, tuple[str, ...]]
    shares: dict[str, float]
    draft: frozenset[str]
    retired: frozenset[str]
    levels: dict[str, Level]
    source: str

    def leads_up(self, role: str) -> bool:
        if role in self.lists["ignored_roles"] or role in self.lists["child_roles"]:
            return False
        return role in self.lists["parent_roles"] or "*" in self.lists["parent_roles"]

    def leads_down(self, role: str) -> bool:
        return role in self.lists["child_roles"] and role not in self.lists["ignored_roles"]


def read_mapping(name: str, own: Path | None) -> Mapping:
    """The table of the format `name`. Raises InputError for an unusable file of the user."""
    table: dict[str, Any] = {"share": {}, "words": {}, "level": {}}
    paths = [_FOLDER / "common.toml", _FOLDER / f"{name}.toml", *([own] if own else [])]
    for path in paths:
        for key, value in _read(path).items():
            table[key] = {**table[key], **value} if isinstance(table.get(key), dict) and isinstance(value, dict) else value
    try:
        return _make_mapping(table, str(paths[-1]))
    except (TypeError, ValueError, AttributeError, KeyError, re.error) as error:
        raise InputError(f"{paths[-1]}: {error}") from None


def _read(path: Path) -> dict[str, Any]:
    try:
        table = load_toml(path)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; --schema names a TOML file that says what words and levels mean") from None
    if table.pop("schema", None) != _SCHEMA:
        raise InputError(f"{path}: has no line schema = '{_SCHEMA}'")
    known = {"group_by", "share", "words", "level", *_LISTS}
    unknown = sorted(set(table) - known)
    if unknown:
        raise InputError(f"{path}: unknown entry '{unknown[0]}'; known are {', '.join(sorted(known))}")
    return table


def _make_mapping(table: dict[str, Any], source: str) -> Mapping:
    group_by = str(table["group_by"])
    if group_by not in ("prefix", "kind", "document") and not group_by.startswith("attribute:"):
        raise ValueError(f"group_by is '{group_by}'; it is prefix, kind, document or attribute:NAME")
    for name in _LISTS:
        if not isinstance(table[name], list):
            raise ValueError(f"{name} is no list")
    return Mapping(
        group_by=group_by,
        lists={name: tuple(str(word) for word in table[name]) for name in _LISTS},
        shares={name: float(table["share"][name]) for name in _SHARES},
        draft=frozenset(word.lower() for word in table["words"]["draft"]),
        retired=frozenset(word.lower() for word in table["words"]["retired"]),
        levels={key: _make_level(key, row) for key, row in table["level"].items()},
        source=source,
    )


def _make_level(key: str, row: dict[str, Any]) -> Level:
    """A level of the user's table. `id` is the pattern of the ids; without a pattern, the name of the group applies."""
    flags: dict[str, Any] = {flag: bool(row.get(flag, False)) for flag in _FLAGS}
    return Level(
        key=key,
        name=str(row.get("name", key)),
        pattern=re.compile(row.get("id", "")),
        parents=tuple(row.get("parents", ())),
        also=tuple(row.get("also", ())),
        **flags,
    )
