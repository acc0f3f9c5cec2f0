# SPDX-License-Identifier: Apache-2.0
"""Reads requirements/schema/code.toml: the rules of a project for its code.

@satisfies SWR-TRC-031      Design: docs/design/trace.md#traced-layers
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.toml_file import load_toml
from mamori_trace.model.code import CodeSchema

_LISTS = ("traced", "no_evidence", "integration")


def read_code_schema(root: Path) -> CodeSchema:
    """The rules of the file; none without the file. Raises InputError for an invalid file."""
    path = root / "requirements" / "schema" / "code.toml"
    try:
        table = load_toml(path)
    except FileNotFoundError:
        return CodeSchema()
    if table.pop("schema", None) != "mamori.code/1":
        raise InputError(f"{path}: the schema is not 'mamori.code/1', which this tool reads")
    lists = {name: _take_list(path, name, value) for name, value in table.items()}
    absent = [name for name in lists.get("traced", ()) if not (root / name).exists()]
    if absent:
        raise InputError(f"{path}: traced names {absent[0]}, which does not exist; name a folder or file of this project")
    return CodeSchema(**lists)


def _take_list(path: Path, name: str, value: object) -> tuple[str, ...]:
    if name not in _LISTS:
        raise InputError(f"{path}: entry '{name}' is not one of {', '.join(_LISTS)}")
    if not isinstance(value, list) or not all(isinstance(one, str) and one.strip("/") for one in value):
        raise InputError(f"{path}: {name} is no list of paths in this project")
    return tuple(one.strip("/") for one in value)
