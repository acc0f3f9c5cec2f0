# SPDX-License-Identifier: Apache-2.0
"""Handwritten recorder files, independent of the code that writes and reads such files."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from pathlib import Path

HEADER_BYTES = 64
RECORD_BYTES = 40


def make_header(capacity: int, version: int = 2, session: int = 1) -> bytes:
    fixed = b"\x89MREC\r\n\x1a" + struct.pack("<HHHHI", version, HEADER_BYTES, RECORD_BYTES, 0, capacity)
    cell = struct.pack("<QI", 1, session)
    cells = [bytes(16), bytes(16)]
    cells[session % 2] = cell + struct.pack("<I", zlib.crc32(cell))
    return fixed + struct.pack("<I", zlib.crc32(fixed)) + b"".join(cells) + bytes(8)


def make_record(sequence: int, session: int = 1, severity: int = 0, source: int = 0, code: int = 0, argument: int = 0,
                time_ns: int | None = None, commit: int = 0xC3) -> bytes:  # fmt: skip
    """A record at `sequence` milliseconds."""
    time_ns = sequence * 1_000_000 if time_ns is None else time_ns
    covered = struct.pack("<QqqIHHBH", sequence, time_ns, argument, session, source, code, severity, 0)
    return covered + bytes([commit]) + struct.pack("<I", zlib.crc32(covered))


def make_file(capacity: int, records: Sequence[bytes], **header: int) -> bytes:
    """A file with `records` in the slots of their numbers; the other slots were never written."""
    slots = [bytes(RECORD_BYTES)] * capacity
    for record in records:
        slots[(struct.unpack_from("<Q", record)[0] - 1) % capacity] = record
    return make_header(capacity, **header) + b"".join(slots)


def make_crash(session: int = 1, number: int = 11, is_sent: int = 0, address: int = 0, window: int = 0xFFFF,
               component: int = 0xFFFF, time_ns: int = 0) -> bytes:  # fmt: skip
    """The bytes after the last slot of a file of the real-time port."""
    covered = struct.pack("<qQIHHBB", time_ns, address, session, window, component, number, is_sent)
    return covered + struct.pack("<I", zlib.crc32(covered))


def write(path: Path, data: bytes) -> Path:
    path.write_bytes(data)
    return path
