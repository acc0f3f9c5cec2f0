# SPDX-License-Identifier: Apache-2.0
"""Reads requirements/schema/items.toml."""

from __future__ import annotations

import re
from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.toml_file import load_toml
from mamori_trace.model.item import Level, Schema

_LISTS = ("attributes", "sil", "verify", "polarity", "status", "technique")
_MAYBE_LISTS = ("unfinished_words", "weak_words", "weak_word_exceptions")


def read_schema(root: Path) -> Schema:
    """The schema of the project. Raises InputError if it is missing or invalid, because no item can be checked then."""
    path = root / "requirements" / "schema" / "items.toml"
    try:
        table = load_toml(path)
        if table.get("schema") != "mamori.items/1":
            raise InputError(f"{path}: schema is {table.get('schema')!r}; this tool reads 'mamori.items/1'")
        levels = {key: _read_level(key, row) for key, row in table["level"].items()}
        for level in levels.values():
            if level.refined_by and level.refined_by not in levels:
                raise InputError(f"{path}: level {level.key}: refined_by names '{level.refined_by}', which is not a level")
        lists = {name: tuple(str(word) for word in table[name]) for name in _LISTS}
        lists |= {name: tuple(str(word) for word in table[name]) for name in _MAYBE_LISTS if name in table}
        return Schema(levels=levels, **lists)
    except FileNotFoundError:
        remedy = "`mamori trace init` in an empty folder writes one to copy"
        raise InputError(f"{path}: missing; a project keeps the words and levels of its items there; {remedy}") from None
    except KeyError as error:
        raise InputError(f"{path}: entry {error} is missing") from None
    except (re.error, TypeError, AttributeError) as error:
        raise InputError(f"{path}: {error}") from None


def _read_level(key: str, row: dict) -> Level:
    return Level(
        key=key,
        name=str(row["name"]),
        pattern=re.compile(row["id"]),
        parents=tuple(row["parents"]),
        also=tuple(row["also"]),
        shall=bool(row["shall"]),
        needs_child=bool(row["needs_child"]),
        needs_code=bool(row["needs_code"]),
        from_children=bool(row["from_children"]),
        through_children=bool(row["through_children"]),
        hazard=bool(row.get("hazard", False)),
        refined_by=str(row.get("refined_by", "")),
        integrated=bool(row.get("integrated", False)),
    )
