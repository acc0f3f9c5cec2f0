# SPDX-License-Identifier: Apache-2.0
"""Writes a file whole or not at all. A link stays what it is; what it leads to is replaced, as an editor does it.

@satisfies SWR-TRC-095      Design: docs/design/trace.md#files-that-are-written
"""

from __future__ import annotations

import contextlib
import os
import shutil
from pathlib import Path

from mamori.trace.readers.files import InputError
from mamori.trace.system_error import explain


def write_whole(path: Path, text: str) -> None:
    """Writes `text` beside the file that `path` leads to, and renames it. Raises InputError; then the old file is untouched."""
    write_whole_bytes(path, text.encode("utf-8"))


def write_whole_bytes(path: Path, data: bytes) -> None:
    """The same for bytes."""
    try:
        target = find_target(path)
        temporary = name_part(target)
        try:
            temporary.write_bytes(data)
            if target.exists():
                shutil.copymode(target, temporary)
            temporary.replace(target)
        finally:
            with contextlib.suppress(OSError):
                temporary.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {explain(error)}") from None


def write_folder(path: Path, files: dict[str, str]) -> None:
    """Writes `files` beside `path`, which must not be there yet, and renames the folder. Raises InputError; then nothing is there."""
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
    """The file that is to be written, links followed, in a folder that is there. Raises InputError, and OSError."""
    if not path.name:
        raise InputError(f"'{path}' names no file")
    target = Path(os.path.realpath(path))
    if target.is_symlink():
        raise InputError(f"{path}: is a loop of links; mend the link")
    if target.exists() and not target.is_file():  # the rename would put a file in the place of a device, such as /dev/stdout
        raise InputError(f"{path}: is a folder or a device; name a file")
    if path.is_symlink() and not target.parent.is_dir():
        raise InputError(f"{path}: leads to {target}, and there is no such folder; mend the link")
    target.parent.mkdir(parents=True, exist_ok=True)
    return target


def name_part(target: Path) -> Path:
    """A name beside `target` for what is not whole yet."""
    return target.with_name(f".{target.name}.{os.getpid()}.part")
