# SPDX-License-Identifier: Apache-2.0
"""`rtc.conf`: keys and values of OpenRTM's manager and components, read as OpenRTM reads them, with every byte kept.

@satisfies SWR-PFL-001, SWR-PFL-007      Design: docs/design/profiles.md#files
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from mamori_tools.profiles.deviation import Deviation

KEY = re.compile(r"((?:\\.|[^\\:=])*+)[:=][ \t]*+", re.DOTALL)
"""Key, sign and blanks before the value. The quantifiers do not backtrack, so the time is linear."""
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
        self._parse()
        try:
            data.decode("utf-8")
        except UnicodeDecodeError as error:
            line = data.count(b"\n", 0, error.start) + 1
            self.deviations.insert(0, Deviation("D23", line, f"byte 0x{data[error.start]:02x}", "bytes kept"))

    def format(self) -> bytes:
        return "".join(self._lines).encode("utf-8", "surrogateescape")

    def get_value(self, key: str) -> str | None:
        return next((entry.value for entry in reversed(self.entries) if entry.key == key), None)

    def set_value(self, key: str, value: str) -> None:
        """Changes the entry that counts, or adds one at the end. @param value one line."""
        old = next((entry for entry in reversed(self.entries) if entry.key == key), None)
        if old is None:
            end = LINE_END.search(self._lines[0]) if self._lines else None
            line_end = end[0] if end and end[0] else "\n"
            if self._lines and not self._lines[-1].endswith("\n"):
                self._lines[-1] += line_end
            self._lines.append(f"{key}: {value}{line_end}")
        else:
            line = self._lines[old.first - 1]
            match = KEY.match(line)
            end = LINE_END.search(self._lines[old.last - 1])
            assert match is not None and end is not None
            self._lines[old.first - 1 : old.last] = [f"{line[: match.end()]}{value}{end[0]}"]
        self._parse()

    def _parse(self) -> None:
        self.entries, self.deviations = [], []
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
        match = KEY.match(text)
        if match is None or not match[1].strip():
            self.deviations.append(Deviation("D22", first, text[:40], "line ignored"))
            return
        key = re.sub(r"\\(.)", r"\1", match[1].strip(" \t"))
        if any(entry.key == key for entry in self.entries):
            self.deviations.append(Deviation("D21", first, key, "the last value counts"))
        self.entries.append(Entry(key, text[match.end() :].rstrip(" \t"), first, last))

