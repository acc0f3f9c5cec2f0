# SPDX-License-Identifier: Apache-2.0
"""A strict reader of the plain tar archives that `mamori trace bundle` writes. It accepts only regular files with short headers.

The reader of the standard library loads extended headers of any size into memory, and accepts links, devices and sparse files. External
archives must not be able to use these features. This reader writes nothing to disk.

@satisfies SWR-TRC-076      Design: docs/design/trace.md#verify
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import BinaryIO

from mamori_trace.base.errors import FormatError

BLOCK = 512
MAX_MEMBERS = 200_000
_CHUNK = 1 << 16
_KINDS = {b"1": "a hard link", b"2": "a symbolic link", b"3": "a device", b"4": "a device", b"5": "a folder", b"6": "a pipe"}


def read_members(file: BinaryIO) -> Iterator[tuple[str, int, Iterator[bytes]]]:
    """(name, size, chunks) of each member in order. The caller consumes the chunks before the next member. Raises FormatError."""
    seen: set[str] = set()
    while True:
        head = _read_block(file)
        if not any(head):
            _demand_end(file)
            return
        name, size = _parse_head(head)
        if name in seen:
            raise FormatError(f"member {name!r} occurs twice")
        if len(seen) >= MAX_MEMBERS:
            raise FormatError(f"more than {MAX_MEMBERS} members")
        seen.add(name)
        yield name, size, _read_chunks(file, name, size)


def _read_block(file: BinaryIO) -> bytes:
    block = file.read(BLOCK)
    if len(block) != BLOCK:
        raise FormatError("the archive is cut off")
    return block


def _demand_end(file: BinaryIO) -> None:
    while chunk := file.read(_CHUNK):
        if any(chunk):
            raise FormatError("data after the end of the archive")


def _parse_head(head: bytes) -> tuple[str, int]:
    total = sum(head) - sum(head[148:156]) + 8 * ord(" ")
    if head[257:262] != b"ustar" or _parse_octal(head[148:156]) != total:
        raise FormatError("no tar archive, or a header is damaged")
    prefix, name = (part.partition(b"\0")[0] for part in (head[345:500], head[0:100]))
    path = (prefix + b"/" + name if prefix else name).decode("utf-8", errors="backslashreplace")
    kind = head[156:157]
    if kind not in (b"0", b"\0"):
        raise FormatError(f"member {path!r} is {_KINDS.get(kind, 'of a kind that no bundle holds')}")
    if path.startswith("/") or ".." in path.split("/"):
        raise FormatError(f"member {path!r} leaves the bundle")
    return path, _parse_octal(head[124:136])


def _parse_octal(text: bytes) -> int:
    digits = text.strip(b" \0")
    if not digits or any(digit not in b"01234567" for digit in digits):
        raise FormatError("a number in a header is damaged")
    return int(digits, 8)


def _read_chunks(file: BinaryIO, name: str, size: int) -> Iterator[bytes]:
    left = size
    while left:
        chunk = file.read(min(left, _CHUNK))
        if not chunk:
            raise FormatError(f"the archive is cut off in member {name!r}")
        left -= len(chunk)
        yield chunk
    rest = -size % BLOCK
    padding = file.read(rest) if rest else b""
    if len(padding) != rest or any(padding):
        raise FormatError(f"the archive is cut off or damaged behind member {name!r}")
