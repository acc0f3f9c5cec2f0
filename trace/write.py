# SPDX-License-Identifier: Apache-2.0
"""Writes a file whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path


def write_whole(path: Path, text: str) -> None:
    """Writes `text` beside `path` and renames it. Raises OSError; then the old file is untouched."""
    write_whole_bytes(path, text.encode("utf-8"))


def write_whole_bytes(path: Path, data: bytes) -> None:
    """Writes `data` beside `path` and renames it. Raises OSError; then the old file is untouched."""
    if not path.name:
        raise IsADirectoryError(f"'{path}' names no file")
    if path.exists() and not path.is_file():  # the rename would put a file in the place of a device, such as /dev/stdout
        raise FileExistsError(f"{path}: is a folder or a device; name a file")
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        temporary.write_bytes(data)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
