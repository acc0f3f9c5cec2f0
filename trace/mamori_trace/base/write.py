# SPDX-License-Identifier: Apache-2.0
"""Writes files of a project atomically, with the messages of the trace tool.

@satisfies SWR-TRC-095      Design: docs/design/trace.md#files-that-are-written
"""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.system_error import explain
from mamori_trace.base.whole_file import TargetError, name_part, whole_file
from mamori_trace.base.whole_file import find_target as find_file


def write_whole(path: Path, text: str) -> None:
    """Writes `text` to a temporary file and renames it to the target of `path`. Raises InputError; the old file then stays unchanged."""
    write_whole_bytes(path, text.encode("utf-8"))


def write_whole_bytes(path: Path, data: bytes) -> None:
    """Like `write_whole`, for bytes."""
    try:
        find_target(path)
        with whole_file(path) as part:
            part.write_bytes(data)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {explain(error)}") from None


def write_folder(path: Path, files: dict[str, str]) -> None:
    """Writes `files` to a temporary folder and renames it to `path`, which must not exist. Raises InputError; then no folder remains."""
    if os.path.lexists(path):
        raise InputError(f"{path}: is there already, and a folder is never overwritten; remove it, or name another")
    part = name_part(path)
    try:
        part.mkdir(parents=True)
        for name, text in files.items():
            (part / name).parent.mkdir(parents=True, exist_ok=True)
            (part / name).write_text(text, encoding="utf-8", newline="\n")
        part.rename(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {explain(error)}") from None
    finally:
        shutil.rmtree(part, ignore_errors=True)


def find_target(path: Path) -> Path:
    """The file to write, after following links, in an existing folder. Raises InputError and OSError."""
    try:
        target = find_file(path)
    except TargetError as error:
        raise InputError(f"{path}: {error}" if path.name else str(error)) from None
    target.parent.mkdir(parents=True, exist_ok=True)
    return target
