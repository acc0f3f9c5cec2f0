# SPDX-License-Identifier: Apache-2.0
"""Compares exact counts with their limits and with the stored baseline, and rewrites the baseline on request.

@satisfies SWR-BEN-006, SWR-BEN-008      Design: docs/design/bench.md#baseline
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from mamori_tools.host.callgrind import REPETITIONS, Profile
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import read_text, write_text
from verification.bench.bars import CountBar
from verification.bench.judge import FAILED, PASSED

FILE = Path(__file__).with_name("baseline.toml")
ACCEPT = "./mamori bench --accept"


@dataclass(frozen=True)
class Baseline:
    """Counts by name [instructions], with their compiler and C library."""

    compiler: str
    c_library: str
    counts: dict[str, int]

    def belongs_to(self, compiler: str, c_library: str) -> bool:
        return (self.compiler, self.c_library) == (compiler, c_library)


@dataclass(frozen=True)
class CountResult:
    """One exact count and its verdict; `note` states the next action."""

    id: str
    name: str
    title: str
    count: int
    limit: int | None
    baseline: int | None
    verdict: str
    note: str = ""
    is_known_miss: bool = False  # failed only for a limit that is marked as missed


def load_baseline(path: Path = FILE) -> Baseline:
    """@raise InputError with the error."""
    try:
        data = tomllib.loads(read_text(path, "baseline").text)
        counts = {name: int(count) for name, count in data["instructions"].items()}
        return Baseline(data["belongs_to"]["compiler"], data["belongs_to"]["c_library"], counts)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"is no TOML: {error}; write it anew with {ACCEPT}", path) from error
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise InputError(f"invalid baseline ({error}); write it anew with {ACCEPT}", path) from error


def write_baseline(baseline: Baseline, path: Path = FILE) -> None:
    """Writes the baseline atomically."""
    lines = ["# SPDX-License-Identifier: Apache-2.0",
             "# Exact instructions per operation, written by `./mamori bench --accept`. CI fails when a count is greater.",
             "[belongs_to]", f'compiler = "{baseline.compiler}"', f'c_library = "{baseline.c_library}"', "",
             "[instructions]", *(f"{name} = {count}" for name, count in baseline.counts.items())]  # fmt: skip
    write_text(path, "\n".join(lines) + "\n")


def calc_count(bar: CountBar, profiles: Mapping[str, Profile]) -> int:
    """@raise WorkError if the repetitions of an operation differ: the operation then has no exact count."""
    counts = [profiles[name].calc_count(REPETITIONS) for name in bar.operations]
    return counts[0] - sum(counts[1:])


def judge_count(bar: CountBar, count: int, baseline: Baseline, compiler: str, c_library: str) -> CountResult:
    """Worst count first. A limit applies to every compiler; the baseline applies only to its own compiler."""
    before = baseline.counts.get(bar.name)

    def result(verdict: str, note: str = "", is_known_miss: bool = False) -> CountResult:
        return CountResult(bar.id, bar.name, bar.title, count, bar.limit, before, verdict, note, is_known_miss)

    is_over = bar.limit is not None and count > bar.limit
    if is_over and not bar.missed:
        return result(FAILED, f"over the limit of {bar.limit}")
    if bar.missed and not is_over:
        return result(FAILED, "meets its limit now; take the mark `missed` out of bars.toml")
    is_comparable = baseline.belongs_to(compiler, c_library)
    if is_comparable and before is None:
        return result(FAILED, f"is not in the baseline; take it in with {ACCEPT}")
    if is_comparable and before is not None and count > before:
        return result(FAILED, f"{count - before} more than the baseline; if that is meant, say why in the commit and {ACCEPT}")
    note = ""
    if not is_comparable:
        note = f"not compared: the baseline belongs to {baseline.compiler}, {baseline.c_library}, this is {compiler}, {c_library}"
    elif before is not None and count < before:
        note = f"{before - count} fewer than the baseline; lower it with {ACCEPT}"
    if is_over:
        return result(FAILED, "; ".join(filter(None, (f"known miss of the limit {bar.limit}", note))), is_known_miss=True)
    return result(PASSED, note)
