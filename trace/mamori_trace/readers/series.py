# SPDX-License-Identifier: Apache-2.0
"""Reads series.csv of one simulated run.

@satisfies SWR-TRC-005      Design: docs/design/trace.md#evidence-files
"""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import FormatError
from mamori_trace.base.system_error import explain

JOINTS = 7


@dataclass(frozen=True, slots=True)
class Series:
    """Columns of one run. `position` and `speed` contain one list per joint; all lists have equal lengths."""

    time_s: list[float]
    position_rad: list[list[float]]
    speed_rad_s: list[list[float]]
    state: list[str]


def read_series(path: Path) -> Series:
    """Raises FormatError if the file is missing, truncated, or contains text that is not a number."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except OSError as error:
        raise FormatError(f"{path.name} cannot be read: {explain(error)}") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise FormatError(f"{path.name} is no CSV text: {error}") from None
    if len(rows) < 2:
        raise FormatError(f"{path.name} holds no samples")
    wanted = ["t_s", *(f"q{j + 1}" for j in range(JOINTS)), *(f"qd{j + 1}" for j in range(JOINTS)), "state"]
    try:
        columns = [rows[0].index(name) for name in wanted]
    except ValueError as error:
        raise FormatError(f"{path.name} line 1: column missing: {error}") from None
    samples: list[list[float]] = []
    states: list[str] = []
    for number, row in enumerate(rows[1:], start=2):
        try:
            samples.append([float(row[index]) for index in columns[:-1]])
            states.append(row[columns[-1]].strip())
        except (IndexError, ValueError) as error:
            raise FormatError(f"{path.name} line {number}: {error}") from None
        if not all(map(math.isfinite, samples[-1])):
            raise FormatError(f"{path.name} line {number}: holds a value that is no finite number")
        if len(samples) > 1 and samples[-1][0] < samples[-2][0]:
            raise FormatError(f"{path.name} line {number}: time {samples[-1][0]} does not follow the line before")
    table = list(map(list, zip(*samples, strict=True)))
    return Series(table[0], table[1 : 1 + JOINTS], table[1 + JOINTS :], states)
