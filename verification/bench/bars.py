# SPDX-License-Identifier: Apache-2.0
"""The acceptance limits as data, from bars.toml in this folder.

@satisfies SWR-BEN-003      Design: docs/design/bench.md#bars
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import read_text

FILE = Path(__file__).with_name("bars.toml")
KINDS = ("gate", "advisory")


@dataclass(frozen=True)
class RatioBar:
    """In the same case, the time of `ours` may be at most `limits[size]` times the time of `against`."""

    id: str
    title: str
    metric: str
    ours: str
    against: str
    limits: dict[int, float]
    kind: str


@dataclass(frozen=True)
class GrowthBar:
    """At `to`, the time of `ours` per component may be at most `limit` times its time at `from`. `floor` is shown for comparison."""

    id: str
    title: str
    metric: str
    ours: str
    floor: str
    from_size: int
    to_size: int
    limit: float
    kind: str


@dataclass(frozen=True)
class CountBar:
    """An exact count [instructions]: of the first operation, minus the second operation if there is one."""

    id: str
    name: str
    title: str
    operations: tuple[str, ...]
    limit: int | None = None
    missed: bool = False  # known not to be met yet


@dataclass(frozen=True)
class Bars:
    """All acceptance limits, in the order of the file."""

    ratios: tuple[RatioBar, ...]
    growths: tuple[GrowthBar, ...]
    counts: tuple[CountBar, ...]

    @property
    def metrics(self) -> tuple[str, ...]:
        bars: tuple[RatioBar | GrowthBar, ...] = (*self.ratios, *self.growths)
        return tuple(dict.fromkeys(bar.metric for bar in bars))


def load_bars(path: Path = FILE) -> Bars:
    """@raise InputError with the file and the error."""
    try:
        data = tomllib.loads(read_text(path, "file of bars").text)
        return Bars(
            tuple(_make_ratio(entry) for entry in data["ratio"]),
            tuple(_make_growth(entry) for entry in data["growth"]),
            tuple(_make_count(entry) for entry in data["count"]),
        )
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"is no TOML: {error}", path) from error
    except KeyError as error:
        raise InputError(f"a bar lacks its {error}; see docs/design/bench.md", path) from error
    except (TypeError, ValueError) as error:
        raise InputError(f"a bar is wrong: {error}", path) from error


def _make_ratio(entry: dict[str, Any]) -> RatioBar:
    limits = {int(size): _check_limit(limit) for size, limit in entry["limits"].items()}
    return RatioBar(entry["id"], entry["title"], entry["metric"], entry["ours"], entry["against"], limits,
                    _check_kind(entry["kind"]))  # fmt: skip


def _make_growth(entry: dict[str, Any]) -> GrowthBar:
    return GrowthBar(entry["id"], entry["title"], entry["metric"], entry["ours"], entry["floor"], int(entry["from"]),
                     int(entry["to"]), _check_limit(entry["limit"]), _check_kind(entry["kind"]))  # fmt: skip


def _make_count(entry: dict[str, Any]) -> CountBar:
    operations = tuple(entry["operations"])
    if len(operations) not in (1, 2):
        raise ValueError(f"{entry['name']} has {len(operations)} operations, not one or two")
    limit = None if "limit" not in entry else int(_check_limit(entry["limit"]))
    return CountBar(entry["id"], entry["name"], entry["title"], operations, limit, bool(entry.get("missed", False)))


def _check_limit(limit: float) -> float:
    if not float(limit) > 0.0:
        raise ValueError(f"{limit} is no limit; it must be greater than 0")
    return float(limit)


def _check_kind(kind: str) -> str:
    if kind not in KINDS:
        raise ValueError(f"kind '{kind}' is none of: {', '.join(KINDS)}")
    return kind
