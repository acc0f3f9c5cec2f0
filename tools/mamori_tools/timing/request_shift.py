# SPDX-License-Identifier: Apache-2.0
"""Effect of requests from outside: the shift of the median start of each window.

@satisfies SWR-PRT-039      Design: docs/design/timing.md#requests
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mamori_tools.timing.analysis import Distribution, describe
from mamori_tools.timing.reader import PACES, Measurement, Requests
from mamori_trace.base.errors import InputError

NOT_BEGUN = np.iinfo(np.int64).max
BLOCKS_MIN = 1 + len(PACES)


@dataclass(frozen=True)
class ShiftRow:
    """One window, over all rounds [ns]: median start after the planned instant without requests, and the differences from it within the
    same round. None without a complete round."""

    window: str
    start: Distribution | None
    steady: Distribution | None
    burst: Distribution | None


def check_requests(run: Measurement, cycles: int) -> None:
    """@param run of a first cycle. @raise InputError if the program made no requests, or `cycles` contain no complete round."""
    if run.requests is None:
        raise InputError("timing: the program ignored --requests; set TimingOptions::with_requests in the program")
    if cycles < (least := BLOCKS_MIN * run.requests.block_cycles):
        raise InputError(f"timing: --requests needs at least {least} cycles of this system; increase --cycles")


def list_shifts(run: Measurement) -> list[ShiftRow]:
    """Empty list if there were no requests."""
    return [] if run.requests is None else [_make_row(run, run.requests, index) for index in range(len(run.table.windows))]


def _count_blocks(run: Measurement, requests: Requests) -> int:
    """Complete blocks."""
    return (int(run.openings["release_ns"].max()) // run.table.frame_ns + 1) // requests.block_cycles


def _make_row(run: Measurement, requests: Requests, index: int) -> ShiftRow:
    place = run.rows_of(index)
    releases = run.openings["release_ns"][place]
    starts = np.full(len(releases), NOT_BEGUN)
    of_it = (run.opening_of_step >= place.start) & (run.opening_of_step < place.stop)
    np.minimum.at(starts, run.opening_of_step[of_it] - place.start, run.steps["start_ns"][of_it])
    ran = starts != NOT_BEGUN
    rounds = max(0, _count_blocks(run, requests) - 1) // len(PACES)
    edges = np.searchsorted(releases[ran], np.arange(1, 2 + rounds * len(PACES)) * requests.block_cycles * run.table.frame_ns)
    table = np.full((rounds, len(PACES)), NOT_BEGUN)
    for block, part in enumerate(np.split((starts - releases)[ran], edges)[1:-1]):
        if (median := describe(part)) is not None:
            table[block // len(PACES), requests.paces[block + 1]] = median.p50
    table = table[(table != NOT_BEGUN).all(axis=1)]
    return ShiftRow(run.table.windows[index].name, *(describe(column) for column in (table[:, 0], table[:, 1] - table[:, 0], table[:, 2] - table[:, 0])))


def list_shift_findings(run: Measurement, rows: list[ShiftRow]) -> list[str]:
    """Shifts of at least 1 % of the major frame, and requests that were not made."""
    if run.requests is None:
        return []
    blocks = run.requests.paces[: _count_blocks(run, run.requests)]
    planned = sum(pace != 0 for pace in blocks) * run.requests.block_cycles * run.table.frame_ns // 1_000_000
    findings = []
    if run.requests.count < planned / 2:
        findings.append(f"requests: {run.requests.count} of {planned} were made, so their effect is not shown; use an idle host")
    for row in rows:
        for shift, name in ((row.steady, PACES[1]), (row.burst, PACES[2])):
            if shift is not None and abs(shift.p50) * 100 >= run.table.frame_ns:
                findings.append(f"window '{row.window}': requests ({name}) shift the median start by {shift.p50 / 1e3:g} us, "
                                f"limit {run.table.frame_ns / 1e5:g} us")  # fmt: skip
    return findings
