# SPDX-License-Identifier: Apache-2.0
"""Reads the file of a flight recorder: every valid record, and a finding for all other content.

docs/design/recorder.md#region describes the format; kernel/include/mamori/kernel/record/flight_format.hpp writes it.

A file of the real-time port ends with a crash record, written by ports/posix_rt/src/crash_note.cpp.

@satisfies SWR-REC-011, SWR-REC-013, SWR-PRT-028      Design: docs/design/recorder.md#the-command-log
"""

from __future__ import annotations

import signal
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from mamori_trace.base.errors import InputError

MAGIC = b"\x89MREC\r\n\x1a"
VERSION = 2
HEADER = struct.Struct("<8sHHHHII")
HEADER_BYTES = 64
SESSION = struct.Struct("<QII")
SESSION_OFFSETS = (24, 40)
RECORD = struct.Struct("<QqqIHHBHBI")
RECORD_CRC_BYTES = 35
COMMIT_OFFSET = 35
COMMITTED = 0xC3
CRASH_NOTE = struct.Struct("<qQIHHBBI")
CRASH_NOTE_CRC_BYTES = 26
NO_PLACE = 0xFFFF
WATCHDOG = 0xFFFE
SEQUENCE_MAX = 1 << 62
SEVERITIES = ("info", "warning", "fault")
MAX_BYTES = 1 << 30
"""Maximum file size: 26 million records."""


@dataclass(frozen=True)
class Record:
    """One record, and its location in the file."""

    sequence: int
    session: int
    time_ns: int
    severity: str
    source: int
    code: int
    argument: int
    offset: int


@dataclass(frozen=True)
class Finding:
    """A defect of the recording. `place` is its number in the order of records."""

    kind: str  # torn, corrupt, missing, stale, header, cut, trailing
    place: int
    offset: int
    text: str


@dataclass(frozen=True)
class Crash:
    """The last crash in the file; `window` and `component` are indices in the system table."""

    session: int
    time_ns: int
    signal: str
    is_sent: bool
    """True for kill, raise or abort; otherwise an instruction failed."""
    address: int
    window: int | None
    component: int | None
    is_watchdog: bool
    offset: int


@dataclass(frozen=True)
class Recording:
    """Content of a file. `records` and `findings` are ordered by number."""

    path: Path
    capacity: int
    session: int
    records: tuple[Record, ...]
    findings: tuple[Finding, ...]
    crash: Crash | None = None

    @property
    def overwritten(self) -> int | None:
        """Records of earlier laps of the ring; None if the newest record or the size of the ring is unknown."""
        if self.count("cut") or self.count("header"):
            return None
        return max(0, self.records[-1].sequence - self.capacity) if self.records else 0

    def count(self, kind: str) -> int:
        return sum(finding.kind == kind for finding in self.findings)


@dataclass
class _Ring:
    """Slots in the file: the first `slot_count` of a ring of `capacity`, because the file may be truncated."""

    capacity: int
    slot_count: int
    records: list[Record] = field(default_factory=list)
    damaged: list[tuple[int, str]] = field(default_factory=list)  # slot, kind


def read_recording(path: Path) -> Recording:
    """Reads `path`, which may be in use. Raises InputError if it cannot contain records."""
    data = _read_bytes(path)
    findings: list[Finding] = []
    problem = _check_header(path, data)
    capacity = max(0, len(data) - HEADER_BYTES) // RECORD.size
    if problem:
        findings.append(Finding("header", 0, 0, f"{problem}; read as format version {VERSION}"))
    else:
        capacity = HEADER.unpack_from(data)[5]
        findings.extend(_check_length(data, capacity))
    # If the header is invalid, locations of records are not checked, because the capacity may be wrong.
    ring = _read_slots(data, capacity, is_place_known=not problem)
    if problem and not ring.records:
        raise InputError(f"is no recorder file ({problem}); name the file that a flight recorder wrote", path)
    ring.records.sort(key=lambda record: record.sequence)
    if ring.records and not problem:
        findings.extend(_find_missing(ring))
    else:
        findings.extend(_describe_damage(kind, slot, 0, "") for slot, kind in ring.damaged)
    findings.sort(key=lambda finding: (finding.place, finding.offset))
    session = max([_read_session(data), *(record.session for record in ring.records)])
    return Recording(path, capacity, session, tuple(ring.records), tuple(findings), _read_crash(data, capacity))


def _read_bytes(path: Path) -> bytes:
    try:
        if path.is_dir():
            raise InputError("is a directory; name the recorder file itself", path)
        if not path.exists():
            raise InputError("recorder file not found; check the path", path)
        if not path.is_file():
            raise InputError("is no regular file; name a recorder file", path)
        size = path.stat().st_size
        if size > MAX_BYTES:
            raise InputError(f"has {size} bytes, at most {MAX_BYTES} are read; this is no file of a flight recorder", path)
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"recorder file cannot be read: {error.strerror}; check path and permissions", path) from error
    if not data:
        raise InputError("recorder file is empty; was the program that records ever started?", path)
    if not any(data):
        raise InputError("holds zeros only: space was made for a recorder that never began; start the program again", path)
    return data


def _check_header(path: Path, data: bytes) -> str:
    """@return the defect of the header; empty if it is valid."""
    if data[: len(MAGIC)] != MAGIC:
        return "it does not begin as one"
    if len(data) < HEADER_BYTES:
        raise InputError(f"recorder file is cut in its header, after {len(data)} bytes; copy it again from where it was written",
                         path)
    _, version, header_size, record_size, _, capacity, crc = HEADER.unpack_from(data)
    if version != VERSION:
        raise InputError(f"is of format version {version}, this release reads {VERSION}; "
                         "use `mamori log` of the release that wrote it", path)
    if crc != zlib.crc32(data[: HEADER.size - 4]) or (header_size, record_size) != (HEADER_BYTES, RECORD.size) or not capacity:
        return "its header is damaged"
    return ""


