# SPDX-License-Identifier: Apache-2.0
"""The part of run.json that the evaluation needs, checked field by field (docs/design/trace.md#evidence-files)."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from mamori_trace.base.errors import InputError, WorkError
from mamori_trace.base.text_file import read_text

SCHEMA = "mamori.run/1"
MAX_BYTES = 10_000_000

_DIGITS_MAX = 20
"""Length of the largest integer in a record, a 64-bit seed."""


@dataclass(frozen=True)
class RunRecord:
    """One simulated run. Times [s] since its start; positions [rad], speeds [rad/s]; None if an event did not occur."""

    commit: str
    seed: int
    fault: Mapping[str, Any] | None
    latent: str
    injected_at_s: float | None
    simulated_s: float
    final_state: str
    operational_at_s: float | None
    detected_fault: str | None
    detected_at_s: float | None
    reaction: str | None
    reacted_at_s: float | None
    standstill_at_s: float | None
    watchdog_bitten: bool
    max_speed_rad_s: tuple[float, ...]
    speed_limit_rad_s: tuple[float, ...]
    min_position_margin_rad: float
    hold_drift_rad: float | None
    max_tracking_error_rad: float | None


def load_run(path: Path) -> dict[str, Any]:
    """Reads run.json unchanged. Raises WorkError if it is missing, incomplete, not a JSON object, or has a non-finite number."""
    try:
        text = read_text(path, "run record", MAX_BYTES).text
        content = json.loads(text, parse_constant=_refuse_number, parse_float=_parse_float, parse_int=_parse_int)
    except InputError as error:
        raise WorkError(str(error)) from error
    except json.JSONDecodeError as error:
        raise WorkError(f"run.json:{error.lineno}: is not whole JSON ({error.msg})") from error
    except RecursionError as error:
        raise WorkError("run.json: is nested too deeply") from error
    if not isinstance(content, dict):
        raise WorkError("run.json: holds no object")
    return content


def read_record(run: Mapping[str, Any]) -> RunRecord:
    """Checks and converts a run. Raises WorkError with the first field that is missing or of the wrong kind."""
    if run.get("schema") != SCHEMA:
        raise WorkError(f"schema is {run.get('schema')!r}, {SCHEMA} is wanted")
    physics = _take(run, "physics", dict)
    fault = _take_or_none(run, "fault", dict)
    top_speed = _take_numbers(physics, "max_speed_rad_s")
    limit = _take_numbers(physics, "speed_limit_rad_s")
    if not top_speed or len(top_speed) != len(limit):
        raise WorkError(f"{len(top_speed)} top speeds and {len(limit)} speed limits")
    return RunRecord(
        commit=_take(run, "commit", str),
        seed=_take(run, "seed", int),
        fault=fault,
        latent=_take_or_none(run, "latent", str) or "",
        injected_at_s=None if fault is None else _take_number(fault, "at_s"),
        simulated_s=_take_number(run, "simulated_s"),
        final_state=_take(run, "final_state", str),
        operational_at_s=_take_number_or_none(run, "operational_at_s"),
        detected_fault=_take_or_none(run, "detected_fault", str),
        detected_at_s=_take_number_or_none(run, "detected_at_s"),
        reaction=_take_or_none(run, "reaction", str),
        reacted_at_s=_take_number_or_none(run, "reacted_at_s"),
        standstill_at_s=_take_number_or_none(run, "standstill_at_s"),
        watchdog_bitten=_take(run, "watchdog_bitten", bool),
        max_speed_rad_s=top_speed,
        speed_limit_rad_s=limit,
        min_position_margin_rad=_take_number(physics, "min_position_margin_rad"),
        hold_drift_rad=_take_number_or_none(physics, "hold_drift_rad"),
        max_tracking_error_rad=_take_number_or_none(physics, "max_tracking_error_rad"),
    )


def _refuse_number(text: str) -> NoReturn:
    raise WorkError(f"run.json: holds {text[:_DIGITS_MAX]}, no finite number of a usual size")


def _parse_float(text: str) -> float:
    number = float(text)
    return number if math.isfinite(number) else _refuse_number(text)


def _parse_int(text: str) -> int:
    return int(text) if len(text) <= _DIGITS_MAX else _refuse_number(text)


def _take(table: Mapping[str, Any], key: str, kind: type) -> Any:
    if key not in table:
        raise WorkError(f"'{key}' is missing")
    value = table[key]
    if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
        raise WorkError(f"'{key}' is {value!r}, {kind.__name__} is wanted")
    return value


def _take_or_none(table: Mapping[str, Any], key: str, kind: type) -> Any:
    return None if key in table and table[key] is None else _take(table, key, kind)


def _take_number(table: Mapping[str, Any], key: str) -> float:
    if key not in table:
        raise WorkError(f"'{key}' is missing")
    return _to_number(table[key], key)


def _take_number_or_none(table: Mapping[str, Any], key: str) -> float | None:
    return None if key in table and table[key] is None else _take_number(table, key)


def _take_numbers(table: Mapping[str, Any], key: str) -> tuple[float, ...]:
    return tuple(_to_number(value, key) for value in _take(table, key, list))


def _to_number(value: object, key: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise WorkError(f"'{key}' is {value!r}, a finite number is wanted")
    return float(value)
