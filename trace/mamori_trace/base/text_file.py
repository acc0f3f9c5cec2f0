# SPDX-License-Identifier: Apache-2.0
"""Reads a text file with any content, and writes one atomically."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.whole_file import TargetError, whole_file

MAX_BYTES = 200_000_000
"""Maximum size of a file. A joint motion of ten minutes at 1 kHz is smaller."""


@dataclass(frozen=True)
class SourceText:
    """A text and its file. `sha256` is the hash of the bytes of the file."""

    path: Path
    text: str
    sha256: str


def read_text(path: Path | str, what: str, max_bytes: int = MAX_BYTES) -> SourceText:
    """Reads `path` as UTF-8 text; `what` names the kind of file in messages, for example "motion file".

    Raises InputError: missing, not a regular file, empty, larger than `max_bytes`, unreadable, binary, not UTF-8.
    """
    path = Path(path)
    try:
        if path.is_dir():
            raise InputError(f"is a directory; name the {what} itself", path)
        if not path.exists():
            raise InputError(f"{what} not found; check the path", path)
        if not path.is_file():
            raise InputError(f"is no regular file; name a {what}", path)
        size = path.stat().st_size
        if size == 0:
            raise InputError(f"{what} is empty; write it again", path)
        if size > max_bytes:
            raise InputError(f"{what} has {size} bytes, at most {max_bytes} are read; cut it into parts", path)
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"{what} cannot be read: {error.strerror}; check its permissions", path) from error
    zero = data.find(b"\0")
    if zero >= 0:
        raise InputError(f"byte 0 in the text; this is a binary file, not a {what}", path, _line_at(data, zero))
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"byte 0x{data[error.start]:02x} is not UTF-8; save the {what} as UTF-8 text",
                         path, _line_at(data, error.start)) from error
    if not text.strip():
        raise InputError(f"{what} holds only white space; write it again", path)
    return SourceText(path, text, hashlib.sha256(data).hexdigest())


def write_text(path: Path | str, text: str) -> None:
    """Writes `text` to a temporary file in the folder of `path`, then renames it.

    Raises InputError if the folder is missing or not writable; then no file remains.
    """
    try:
        with whole_file(Path(path)) as part:
            part.write_text(text, encoding="utf-8", newline="\n")
    except OSError as error:
        raise refuse_output(path, error) from error


def refuse_output(path: Path | str, error: OSError) -> InputError:
    """The error for a `path` that cannot be written."""
    if isinstance(error, TargetError):
        return InputError(f"cannot be written: {error}", path)
    return InputError(f"cannot be written: {error.strerror}; check the folder, its permissions and the room on its disk", path)


def _line_at(data: bytes, offset: int) -> int:
    return data.count(b"\n", 0, offset) + 1
