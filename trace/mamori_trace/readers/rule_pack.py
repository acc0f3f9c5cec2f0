# SPDX-License-Identifier: Apache-2.0
"""Reads rule packs: the pack of the tool, and requirements/schema/rules.toml, which overrides single entries.

@satisfies SWR-TRC-020      Design: docs/design/trace.md#rule-packs
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import InputError
from mamori_trace.base.files import UNREADABLE
from mamori_trace.base.toml_file import load_toml
from mamori_trace.model.item import Schema
from mamori_trace.model.rule_pack import SEVERITIES, Grades, RulePack
from mamori_trace.readers.toml_rows import suggest

PACK_PATH = "requirements/schema/rules.toml"
SHIPPED = Path(__file__).parents[1] / "rules" / "default.toml"
_SCHEMA = "mamori.rules/1"
_ALL = "all"


def read_rule_pack(root: Path, schema: Schema, rules: Iterable[str]) -> RulePack:
    """The shipped pack with the entries of the project. Raises InputError, because severities are unknown then."""
    known = tuple(rules)
    pack = read_shipped_pack(schema)
    path = root / PACK_PATH
    if not os.path.lexists(path):
        return pack
    for rule, row in _read_table(path).items():
        if rule not in known:
            raise InputError(f"{path}: rule '{rule}' is not known{suggest(rule, known)}")
        if rule == UNREADABLE:
            raise InputError(f"{path}: rule '{rule}' cannot be graded: what was not read cannot be judged at any SIL")
        if not isinstance(row, dict):
            raise InputError(f"{path}: [rule.{rule}] is no table; write `all = \"error\"` or one line for each SIL")
        for key, word in row.items():
            _check_entry(f"{path}: [rule.{rule}]", key, word, schema)
        pack.grades[rule] = _make_grades(row, schema, pack.grades.get(rule, Grades()))
    return pack


def read_shipped_pack(schema: Schema) -> RulePack:
    """The pack of the tool. A SIL that the project's schema does not have is ignored."""
    grades = {rule: _make_grades(row, schema, Grades()) for rule, row in _read_table(SHIPPED).items()}
    return RulePack(grades, schema.sil)


def _read_table(path: Path) -> dict[str, Any]:
    """The rows by rule. Raises InputError."""
    table = load_toml(path)
    if table.pop("schema", None) != _SCHEMA:
        raise InputError(f"{path}: schema is not '{_SCHEMA}', which this tool reads")
    rows = table.pop("rule", {})
    if table or not isinstance(rows, dict):
        raise InputError(f"{path}: unknown entry '{next(iter(table), 'rule')}'; a pack holds tables [rule.NAME] only")
    return rows


def _check_entry(where: str, key: str, word: object, schema: Schema) -> None:
    keys = (_ALL, *schema.sil, *schema.status)
    if key not in keys:
        raise InputError(f"{where}: '{key}' is no SIL and no status; known are {', '.join(keys)}{suggest(key, keys)}")
    if word not in SEVERITIES:
        raise InputError(f"{where}: severity {word!r} is not one of {', '.join(SEVERITIES)}{suggest(str(word), SEVERITIES)}")


def _make_grades(row: dict[str, str], schema: Schema, base: Grades) -> Grades:
    """`row` over `base`; `all` applies to each SIL that the row does not specify."""
    whole = dict.fromkeys(schema.sil, row[_ALL]) if _ALL in row else {}
    of_sil = base.of_sil | whole | {key: word for key, word in row.items() if key in schema.sil}
    return Grades(of_sil, base.of_status | {key: word for key, word in row.items() if key in schema.status})
