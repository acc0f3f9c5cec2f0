# SPDX-License-Identifier: Apache-2.0
"""Measured end-to-end times of the event chains, compared with their bounds in virtual time.

@satisfies SWR-TIM-017      Design: docs/design/timing.md#chains
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mamori_tools.timing.analysis import Distribution, Series, describe
from mamori_tools.timing.chains import Chain, ChainSet, Response, calc_bounds, calc_response, find_chains, follow
from mamori_tools.timing.reader import COMPLETED, NOT_BACK, Array, Measurement


@dataclass(frozen=True)
class Violation:
    """A value that took longer than possible in virtual time, although every window of its chain completed."""

    cycle: int
    measured_ns: int
    bound_ns: int


@dataclass(frozen=True)
class ChainRow:
    """One chain. `broken`: samples that an overrun, a skipped window or a missing component run interrupted."""

    name: str
    virtual: Response
    measured: Distribution | None
    broken: int
    violations: tuple[Violation, ...]
    times: Series


def list_chains(run: Measurement) -> tuple[list[ChainRow], str]:
    """@return all chains of the table with their times, and a note on the missing ones."""
    found: ChainSet = find_chains(run.table)
    spans: dict[int, _Spans] = {}
    for index in sorted({index for chain in found.chains for index in chain.components}):
        spans[index] = _collect_spans(run, index)
    return [_measure(run, chain, spans) for chain in found.chains], found.note


@dataclass(frozen=True)
class _Spans:
    """From the first start to the last end of one component in each completed window instance in which it ran and returned."""

    releases: Array
    starts: Array
    ends: Array

    def find(self, wanted: Array) -> tuple[Array, Array]:
        """@return a row for each requested release, and whether that row exists."""
        if not len(self.releases):
            return np.zeros(len(wanted), np.int64), np.zeros(len(wanted), bool)
        rows = np.minimum(np.searchsorted(self.releases, wanted), len(self.releases) - 1)
        return rows, self.releases[rows] == wanted


def _collect_spans(run: Measurement, component: int) -> _Spans:
    of_it = run.steps["component"] == component
    steps, rows = run.steps[of_it], run.opening_of_step[of_it]
    places, inverse = np.unique(rows, return_inverse=True)
    starts = np.full(len(places), np.iinfo(np.int64).max)
    ends = np.full(len(places), NOT_BACK, np.int64)
    np.minimum.at(starts, inverse, steps["start_ns"])
    np.maximum.at(ends, inverse, steps["end_ns"])
    hangs = np.bincount(inverse, weights=steps["end_ns"] == NOT_BACK, minlength=len(places)) > 0
    good = (run.openings["outcome"][places] == COMPLETED) & ~hangs
    return _Spans(run.openings["release_ns"][places][good], starts[good], ends[good])


def _measure(run: Measurement, chain: Chain, spans: dict[int, _Spans]) -> ChainRow:
    first = run.table.components[chain.components[0]].window
    last = run.table.components[chain.components[-1]].window
    assert first is not None and last is not None  # find_chains() returns only such chains
    samples = run.openings["release_ns"][run.rows_of(first)]
    releases = follow(run.table, chain, samples)
    ended = run.openings["release_ns"][run.rows_of(last)]
    inside = releases[-1] <= (ended[-1] if len(ended) else -1)  # other samples were incomplete at the end of the run
    whole = inside.copy()
    rows = []
    for component, wanted in zip(chain.components, releases, strict=True):
        row, found = spans[component].find(wanted)
        rows.append(row)
        whole &= found
    begin, end = spans[chain.components[0]], spans[chain.components[-1]]
    times = end.ends[rows[-1][whole]] - begin.starts[rows[0][whole]]
    bounds = calc_bounds(run.table, chain, samples[whole])
    over = times > bounds
    violations = tuple(
        Violation(int(release) // run.table.frame_ns, int(time), int(bound))
        for release, time, bound in zip(samples[whole][over], times[over], bounds[over], strict=True)
    )
    return ChainRow(chain.name(run.table), calc_response(run.table, chain), describe(times), int((inside & ~whole).sum()), violations,
                    Series(samples[whole], times))  # fmt: skip


def list_violations(chains: list[ChainRow]) -> list[str]:
    """One finding for each chain that violated its bound."""
    return [
        f"chain {row.name}: {len(row.violations)} of {row.measured.count if row.measured else 0} values took longer than virtual "
        f"time allows, first in cycle {row.violations[0].cycle}: {row.violations[0].measured_ns / 1e3:g} us, "
        f"bound {row.violations[0].bound_ns / 1e3:g} us"
        for row in chains if row.violations
    ]  # fmt: skip
