# SPDX-License-Identifier: Apache-2.0
"""Writes `records.json`: the hash of each evidence file and of its inputs (docs/design/trace.md#evidence-files).

@satisfies SWR-TRC-036, SWR-TRC-103      Design: docs/design/trace.md#records
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from mamori_trace.base.write import write_whole
from mamori_trace.readers.evidence_records import FOLDERS, NAME, SCHEMA, hash_file

Rows = dict[str, dict[str, Any]]


def hash_text(text: str) -> str:
    """SHA-256 of a text."""
    return hashlib.sha256(text.encode(errors="surrogateescape")).hexdigest()


def read_rows(folder: Path) -> Rows:
    """Rows of the records of an evidence folder; empty if there is no complete file."""
    if not (folder / NAME).is_file():  # reading a pipe would never end
        return {}
    try:
        rows = json.loads((folder / NAME).read_text(encoding="utf-8"))["files"]
        return rows if isinstance(rows, dict) else {}
    except (OSError, ValueError, KeyError, TypeError):
        return {}


def make_rows(folder: Path, files: Iterable[Path], inputs: dict[str, str], find_program: Callable[[Path], Path | None]) -> Rows:
    """One row for each file. `find_program` returns the program that wrote the file, if known. Raises OSError."""
    rows: Rows = {}
    for path in files:
        program = find_program(path)
        binary = hash_file(program) if program is not None else None
        rows[path.relative_to(folder).as_posix()] = {"sha256": hash_file(path), **inputs, "binary": binary}
    return rows


def write_rows(folder: Path, rows: Rows, source_folders: Sequence[str] = ()) -> None:
    """Writes the file atomically. Raises InputError."""
    content: dict[str, Any] = {"schema": SCHEMA, "files": {name: rows[name] for name in sorted(rows)}}
    if source_folders:
        content[FOLDERS] = list(source_folders)
    write_whole(folder / NAME, json.dumps(content, indent=1) + "\n")
