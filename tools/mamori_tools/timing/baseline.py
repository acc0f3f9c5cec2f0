# SPDX-License-Identifier: Apache-2.0
"""The stored ratios of the components of a system: written on request, and compared with a new run.

A ratio is the median execution time divided by that of a fixed piece of work in the same run. A slower or busier host therefore changes
ratios less than times.

@satisfies SWR-TIM-020, SWR-TIM-021      Design: docs/design/timing.md#baseline
"""

from __future__ import annotations

import hashlib
import json
import math
import tomllib
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from mamori_tools.table.document import Table
from mamori_tools.timing.analysis import ComponentRow
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import read_text, write_text

SCHEMA = "mamori.timing_baseline/1"
LIMIT_FACTOR = 1.5
"""Margin for effects that ratios do not cancel (caches, frequency steps): a median that grew by half has another cause."""
KEYS = ("schema", "system", "table", "limit_factor", "component")
HOW_TO_FIX = "write a new one with ./mamori timing SYSTEM --accept FILE"


@dataclass(frozen=True)
class Baseline:
    """`ratios`: of each component, in table order; the index identifies a component, because names may be equal."""

    path: Path
    system: str
    table: str
    limit_factor: float
    ratios: tuple[tuple[str, float], ...]


def make_fingerprint(table: Table) -> str:
    """Hash of all keys of a table that this command reads; new keys of the format do not change it."""
    return hashlib.sha256(json.dumps(asdict(table), sort_keys=True).encode()).hexdigest()


def list_ratios(rows: Sequence[ComponentRow], reference_ns: int) -> list[tuple[str, float]]:
    """Measured components with their ratios."""
    return [(row.component, row.execution.p50 / reference_ns) for row in rows if row.execution is not None]


def load_baseline(path: Path, system: str) -> Baseline:
    """@raise InputError for an invalid baseline, another format, or another system than `system`."""
    try:
        data = tomllib.loads(read_text(path, "baseline", 1_000_000).text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"invalid TOML: {error}; {HOW_TO_FIX}", path) from error
    if data.get("schema") != SCHEMA:
        raise InputError(f"unknown schema '{data.get('schema')}', expected '{SCHEMA}'; {HOW_TO_FIX}", path)
    try:
        if unknown := sorted(set(data) - set(KEYS)):
            raise ValueError(f"unknown key '{unknown[0]}'")
        factor = _read_positive(data["limit_factor"], "limit_factor")
        if factor < 1.0:
            raise ValueError(f"limit_factor is {factor:g}, must be at least 1")
        ratios = tuple((str(row["name"]), _read_positive(row["ratio"], f"ratio of '{row['name']}'", least=0.0)) for row in data["component"])
        baseline = Baseline(path, str(data["system"]), str(data["table"]), factor, ratios)
    except KeyError as error:
        raise InputError(f"invalid baseline: key {error} is missing; {HOW_TO_FIX}", path) from error
    except (TypeError, ValueError, AttributeError) as error:
        raise InputError(f"invalid baseline: {error}; {HOW_TO_FIX}", path) from error
    if baseline.system != system:
        raise InputError(f"is the baseline of '{baseline.system}', not of '{system}'; specify the file of this system, or {HOW_TO_FIX}", path)
    return baseline


def _read_positive(value: object, what: str, least: float = math.ulp(0.0)) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value) or value < least:
        raise ValueError(f"{what} is not a number in range")
    return float(value)


def check_table(baseline: Baseline, table: Table) -> None:
    """@raise InputError if the baseline belongs to another table, because its figures are then not comparable."""
    if baseline.table != make_fingerprint(table):
        raise InputError(f"belongs to another table of '{baseline.system}'; {HOW_TO_FIX}", baseline.path)


def check_ratios(baseline: Baseline, ratios: Sequence[tuple[str, float]]) -> list[str]:
    """@return one finding per component over its limit, and per component of the baseline that the run lacks."""
    findings = []
    if [name for name, _ in ratios] != [name for name, _ in baseline.ratios]:
        missing = [name for name, _ in baseline.ratios if name not in dict(ratios)]
        added = [name for name, _ in ratios if name not in dict(baseline.ratios)]
        what = f"'{missing[0]}' was not measured" if missing else f"'{added[0]}' is missing in the file" if added else "the order differs"
        return [f"baseline: {what}"]
    for (name, before), (_, now) in zip(baseline.ratios, ratios, strict=True):
        limit = before * baseline.limit_factor
        if now > limit:
            findings.append(f"component '{name}': ratio {now:.3g} to the reference, baseline {before:.3g}, limit {limit:.3g}")
    return findings


def write_baseline(path: Path, system: str, table: Table, ratios: Sequence[tuple[str, float]]) -> None:
    """Writes the baseline atomically. @raise InputError if that fails."""
    rows = "".join(f"\n[[component]]\nname = {_quote(name)}\nratio = {ratio!r}\n" for name, ratio in ratios)
    write_text(path, f"""# SPDX-License-Identifier: Apache-2.0
# Median execution time of each component over that of a fixed piece of work in the same run, written by
# `./mamori timing SYSTEM --accept FILE`; --check fails above ratio * limit_factor.
schema = "{SCHEMA}"
system = {_quote(system)}
table = "{make_fingerprint(table)}"
limit_factor = {LIMIT_FACTOR}
{rows}""")  # fmt: skip


def _quote(text: str) -> str:
    """A basic string of TOML, equal to that of JSON except for DEL."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
