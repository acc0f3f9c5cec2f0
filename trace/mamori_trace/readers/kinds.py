# SPDX-License-Identifier: Apache-2.0
"""Reads requirements/schema/links.toml and compares it with the levels of items.toml.

@satisfies SWR-TRC-028      Design: docs/design/trace.md#kinds-and-links
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mamori_trace.base.errors import InputError
from mamori_trace.base.toml_file import load_toml
from mamori_trace.model.item import Schema
from mamori_trace.model.kinds import Kind, KindSchema, LinkKind
from mamori_trace.readers.toml_rows import suggest

KINDS_PATH = "requirements/schema/links.toml"
_SCHEMA = "mamori.links/1"
_KIND_KEYS = ("name", "levels", "required")
_LINK_KEYS = ("from", "to", "written")


def read_kinds(root: Path, schema: Schema) -> KindSchema:
    """The kinds and links; an empty schema if the project has none. Raises InputError, because links cannot be checked then."""
    path = root / KINDS_PATH
    try:
        table = load_toml(path)
    except FileNotFoundError:
        return KindSchema()
    try:
        return _make(table, schema)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _make(table: dict[str, Any], schema: Schema) -> KindSchema:
    if table.get("schema") != _SCHEMA:
        raise InputError(f"schema is {table.get('schema')!r}; this tool reads '{_SCHEMA}'")
    _refuse_unknown("", [key for key in table if key != "schema"], ("kind", "link"))
    kinds = {key: _make_kind(key, row, schema) for key, row in _get_rows(table, "kind").items()}
    links = {key: _make_link(key, row, tuple(kinds)) for key, row in _get_rows(table, "link").items()}
    for level in schema.levels:
        owners = [kind.key for kind in kinds.values() if level in kind.levels]
        if len(owners) != 1:
            raise InputError(f"level {level} of items.toml is of {'no kind' if not owners else 'the kinds ' + ', '.join(owners)}; it has one")
    return KindSchema(kinds, links)


def _make_kind(key: str, row: dict[str, Any], schema: Schema) -> Kind:
    where = f"[kind.{key}]"
    _refuse_unknown(where, row, _KIND_KEYS)
    levels, required = _get_words(where, row, "levels"), _get_words(where, row, "required")
    _refuse_unknown(f"{where} levels", levels, tuple(schema.levels))
    _refuse_unknown(f"{where} required", required, schema.attributes)
    return Kind(key, str(row.get("name", key)), levels, required)


def _make_link(key: str, row: dict[str, Any], kinds: tuple[str, ...]) -> LinkKind:
    where = f"[link.{key}]"
    _refuse_unknown(where, row, _LINK_KEYS)
    sources, targets = _get_words(where, row, "from"), _get_words(where, row, "to")
    _refuse_unknown(f"{where} from", sources, kinds)
    _refuse_unknown(f"{where} to", targets, kinds)
    if not sources or not targets:
        raise InputError(f"{where} says no {'from' if not sources else 'to'}")
    return LinkKind(key, sources, targets, str(row.get("written", "")))


def _get_rows(table: dict[str, Any], name: str) -> dict[str, dict[str, Any]]:
    rows = table.get(name, {})
    if not isinstance(rows, dict) or not all(isinstance(row, dict) for row in rows.values()):
        raise InputError(f"'{name}' holds no tables [{name}.NAME]")
    return rows


def _get_words(where: str, row: dict[str, Any], key: str) -> tuple[str, ...]:
    words = row.get(key, [])
    if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
        raise InputError(f"{where} {key} is no list of words")
    return tuple(words)


def _refuse_unknown(where: str, words: Any, known: tuple[str, ...]) -> None:
    for word in words:
        if word not in known:
            raise InputError(f"{where} '{word}' is not one of {', '.join(known)}{suggest(word, known)}".strip())
