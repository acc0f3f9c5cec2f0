# SPDX-License-Identifier: Apache-2.0
"""Reads the log of an LCM network, as lcm-logger writes it.

@satisfies SWR-REC-016      Design: docs/design/recorder.md#lcm-logs
Source: LCM documentation, "LCM Log File format"
"""

from __future__ import annotations

import mmap
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import InputError

SYNC = (0xEDA1DA01).to_bytes(4, "big")
HEADER = struct.Struct(">4sQqII")
"""Sync word, number, time [us], lengths of channel and message."""
NUMBER_END, NUMBER_MAX = 12, 2**64 - 1
CHANNEL_BYTES_MAX = 63


@dataclass(frozen=True)
class Event:
    offset: int
    number: int
    time_us: int
    channel: str
    data: bytes


@dataclass(frozen=True)
class Damage:
    """Bytes from `offset` on that are not an event."""

    offset: int
    size: int
    text: str


def is_lcm_log(path: Path) -> bool:
    """Whether a regular file begins with an event. False for a path that cannot be read."""
    try:
        if not path.is_file():
            return False
        with path.open("rb") as stream:
            return stream.read(len(SYNC)) == SYNC
    except OSError:
        return False


class LcmLog:
    """The events that were complete when the log was opened. `lcm-logger` may still write to the file."""

    def __init__(self, data: mmap.mmap) -> None:
        self._data = data

    def read(self) -> Iterator[Event | Damage]:
        """In the order of the file. Each damaged part appears once; reading continues with the next intact event."""
        position, end = 0, len(self._data)
        while position < end:
            event = self._read_event(position)
            if isinstance(event, Event):
                position += HEADER.size + len(event.channel) + len(event.data)
                yield event
                continue
            begin = position
            while position < end and not isinstance(self._read_event(position), Event):
                found = self._data.find(SYNC, position + 1)
                position = end if found < 0 else found
            yield Damage(begin, position - begin, event)

    def _read_event(self, offset: int) -> Event | str:
        """@return the event, or why there is none. The end of the file or the begin of the next event must follow it: its sync word, or its
        number, because one of both can be damaged."""
        end = len(self._data)
        if self._data[offset : offset + len(SYNC)] != SYNC[: end - offset]:
            return "no event begins here"
        if offset + HEADER.size > end:
            return "the log ends within the header of an event"
        _, number, time_us, name_size, size = HEADER.unpack_from(self._data, offset)
        begin = offset + HEADER.size
        after = begin + name_size + size
        name = self._data[begin : begin + min(name_size, CHANNEL_BYTES_MAX)]
        if not 1 <= name_size <= CHANNEL_BYTES_MAX or not name.isascii():
            return "the channel name of the event is invalid"
        if after > end:
            return "the log ends within an event"
        is_followed = self._data[after : after + len(SYNC)] == SYNC[: end - after]
        if not is_followed and self._data[after + len(SYNC) : after + NUMBER_END] != (number + 1 & NUMBER_MAX).to_bytes(8, "big"):
            return "no event follows this event"
        return Event(offset, number, time_us, name.decode("ascii"), self._data[begin + name_size : after])


@contextmanager
def open_log(path: Path) -> Iterator[LcmLog]:
    """@raise InputError if the file cannot be read or is empty."""
    try:
        with path.open("rb") as stream, mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as data:
            yield LcmLog(data)
    except ValueError as error:
        raise InputError("is empty; specify the log that lcm-logger wrote", path) from error
