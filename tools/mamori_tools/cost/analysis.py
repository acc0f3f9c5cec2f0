# SPDX-License-Identifier: Apache-2.0
"""Evaluates counted steps of components and windows: pure functions from arrays to figures.

@satisfies SWR-TIM-032, SWR-TIM-033, SWR-TIM-035      Design: docs/design/cost.md#figures
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mamori_tools.cost.run import ClassRun
from mamori_tools.table.document import Table
from mamori_tools.timing.reader import PASSES, Array


@dataclass(frozen=True)
class Count:
    """Instruction counts; each is an actual count. `cycle`: the first major frame with the maximum."""

    count: int
    min: int
    median: int
    max: int
    cycle: int


@dataclass(frozen=True)
class StepRow:
    """One pass of a component, with the inputs of one class. `time_ns`: the maximum count times the largest ratio of the run."""

    input_class: str
    component: str
    window: str
    pass_name: str
    instructions: Count
    time_ns: float


@dataclass(frozen=True)
class Ratio:
    """Measured time per instruction of one component [ns]: median and 99th percentile over window instances of all classes."""

    component: str
    openings: int
    median_ns: float
    p99_ns: float


@dataclass(frozen=True)
class Pace:
    """The ratio that converts counts to times. `ns_per_instruction`: the largest median, of `component`; `least_ns`: the smallest median.
    `reference_ns`: the ratio of the reference work, for comparison."""

    ns_per_instruction: float
    component: str
    least_ns: float
    reference_ns: float
    reference_instructions: int


@dataclass(frozen=True)
class LimitRow:
    """A budget of a window or the declared worst case of a component, compared with the maximum count in one window instance.

    `heaviest`: the component with the largest share. `needed_ns`: time of the maximum count plus margin.
    """

    what: str
    name: str
    limit_ns: int
    input_class: str
    cycle: int
    instructions: int
    heaviest: str
    time_ns: float
    needed_ns: float

    @property
    def left_ns(self) -> float:
        return self.limit_ns - self.needed_ns

    @property
    def is_kept(self) -> bool:
        return self.left_ns >= 0.0


def list_ratios(runs: Sequence[ClassRun]) -> list[Ratio]:
    """The ratio of each component that ran in a counted cycle."""
    rows = []
    for index, component in enumerate(runs[0].table.components):
        parts = [_calc_ratios(run, index) for run in runs]
        ratios = np.sort(np.concatenate(parts))
        if len(ratios):
            rows.append(Ratio(component.name, len(ratios), float(_pick(ratios, 500)), float(_pick(ratios, 990))))
    return rows


def find_pace(ratios: Sequence[Ratio], runs: Sequence[ClassRun]) -> Pace:
    """@pre `ratios` is not empty."""
    worst = max(ratios, key=lambda row: row.median_ns)
    least = min(row.median_ns for row in ratios)
    reference = [run.facts.reference_ns - run.facts.empty_ns for run in runs]
    instructions = runs[0].reference_instructions
    return Pace(worst.median_ns, worst.component, least, sorted(reference)[len(reference) // 2] / instructions, instructions)


def list_steps(runs: Sequence[ClassRun], pace: Pace) -> list[StepRow]:
    """Sorted by class, component and pass."""
    rows = []
    for run in runs:
        for index, component in enumerate(run.table.components):
            for number, name in enumerate(PASSES):
                chosen = (run.steps["component"] == index) & (run.steps["pass"] == number)
                if chosen.any():
                    counts = _describe(run.instructions[chosen], run.steps["release_ns"][chosen], run.table)
                    window = run.table.windows[component.window or 0].name
                    time_ns = counts.max * pace.ns_per_instruction
                    rows.append(StepRow(run.input_class.name, component.name, window, name, counts, time_ns))
    return rows


def list_limits(runs: Sequence[ClassRun], pace: Pace, margin_percent: float) -> list[LimitRow]:
    """Each budget and each declared worst case with at least one counted window instance."""
    table = runs[0].table
    rows = []
    for index, window in enumerate(table.windows):
        members = table.components_of(index)
        rows += _make_limit("window", window.name, window.budget_ns, members, runs, pace, margin_percent)
    for index, component in enumerate(table.components):
        if component.worst_case_ns is not None:
            rows += _make_limit("component", component.name, component.worst_case_ns, [index], runs, pace, margin_percent)
    return rows


def list_findings(limits: Sequence[LimitRow], runs: Sequence[ClassRun], ratios: Sequence[Ratio], margin_percent: float) -> list[str]:
    """One line for each limit below the measured maximum plus margin, and for each component without a count."""
    table = runs[0].table
    findings = []
    for row in limits:
        if not row.is_kept:
            kind, mend = ("budget", "raise the budget") if row.what == "window" else ("declared worst case", "declare more")
            findings.append(
                f"{row.what} '{row.name}': {kind} {row.limit_ns / 1e3:g} us, but {row.instructions} instructions (class '{row.input_class}', "
                f"cycle {row.cycle}, most of them by '{row.heaviest}') take {row.time_ns / 1e3:.3g} us, with {margin_percent:g} % margin "
                f"{row.needed_ns / 1e3:.3g} us; {mend}, or make '{row.heaviest}' cheaper"
            )
    counted = {row.component for row in ratios}
    silent = [component.name for component in table.components if component.window is not None and component.name not in counted]
    if ratios and not any(row.median_ns > 0.0 for row in ratios):
        findings.append("ratio: no component took any time in real time, so no limit can be checked; declare a class of inputs with more work")
    findings += [f"component '{name}': ran in no counted cycle of any class; declare a class of inputs in which it runs" for name in silent]
    return findings


def _calc_ratios(run: ClassRun, component: int) -> Array:
    """ns per instruction of one component in each window instance."""
    chosen = run.steps["component"] == component
    instructions, _ = _sum_openings(run, chosen, run.instructions)
    times, _ = _sum_openings(run, chosen, run.times_ns)
    return times / np.maximum(instructions, 1)


def _sum_openings(run: ClassRun, chosen: Array, values: Array) -> tuple[Array, Array]:
    """@return sums of `values` over the chosen steps of each instance of one window, and the releases of the instances."""
    releases, place = np.unique(run.steps["release_ns"][chosen], return_inverse=True)
    # Floating-point sums are exact here: counts and times are far below 2**53.
    return np.bincount(place, weights=values[chosen], minlength=len(releases)).astype(np.int64), releases


def _describe(values: Array, releases: Array, table: Table) -> Count:
    ordered = np.sort(values)
    worst = int(np.argmax(values))
    return Count(len(values), int(ordered[0]), int(_pick(ordered, 500)), int(ordered[-1]), int(releases[worst]) // table.frame_ns)


def _pick(ordered: Array, permille: int) -> float:
    """Nearest rank, so that the result is an existing value."""
    return ordered[-(-permille * len(ordered) // 1000) - 1]


def _make_limit(what: str, name: str, limit_ns: int, members: Sequence[int], runs: Sequence[ClassRun], pace: Pace, margin_percent: float
                ) -> list[LimitRow]:  # fmt: skip
    """@return the worst window instance of all classes; None if none was counted."""
    worst: tuple[int, ClassRun, int] | None = None
    for run in runs:
        chosen = np.isin(run.steps["component"], members)
        if not chosen.any():
            continue
        sums, releases = _sum_openings(run, chosen, run.instructions)
        place = int(np.argmax(sums))
        if worst is None or int(sums[place]) > worst[0]:
            worst = (int(sums[place]), run, int(releases[place]))
    if worst is None:
        return []
    instructions, run, release = worst
    parts = {index: int(run.instructions[(run.steps["component"] == index) & (run.steps["release_ns"] == release)].sum()) for index in members}
    heaviest = run.table.component_name(max(parts, key=lambda index: parts[index]))
    time_ns = instructions * pace.ns_per_instruction
    needed = time_ns * (1.0 + margin_percent / 100.0)
    return [LimitRow(what, name, limit_ns, run.input_class.name, release // run.table.frame_ns, instructions, heaviest, time_ns, needed)]
