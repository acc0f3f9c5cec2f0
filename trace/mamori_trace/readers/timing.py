# SPDX-License-Identifier: Apache-2.0
"""Reads the measurements of `mamori timing`: `timing/NAME/timing.json` and its pictures (docs/design/timing.md#results).

@satisfies SWR-TRC-015, SWR-TRC-016      Design: docs/design/trace.md#timing
"""

from __future__ import annotations

import base64
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import FormatError
from mamori_trace.base.files import list_paths
from mamori_trace.base.finding import Problem
from mamori_trace.base.json_file import Each, Maybe, read_records
from mamori_trace.base.system_error import explain
from mamori_trace.model.evidence import Evidence, TimingRun

SCHEMA = "mamori.timing/1"
PICTURE_BYTES_MAX = 300_000
"""Maximum size of one picture in the page. A picture of ten thousands of window instances takes about 200 kB."""

_TIMES = Maybe({"count": int, "min": int, "p50": int, "p99": int, "p999": int, "max": int})
_ENVIRONMENT = {"commit": str, "dirty": bool, "date_utc": str, "command": str, "os": str, "cpu": str, "cores": Maybe(int),
                "compilers": Each(str), "packages": Each(str), "python": str}  # fmt: skip
_STATE = {"load_1_min": float, "frequency_khz": Maybe(int)}
_SHAPE = {
    "system": str, "exit_status": int, "marks": [str], "is_partial": bool, "cycles": {"asked": int, "run": int}, "frame_ns": int,
    "reference_ns": int, "with_load": bool, "rights": Each({"is_granted": bool, "errno": int}), "environment": _ENVIRONMENT,
    "host": {
        "setting": {"kernel": str, "kernel_version": str, "preemption": str, "governor": str, "clock_source": str,
                    "virtual_machine": bool, "isolated_cores": str},
        "before": _STATE, "after": _STATE, "steal_share": float,
    },
    "findings": [str], "notes": [str],
    "windows": [{
        "window": str, "core": int, "offset_ns": int, "length_ns": int, "budget_ns": int, "outcomes": {"missed": int, "overrun": int},
        "lateness": _TIMES, "response": _TIMES, "used_max_ns": Maybe(int), "budget_margin_ns": Maybe(int), "length_margin_ns": Maybe(int),
    }],
    "components": [{
        "component": str, "window": str, "declared_ns": Maybe(int), "execution": _TIMES, "margin_ns": Maybe(int), "unfinished": int,
        "extreme_values": {"refusal": Maybe(str), "quantiles": [{"exceeded_with": float, "value_ns": float}]},
    }],
    "ratios": [{"component": str, "ratio": float}],
    "chains": [{"name": str, "virtual": {"min_ns": int, "max_ns": int, "reaction_max_ns": int}, "measured": _TIMES, "broken": int,
                "violation_count": int}],
    "chain_note": str, "miss_count": int,
    "misses": [{"cycle": int, "window": str, "outcome": str, "component": Maybe(str), "late_ns": int, "reason": str, "is_host": bool}],
}  # fmt: skip
"""The parts of the record that the page shows; the record may contain more."""


@dataclass(frozen=True, slots=True)
class Picture:
    """`address` contains the complete picture as passive data; empty if the picture is omitted, and `reason` states why."""

    address: str
    reason: str = ""


@dataclass(frozen=True, slots=True)
class _Kind:
    suffix: str
    media: str
    head: bytes
    end: bytes


_KINDS = (
    _Kind(".svg", "image/svg+xml", b"<?xml", b"</svg>"),
    _Kind(".png", "image/png", b"\x89PNG\r\n\x1a\n", b"IEND\xaeB`\x82"),
)


def read_timing(folder: Path, root: Path, evidence: Evidence, problems: list[Problem]) -> None:
    """Reads the measured systems, sorted by folder. Each record that violates the format is one problem."""
    files = list_paths(folder, "timing/*/timing.json", root, problems)
    for path, table, place in read_records(files, SCHEMA, _SHAPE, "measure again", root, problems):
        evidence.timing_runs.append(TimingRun(path.parent.as_posix(), table, place))


def read_picture(folder: Path, name: str, room_bytes: int) -> Picture | None:
    """The smaller one of SVG and PNG. @param room_bytes remaining size on the page. @return nothing if there is no such picture. @raise
    FormatError for a truncated or unreadable picture."""
    present = [(folder / f"{name}{kind.suffix}", kind) for kind in _KINDS if (folder / f"{name}{kind.suffix}").is_file()]
    if not present:
        return None
    try:
        path, kind = min(present, key=lambda one: one[0].stat().st_size)
        start = f"data:{kind.media};base64,"
        needed = len(start) + (path.stat().st_size + 2) // 3 * 4
        room = min(room_bytes, PICTURE_BYTES_MAX)
        if needed > room:
            return Picture("", f"{path.name} would take {needed} bytes of this page, which has room for {room}; look at the file")
        data = path.read_bytes()
    except OSError as error:
        raise FormatError(f"{name} cannot be read: {explain(error)}") from None
    if not data.startswith(kind.head) or not data.rstrip().endswith(kind.end):
        raise FormatError(f"{path.name} is no whole picture; measure again")
    return Picture(start + base64.b64encode(data).decode("ascii"))
