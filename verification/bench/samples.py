# SPDX-License-Identifier: Apache-2.0
"""The samples of the program `mamori_bench`: for each case and subject, one time per round.

@satisfies SWR-BEN-001      Design: docs/design/bench.md#method
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import read_text

SCHEMA = "mamori.bench.samples/1"


@dataclass(frozen=True)
class Series:
    """One subject of a case: the median of its batches in each round [ns]."""

    name: str
    rounds_ns: tuple[float, ...]

    @property
    def p50_ns(self) -> float:
        return median(self.rounds_ns)


@dataclass(frozen=True)
class Case:
    """Subjects with the same work in the same rounds. `size`: payload [byte] or components."""

    metric: str
    size: int
    unit: str
    series: dict[str, Series]


@dataclass(frozen=True)
class Samples:
    """One run. `absent`: missing reference implementations, with the reason."""

    cases: dict[tuple[str, int], Case]
    absent: dict[str, str]
    compiler: str
    flags: str
    rounds: int


def read_samples(path: Path) -> Samples:
    """@raise InputError if the file is not in the format of the program."""
    try:
        return parse_samples(json.loads(read_text(path, "file of samples").text))
    except json.JSONDecodeError as error:
        raise InputError(f"is no JSON: {error}; measure again", path) from error
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"is no file of samples ({error}); measure again", path) from error


def parse_samples(data: dict[str, Any]) -> Samples:
    """@raise KeyError, TypeError or ValueError if `data` has another structure."""
    if data["schema"] != SCHEMA:
        raise ValueError(f"schema is '{data['schema']}', not '{SCHEMA}'")
    rounds = int(data["effort"]["rounds"])
    absent = {peer["name"]: peer["reason"] for peer in data["absent"]}
    cases = {}
    for entry in data["cases"]:
        absent.update({peer["name"]: peer["reason"] for peer in entry["absent"]})
        series = {one["name"]: _make_series(one, rounds) for one in entry["subjects"]}
        cases[entry["metric"], entry["size"]] = Case(entry["metric"], entry["size"], entry["unit"], series)
    return Samples(cases, absent, data["compiler"], data["flags"], rounds)


def _make_series(entry: dict[str, Any], rounds: int) -> Series:
    times = tuple(float(value) for value in entry["rounds_ns"])
    if len(times) != rounds:
        raise ValueError(f"{entry['name']} has {len(times)} rounds, the run had {rounds}")
    if not all(math.isfinite(time) and time > 0.0 for time in times):
        raise ValueError(f"{entry['name']} has a time that is no positive number")
    return Series(entry["name"], times)
