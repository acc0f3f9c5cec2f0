# SPDX-License-Identifier: Apache-2.0
"""Names for the numbers of a recorder: a table in JSON, YAML or TOML (docs/design/recorder.md#the-command-log).

@satisfies SWR-REC-011      Design: docs/design/recorder.md#the-command-log
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from mamori_tools.log.region import Record
from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names
from mamori_trace.base.text_file import read_text

MAX_BYTES = 4_000_000
READERS: Mapping[str, Callable[[str], object]] = {
    ".json": json.loads, ".yaml": yaml.safe_load, ".yml": yaml.safe_load, ".toml": tomllib.loads,
}  # fmt: skip


@dataclass(frozen=True)
class Names:
    """Names of sources, codes and arguments; numbers without a name are shown as numbers."""

    sources: Mapping[int, str] = field(default_factory=dict)
    codes: Mapping[int, str] = field(default_factory=dict)
    argument_tables: Mapping[int, str] = field(default_factory=dict)  # code -> table
    arguments: Mapping[str, Mapping[int, str]] = field(default_factory=dict)  # table -> names

    def source(self, record: Record) -> str:
        return self.sources.get(record.source, str(record.source))

    def code(self, record: Record) -> str:
        return self.codes.get(record.code, str(record.code))

    def argument(self, record: Record) -> str:
        table = self.arguments.get(self.argument_tables.get(record.code, ""), {})
        return table.get(record.argument, str(record.argument))


def default_names_path(path: Path) -> Path:
    """Default path of the names, next to the recorder file `path`."""
    return path.with_name(f"{path.name}.names.json")


def read_names(path: Path) -> Names:
    """Raises InputError with the location for an invalid table of names."""
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(f"a name table ends in {', '.join(READERS)}; name one of these", path)
    text = read_text(path, "name table", MAX_BYTES).text
    try:
        table = reader(text)
    except (ValueError, yaml.YAMLError, RecursionError) as error:
        raise InputError(f"is no {path.suffix[1:]} text: {error}", path) from error
    top = _mapping(path, "the table", table)
    for key in top:
        if key not in ("sources", "codes", "arguments"):
            raise InputError(f"there is no '{key}' in a name table; {nearest_names(str(key), ('sources', 'codes', 'arguments'))}",
                             path)
    arguments = {str(name): _names(path, f"arguments.{name}", values)
                 for name, values in _mapping(path, "arguments", top.get("arguments", {})).items()}
    codes, tables = {}, {}
    for key, value in _mapping(path, "codes", top.get("codes", {})).items():
        code, place = _number(path, "codes", key), f"codes.{key}"
        if isinstance(value, dict):
            tables[code] = _text(path, f"{place}.argument", value.get("argument", ""))
            if tables[code] and tables[code] not in arguments:
                raise InputError(f"{place}: there are no arguments '{tables[code]}'; {nearest_names(tables[code], arguments)}", path)
            value = value.get("name")
        codes[code] = _text(path, place, value)
    return Names(_names(path, "sources", top.get("sources", {})), codes, tables, arguments)


def _mapping(path: Path, place: str, value: object) -> dict:
    if not isinstance(value, dict):
        raise InputError(f"{place} must be a table of numbers and names", path)
    return value


def _names(path: Path, place: str, value: object) -> dict[int, str]:
    return {_number(path, place, key): _text(path, f"{place}.{key}", text) for key, text in _mapping(path, place, value).items()}


def _number(path: Path, place: str, key: object) -> int:
    try:
        return int(str(key), 10)
    except ValueError as error:
        raise InputError(f"{place}: '{key}' is not an integer", path) from error


def _text(path: Path, place: str, value: object) -> str:
    if not isinstance(value, str) or not value.isprintable():
        raise InputError(f"{place} must be a printable name", path)
    return value
