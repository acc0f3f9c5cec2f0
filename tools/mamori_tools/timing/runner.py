# SPDX-License-Identifier: Apache-2.0
"""What the thread that runs the windows of a core did: work of the program, or the measurement itself.

@satisfies SWR-TIM-044      Design: docs/design/timing.md#verdict
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mamori_tools.timing.switches import CPU_NOT_KNOWN, Array, CoreLog

STEAL_NS_MIN = 50_000
"""Minimum difference between time on the processor and CPU time that counts as use by the host."""
STOLEN = "the hypervisor or interrupts used the processor"
DEVICES = "the thread of the windows ran (devices, observers)"
EXECUTIVE = "the executive ran in the window before (slowed by the host)"
READING = "the measurement ran (reading of the switches)"
USES = (DEVICES, EXECUTIVE, READING)


class _Presence:
    """Time [ns] of one thread on the processor, from the begin of the log to an instant."""

    def __init__(self, log: CoreLog, thread: int) -> None:
        of_it = log.slices[log.slices["thread"] == thread]
        self._begins, self._lengths = of_it["begin_ns"], of_it["end_ns"] - of_it["begin_ns"]
        self._sums = np.concatenate(([0], np.cumsum(self._lengths)))

    def until(self, instants: Array) -> Array:
        index = np.searchsorted(self._begins, instants, side="right") - 1
        if not len(self._begins):
            return np.zeros_like(instants)
        within = np.minimum(instants - self._begins[index], self._lengths[index])
        return np.where(index < 0, 0, self._sums[index] + within)


@dataclass(frozen=True)
class RunnerTimes:
    """The time of a core, divided at the start and the end of each window instance and at the end of the reading of the switches after it:
    `ends` of the parts in order of time, three per window instance. `stolen_ns` of each part: presence of the runner on the processor without
    CPU time."""

    ends: Array
    stolen_ns: Array
    presence: _Presence

    def list_uses(self, begin_ns: int, end_ns: int) -> Iterator[tuple[str, int]]:
        """DEVICES, EXECUTIVE, READING and STOLEN with the time [ns] that the runner was on the processor within the interval."""
        first, last = np.searchsorted(self.ends, [begin_ns, end_ns], side="left")
        parts = np.arange(first, min(last + 1, len(self.ends)))
        present = np.diff(self.presence.until(np.concatenate(([begin_ns], np.minimum(self.ends[parts], end_ns)))))
        stolen = np.minimum(present, self.stolen_ns[parts])
        yield STOLEN, int(stolen.sum())
        for number, use in enumerate(USES):
            yield use, int((present - stolen)[parts % len(USES) == number].sum())


def find_runner_times(log: CoreLog, openings: Array, use: Array) -> RunnerTimes:
    """@param openings, use window instances of the core, in order of time."""
    closed = openings["closed_ns"]
    ends = np.column_stack((openings["woke_ns"], closed, closed + use["reading_ns"])).ravel()
    presence = _Presence(log, log.runner)
    devices, executive, reading = np.diff(presence.until(ends), prepend=0).reshape(-1, len(USES)).T
    lost = _calc_stolen(devices + executive, use["runner_cpu_ns"])
    # The executive works for some microseconds only: if the host took time from both, most of it is of the devices.
    in_executive = np.minimum(lost, executive)
    stolen = np.column_stack((lost - in_executive, in_executive, _calc_stolen(reading, use["reading_cpu_ns"])))
    return RunnerTimes(ends, stolen.ravel(), presence)


def _calc_stolen(present_ns: Array, cpu_ns: Array) -> Array:
    lost = present_ns - cpu_ns
    return np.where((cpu_ns == CPU_NOT_KNOWN) | (lost < STEAL_NS_MIN), 0, lost)
