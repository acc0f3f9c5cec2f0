# SPDX-License-Identifier: Apache-2.0
"""Reads which threads ran during a measured run: scheduler switches, and CPU time of each step.

@satisfies SWR-TIM-043      Design: docs/design/timing.md#switch-log
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from mamori_trace.base.json_node import JsonNode

Array = np.ndarray[Any, np.dtype[Any]]

WINDOW_USE = np.dtype([("own_ns", "<i8"), ("outside_ns", "<i8"), ("thread", "<u4"), ("state", "<u4"), ("reading_ns", "<i8"),
                       ("reading_cpu_ns", "<i8"), ("runner_cpu_ns", "<i8")])  # fmt: skip
STEP_USE = np.dtype([("cpu_ns", "<i8"), ("voluntary", "<u4"), ("involuntary", "<u4")])
SLICE = np.dtype([("begin_ns", "<i8"), ("end_ns", "<i8"), ("core", "<u4"), ("thread", "<u4"), ("process", "<u4"), ("left", "<u4")])
KINDS = ("own", "other", "kernel")
OWN, OTHER, KERNEL = KINDS
PREEMPTED, WAITING = range(2)
"""Values of `left`: how a thread left the processor."""
IDLE = 0
UNKNOWN_THREAD = 2**32 - 1
NO_STATE = 2**32 - 1
CPU_NOT_KNOWN = -1
UNKNOWN_PRIORITY = -1
"""Priority of a thread that had ended before its priority could be read."""


@dataclass(frozen=True)
class Thread:
    """`priority`: fixed priority of a thread of the program, 0: none, or UNKNOWN_PRIORITY. `name`: empty if it had ended."""

    thread: int
    process: int
    kind: str
    priority: int
    name: str

    @property
    def label(self) -> str:
        """Name for a reader of the report."""
        if self.kind == OWN:
            return f"thread {self.thread} of the program" + (f" ('{self.name}')" if self.name else "")
        what = "kernel thread" if self.kind == KERNEL else "process"
        return f"{what} {self.process}" + (f" ('{self.name}')" if self.name else "")


@dataclass(frozen=True)
class State:
    """A state of the system. `is_operating`: it does its task."""

    name: str
    is_operating: bool


@dataclass(frozen=True)
class CoreLog:
    """Switches of the processor of one core. `errno`: cause of missing switches, 0 if they were recorded. `window_threads`: per window; 0 for none."""

    errno: int
    processor: int
    runner: int
    window_threads: tuple[int, ...]
    lost: int
    slices: Array

    @property
    def is_known(self) -> bool:
        return self.errno == 0

    @cached_property
    def ends(self) -> Array:
        return np.ascontiguousarray(self.slices["end_ns"])

    @cached_property
    def begins(self) -> Array:
        return np.ascontiguousarray(self.slices["begin_ns"])

    def between(self, begin_ns: int, end_ns: int) -> Array:
        """Slices that overlap the interval, in order of time."""
        first = int(np.searchsorted(self.ends, begin_ns, side="right"))
        last = int(np.searchsorted(self.begins, end_ns, side="left"))
        return self.slices[first : max(first, last)]


@dataclass(frozen=True)
class Switches:
    """`window_use` belongs to the rows of `Measurement.openings`, `step_use` to those of `Measurement.steps`. `continued_ns`: instants at
    which the stopped process continued, recorded shortly afterwards."""

    cores: tuple[CoreLog, ...]
    threads: Mapping[int, Thread]
    window_use: Array
    step_use: Array
    continued_ns: tuple[int, ...]

    def name(self, thread: int, process: int) -> str:
        known = self.threads.get(thread)
        return known.label if known is not None else f"process {process} (ended)" if process else f"thread {thread}"


def read_switches(node: JsonNode, slices: Array, window_use: Array, step_use: Array, windows: int) -> Switches:
    """@param windows of the table. @raise InputError for an inconsistent record."""
    cores = [_read_core(one, slices[slices["core"] == index], windows) for index, one in enumerate(node.at("cores").items())]
    if len(slices) and int(slices["core"].max()) >= len(cores):
        raise node.complain(f"has {len(cores)} cores, slices.npy has slices of core {int(slices['core'].max())}")
    threads = [Thread(one.at("thread").count(), one.at("process").count(), KINDS[one.at("kind").index(len(KINDS))],
                      _read_priority(one.at("priority")), one.at("name").text()) for one in node.at("threads").items()]  # fmt: skip
    return Switches(tuple(cores), {one.thread: one for one in threads}, window_use, step_use,
                    tuple(one.whole() for one in node.at("continued_ns").items()))  # fmt: skip


def _read_priority(node: JsonNode) -> int:
    return UNKNOWN_PRIORITY if node.whole() == UNKNOWN_PRIORITY else node.count()


def read_states(node: JsonNode, window_use: Array) -> tuple[State, ...]:
    """@raise InputError if a window instance has a state that is not listed."""
    states = tuple(State(one.at("name").text(), one.at("is_operating").truth()) for one in node.items())
    found = window_use["state"][window_use["state"] != NO_STATE]
    if len(found) and int(found.max()) >= len(states):
        raise node.complain(f"has {len(states)} states, window_use.npy has state {int(found.max())}")
    return states


def _read_core(node: JsonNode, slices: Array, windows: int) -> CoreLog:
    right = node.at("right")
    is_granted, errno = right.at("is_granted").truth(), right.at("errno").count()
    if is_granted == (errno != 0):
        raise right.complain("must have an errno if it is not granted, and none otherwise")
    threads: Sequence[int] = [one.count() for one in node.at("window_threads").items()]
    if len(threads) != windows:
        raise node.at("window_threads").complain(f"has {len(threads)} threads, the table has {windows} windows")
    if (slices["end_ns"] < slices["begin_ns"]).any() or (np.diff(slices["begin_ns"]) < 0).any():
        raise node.complain("has slices in slices.npy that are not in order of time")
    return CoreLog(errno, node.at("processor").count(), node.at("runner").count(), tuple(threads), node.at("lost").count(), slices)