def _check_length(data: bytes, capacity: int) -> Iterator[Finding]:
    length = len(data)
    wanted = HEADER_BYTES + capacity * RECORD.size
    if length < wanted:
        whole = (length - HEADER_BYTES) // RECORD.size
        yield Finding("cut", SEQUENCE_MAX + 1, length,
                      f"the file ends here, at {length} of {wanted} bytes: {capacity - whole} of {capacity} slots are cut off; "
                      "the records there may be older or newer than those shown")
    elif length == wanted + CRASH_NOTE.size:
        if any(data[wanted:]) and _read_crash(data, capacity) is None:
            yield Finding("corrupt", SEQUENCE_MAX + 1, wanted, "note of a crash: its bytes are not what was written, or not all of it")
    elif length > wanted:
        yield Finding("trailing", SEQUENCE_MAX + 1, wanted, f"{length - wanted} bytes behind the end of the recorder")


def _read_crash(data: bytes, capacity: int) -> Crash | None:
    """The record after the last slot; None if it is missing or incomplete."""
    offset = _offset_of(capacity)
    if len(data) != offset + CRASH_NOTE.size:
        return None
    time_ns, address, session, window, component, number, is_sent, crc = CRASH_NOTE.unpack_from(data, offset)
    if crc != zlib.crc32(data[offset : offset + CRASH_NOTE_CRC_BYTES]) or not number or is_sent > 1:
        return None
    try:
        name = signal.Signals(number).name
    except ValueError:
        name = f"signal {number}"
    return Crash(session, time_ns, name, bool(is_sent), address, None if window == NO_PLACE else window,
                 None if component in (NO_PLACE, WATCHDOG) else component, component == WATCHDOG, offset)


def _read_slots(data: bytes, capacity: int, is_place_known: bool) -> _Ring:
    ring = _Ring(capacity, min(capacity, (len(data) - HEADER_BYTES) // RECORD.size))
    blank = bytes(RECORD.size)
    for slot in range(ring.slot_count):
        offset = _offset_of(slot)
        raw = data[offset : offset + RECORD.size]
        if raw == blank:
            continue
        sequence, time_ns, argument, session, source, code, severity, _, commit, crc = RECORD.unpack(raw)
        if commit == 0:
            ring.damaged.append((slot, "torn"))
        elif (commit != COMMITTED or crc != zlib.crc32(raw[:RECORD_CRC_BYTES]) or not 1 <= sequence <= SEQUENCE_MAX
              or severity >= len(SEVERITIES) or (is_place_known and (sequence - 1) % capacity != slot)):
            ring.damaged.append((slot, "corrupt"))
        else:
            ring.records.append(Record(sequence, session, time_ns, SEVERITIES[severity], source, code, argument, offset))
    return ring


def _find_missing(ring: _Ring) -> Iterator[Finding]:
    """Findings of the ring: each slot in the file must contain its number of the latest lap."""
    capacity = ring.capacity
    newest = ring.records[-1].sequence
    first = max(1, newest - capacity + 1)
    have = {record.sequence for record in ring.records}
    explained = set()
    for slot, kind in ring.damaged:
        # The slot after the newest record contained the oldest one, and may have been about to be overwritten.
        number = newest + 1 - (newest - slot) % capacity
        number += capacity if number < 1 else 0
        before = number - capacity if number > newest else 0
        explained |= {number, before}
        # If the newest record may be truncated, the number is only a position for the output.
        is_known = ring.slot_count == capacity
        yield _describe_damage(kind, slot, number, f"record {number}{f' or {before}' if before > 0 else ''}, " if is_known else "")
    for record in ring.records:
        if record.sequence < first:
            yield Finding("stale", record.sequence, record.offset,
                          f"record {record.sequence} is of an earlier turn of the ring; the one that replaced it did not arrive")
    before = first - 1
    for number in sorted(number for number in have | explained if first <= number <= newest):
        yield from _describe_gap(before + 1, number - 1, ring)
        before = number


def _describe_damage(kind: str, slot: int, number: int, what: str) -> Finding:
    why = "the writer ended in mid-write" if kind == "torn" else "its bytes are not what was written"
    return Finding(kind, number, _offset_of(slot), f"{what}slot {slot}: {why}")


def _describe_gap(first: int, last: int, ring: _Ring) -> Iterator[Finding]:
    """Numbers `first` to `last` (less than a lap) whose slots are in the file; the content of other slots is unknown."""
    for turn in range((first - 1) // ring.capacity, (last - 1) // ring.capacity + 1):
        begin = max(first, turn * ring.capacity + 1)
        end = min(last, turn * ring.capacity + ring.slot_count)
        if begin <= end:
            numbers = f"record {begin} is" if begin == end else f"records {begin} to {end} are"
            yield Finding("missing", begin, _offset_of((begin - 1) % ring.capacity), f"{numbers} missing")


def _read_session(data: bytes) -> int:
    newest = 0
    for offset in SESSION_OFFSETS:
        if len(data) >= offset + SESSION.size:
            _, number, crc = SESSION.unpack_from(data, offset)
            if crc == zlib.crc32(data[offset : offset + SESSION.size - 4]):
                newest = max(newest, number)
    return newest


def _offset_of(slot: int) -> int:
    return HEADER_BYTES + slot * RECORD.size
