# SPDX-License-Identifier: Apache-2.0
"""`rtc.conf`: keys and values of OpenRTM's manager and components, read as OpenRTM reads them, with every byte kept.

@satisfies SWR-PFL-001, SWR-PFL-007      Design: docs/design/profiles.md#files
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from mamori_tools.profiles.deviation import Deviation
from mamori_trace.base.errors import InputError

KEY = re.compile(r"((?:\\.|[^\\:=])*+)[:=][ \t]*+", re.DOTALL)
"""Key, sign and blanks before the value. The quantifiers do not backtrack, so the time is linear."""
BLANK_KEY = re.compile(r"((?:\\.|[^\\ \t])*+)(?:[ \t]|\Z)", re.DOTALL)
"""Key of a line without sign."""
ESCAPED = {"\\": "\\\\", "\t": "\\t", "\n": "\\n", "\f": "\\f", "\r": "\\r"}
KEY_ESCAPED = {**ESCAPED, ":": "\\:", "=": "\\=", "#": "\\#", "!": "\\!"}
LETTERS = {"t": "\t", "n": "\n", "f": "\f", "r": "\r"}
LINE_END = re.compile(r"\r?\n\Z|\Z")
MARK = "\ufeff"


@dataclass(frozen=True)
class Entry:
    """`first` and `last` are the lines of the entry, from 1."""

    key: str
    value: str
    first: int
    last: int


class ConfFile:
    """Lines that begin with # or ! are comments, also between the lines of a continuation. Of a repeated key, the last value counts."""

    def __init__(self, data: bytes) -> None:
        self._lines = re.findall(r"[^\n]*\n|[^\n]+\Z", data.decode("utf-8", "surrogateescape"))
        self.entries: list[Entry] = []
        self.deviations: list[Deviation] = []
        self._last: dict[str, Entry] = {}
        self._parse()
        try:
            data.decode("utf-8")
        except UnicodeDecodeError as error:
            line = data.count(b"\n", 0, error.start) + 1
            self.deviations.insert(0, Deviation("D23", line, f"byte 0x{data[error.start]:02x}", "bytes kept"))

    def format(self) -> bytes:
        return "".join(self._lines).encode("utf-8", "surrogateescape")

    def get_value(self, key: str) -> str | None:
        entry = self._last.get(key)
        return None if entry is None else entry.value

    def set_value(self, key: str, value: str) -> None:
        """Changes the entry that counts, or adds one at the end. @raise InputError for text that would not be read back, such as blanks at its ends."""
        lines = list(self._lines)
        self._write(key, value)
        self._parse()
        if self.get_value(key) != value:
            self._lines = lines
            self._parse()
            raise InputError(f"rtc.conf cannot hold the key {key!r} with the value {value!r}; remove blanks at the ends, or end the last line of the file")

    def _write(self, key: str, value: str) -> None:
        old = self._last.get(key)
        head, value = f"{_escape(key, KEY_ESCAPED)}: ", _escape(value, ESCAPED)
        if old is None:
            end = LINE_END.search(self._lines[0]) if self._lines else None
            line_end = end[0] if end and end[0] else "\n"
            if self._lines and not self._lines[-1].endswith("\n"):
                self._lines[-1] += line_end
            self._lines.append(f"{head}{value}{line_end}")
        else:
            line = self._lines[old.first - 1]
            match = KEY.match(line)
            end = LINE_END.search(self._lines[old.last - 1])
            self._lines[old.first - 1 : old.last] = [f"{line[: match.end()] if match else head}{value}{end[0] if end else ''}"]

    def _parse(self) -> None:
        self.entries, self.deviations, self._last = [], [], {}
        text, first = "", 0
        for number, raw in enumerate(self._lines, start=1):
            line = raw.removeprefix(MARK).strip("\r\n").lstrip(" \t") if number == 1 else raw.strip("\r\n").lstrip(" \t")
            if not line or line[0] in "#!":
                continue
            first = first or number
            if (len(line) - len(line.rstrip("\\"))) % 2:
                text += line[:-1]
                if number < len(self._lines):
                    continue
                self.deviations.append(Deviation("D24", number, "", "read without the continuation"))
            else:
                text += line
            self._add(text, first, number)
            text, first = "", 0
        if first:
            self.deviations.append(Deviation("D24", first, "", "read without the continuation"))
            self._add(text, first, len(self._lines))

    def _add(self, text: str, first: int, last: int) -> None:
        match = KEY.match(text) or BLANK_KEY.match(text)
        key = _unescape(match[1]) if match else ""
        if match is None or not key:
            self.deviations.append(Deviation("D22", first, text[:40], "line ignored"))
            return
        entry = Entry(key, _unescape(text[match.end() :]), first, last)
        if match.re is BLANK_KEY:
            self.deviations.append(Deviation("D22", first, text[:40], f"read as {key}: {entry.value}"))
        if key in self._last:
            self.deviations.append(Deviation("D21", first, key, "the last value counts"))
        self.entries.append(entry)
        self._last[key] = entry


def _unescape(text: str) -> str:
    return re.sub(r"\\(.)", lambda match: LETTERS.get(match[1], match[1]), text, flags=re.DOTALL).strip(" \t")


def _escape(text: str, letters: dict[str, str]) -> str:
    return "".join(letters.get(letter, letter) for letter in text)
