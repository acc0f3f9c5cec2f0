# SPDX-License-Identifier: Apache-2.0
"""Whitespace table: each line contains one sample, first the time [s], then the joint positions [rad]; `#` begins a comment."""

from __future__ import annotations

from decimal import Decimal

from mamori_tools.motion.motion import MAX_SAMPLES, Samples
from mamori_tools.motion.number_text import parse_number
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import SourceText


def read_table(source: SourceText, joints: int, ignored_columns: int) -> Samples:
    """Reads a table of `joints` positions per line, or of `joints + ignored_columns`, whose last columns are ignored.

    Times are shifted to start at 0, in exact decimal arithmetic, so that 0.003 - 0.001 stays 0.002.
    Raises InputError: wrong or changing number of columns, not a finite number, too many lines.
    """
    samples = Samples(source.path, source.sha256)
    allowed = {joints, joints + ignored_columns}
    columns = 0
    first_time = Decimal(0)
    for line, text in enumerate(source.text.split("\n"), start=1):
        words = text.split("#", 1)[0].split()
        if not words:
            continue
        if not samples.rows:
            columns = len(words)
        _check_width(source, line, len(words), columns, joints, allowed)
        numbers = [parse_number(word, source.path, line, _column_name(place)) for place, word in enumerate(words)]
        time = Decimal(repr(numbers[0]))
        if not samples.rows:
            first_time = time
        if len(samples.rows) == MAX_SAMPLES:
            raise InputError(f"more than {MAX_SAMPLES} samples; cut the motion into parts", source.path, line)
        samples.lines.append(line)
        samples.time_s.append(float(time - first_time))
        samples.rows.append(numbers[1:joints + 1])
    if columns > joints + 1:
        samples.notes.append(f"columns {joints + 2} to {columns} are no arm joints and were dropped")
    if not source.text.endswith("\n"):
        samples.notes.append("the last line has no line end; check that the file is whole")
    return samples


def _check_width(source: SourceText, line: int, width: int, columns: int, joints: int, allowed: set[int]) -> None:
    if width == columns and width - 1 in allowed:
        return
    wanted = " or ".join(f"1 + {count}" for count in sorted(allowed))
    if width != columns and columns - 1 in allowed:
        raise InputError(f"{width} numbers, {columns} in the lines before; the line is cut or has too many, "
                         "write it again", source.path, line)
    raise InputError(f"{max(width - 1, 0)} joint columns, the arm has {joints}; write {wanted} numbers per line "
                     "(time and joints), separated by white space", source.path, line)


def _column_name(place: int) -> str:
    return "time" if place == 0 else f"joint column {place}"
