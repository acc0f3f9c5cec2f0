# SPDX-License-Identifier: Apache-2.0
"""Evaluates the measurements of windows and components: pure functions from arrays to figures.

@satisfies SWR-TIM-012, SWR-TIM-013, SWR-TIM-014, SWR-TIM-040, SWR-TIM-044      Design: docs/design/timing.md#figures
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mamori_tools.timing.reader import COMPLETED, MISSED, NOT_BACK, OUTCOMES, OVERRUN, Array, Measurement
from mamori_tools.timing.verdict import COMPONENT, OWN_PROCESS, Cause, find_late_cause, find_overrun_cause

OPENED = (COMPLETED, OVERRUN, MISSED)
"""Outcomes with a lateness; other instances had no window start."""

TENTH_MIN = 100
"""Minimum values in a tenth of a run, so that a few late releases do not change the median."""


@dataclass(frozen=True)
class Distribution:
    """Order statistics of times [ns]: each quantile is a measured value (nearest rank)."""

    count: int
    min: int
    p50: int
    p99: int
    p999: int
    max: int


@dataclass(frozen=True)
class Series:
    """Values in order of time [ns], and the release [ns] of the window instance of each."""

    releases: Array
    values: Array


@dataclass(frozen=True)
class Miss:
    """An overrun or skipped window. `component`: the component that had not returned or not begun; empty if none ran. `verdict`: the cause
    (verdict.py). `by`: the thread that ran instead, or a component of another window; may be empty. `since_cycle`: cycle in which the
    work began that had not returned."""

    cycle: int
    release_ns: int
    window: str
    outcome: str
    component: str | None
    late_ns: int
    reason: str
    verdict: str
    by: str
    since_cycle: int

    @property
    def is_of_code(self) -> bool:
        """True if the program is the cause: a component or another thread."""
        return self.verdict in (COMPONENT, OWN_PROCESS)


@dataclass(frozen=True)
class Drift:
    """Drift of one window [ns]. `planned_ns`: maximum distance of a planned instant from the schedule; a missing instance counts as one
    period. Other fields: median lateness in the first and the last tenth of the run; None if a tenth has fewer than TENTH_MIN values."""

    planned_ns: int
    first_ns: int | None
    last_ns: int | None

    @property
    def shift_ns(self) -> int | None:
        return None if self.first_ns is None or self.last_ns is None else self.last_ns - self.first_ns


@dataclass(frozen=True)
class WindowUse:
    """Use of the processor during the instances of a window. `cpu`: CPU time of its thread per instance whose steps all returned.
    `voluntary`, `involuntary`: switches away from this thread within steps. `own_ns`, `outside_ns`: time of other threads of the program, and
    of other processes and the kernel, from planned start to end, over all instances; None without recorded switches. `longest_by`: thread with
    the longest stay in the instance with the most such time."""

    cpu: Distribution | None
    voluntary: int
    involuntary: int
    own_ns: int | None
    outside_ns: int | None
    longest_by: str


@dataclass(frozen=True)
class WindowRow:
    """One window: plan and measurement. `response` is closed - release, `used` is closed - woke. The margins are the minimum remainders of
    length and budget; None if nothing was measured."""

    window: str
    core: int
    offset_ns: int
    length_ns: int
    period_ns: int
    budget_ns: int
    outcomes: dict[str, int]
    lateness: Distribution | None
    drift: Drift
    response: Distribution | None
    used_max_ns: int | None
    budget_margin_ns: int | None
    length_margin_ns: int | None
    use: WindowUse | None


@dataclass(frozen=True)
class ComponentRow:
    """One component: execution time per window instance, and the declared worst case. `unfinished` instances had not returned."""

    component: str
    window: str
    declared_ns: int | None
    execution: Distribution | None
    margin_ns: int | None
    unfinished: int


def describe(values: Array) -> Distribution | None:
    """@param values [ns], any order. @return None if there is no value."""
    if not len(values):
        return None
    ordered = np.sort(values)
    return Distribution(len(ordered), int(ordered[0]), _pick(ordered, 500), _pick(ordered, 990), _pick(ordered, 999), int(ordered[-1]))


def _pick(ordered: Array, permille: int) -> int:
    """The smallest value that at least `permille` thousandths of all values do not exceed. Uses integers, because 0.999 is not exact."""
    return int(ordered[-(-permille * len(ordered) // 1000) - 1])


def calc_lateness(run: Measurement, window: int) -> Series:
    """woke - release of each released window instance."""
    rows = run.openings[run.rows_of(window)]
    rows = rows[np.isin(rows["outcome"], OPENED)]
    return Series(rows["release_ns"], rows["woke_ns"] - rows["release_ns"])


def calc_drift(run: Measurement, index: int) -> Drift:
    """Planned instants, compared with the first one plus whole periods, and the change of lateness during the run."""
    window = run.table.windows[index]
    releases = run.openings["release_ns"][run.rows_of(index)]
    first = releases[:1] - (releases[:1] - window.offset_ns) % window.period_ns
    planned = int(np.abs(releases - first - np.arange(len(releases)) * window.period_ns).max(initial=0))
    late = calc_lateness(run, index).values
    tenth = -(-len(late) // 10)
    ends = [describe(part) if tenth >= TENTH_MIN else None for part in (late[:tenth], late[len(late) - tenth :])]
    return Drift(planned, *(None if part is None else part.p50 for part in ends))


def calc_execution(run: Measurement, component: int) -> tuple[Series, int]:
    """Sum of the steps of one component in each window instance in which all its steps returned. @return the sums, and the number of
    instances with a step that did not return."""
    of_it = run.steps["component"] == component
    steps, rows = run.steps[of_it], run.opening_of_step[of_it]
    if not len(steps):
        return Series(np.zeros(0, np.int64), np.zeros(0, np.int64)), 0
    first = int(rows.min())
    length = int(rows.max()) - first + 1
    is_open = np.bincount(rows - first, weights=steps["end_ns"] == NOT_BACK, minlength=length) > 0
    # Floating-point sums are exact here: instants are below 2**53 ns.
    sums = np.bincount(rows - first, weights=steps["end_ns"] - steps["start_ns"], minlength=length).astype(np.int64)
    ran = np.bincount(rows - first, minlength=length) > 0
    whole = ran & ~is_open
    return Series(run.openings["release_ns"][first : first + length][whole], sums[whole]), int(is_open.sum())


def count_cut(run: Measurement, component: int) -> int:
    """Overruns of the window of the component, whose total time is unknown."""
    window = run.table.components[component].window
    return 0 if window is None else int((run.openings[run.rows_of(window)]["outcome"] == OVERRUN).sum())


def list_windows(run: Measurement) -> list[WindowRow]:
    """The schedulability table, window by window."""
    return [_make_window(run, index) for index in range(len(run.table.windows))]


def _make_window(run: Measurement, index: int) -> WindowRow:
    window = run.table.windows[index]
    rows = run.openings[run.rows_of(index)]
    counts = np.bincount(rows["outcome"], minlength=len(OUTCOMES))
    ran = rows[np.isin(rows["outcome"], (COMPLETED, OVERRUN))]
    response = describe(ran["closed_ns"] - ran["release_ns"])
    used = int((ran["closed_ns"] - ran["woke_ns"]).max()) if len(ran) else None
    return WindowRow(
        window.name, window.core, window.offset_ns, window.length_ns, window.period_ns, window.budget_ns,
        {name: int(count) for name, count in zip(OUTCOMES, counts, strict=True)},
        describe(calc_lateness(run, index).values), calc_drift(run, index), response, used,
        None if used is None else window.budget_ns - used,
        None if response is None else window.length_ns - response.max, _make_use(run, index),
    )  # fmt: skip


def _make_use(run: Measurement, index: int) -> WindowUse | None:
    """@return None if the program did not record it."""
    switches = run.switches
    if switches is None:
        return None
    rows = run.rows_of(index)
    of_it = (run.opening_of_step >= rows.start) & (run.opening_of_step < rows.stop)
    use, opening = switches.step_use[of_it], run.opening_of_step[of_it] - rows.start
    count = rows.stop - rows.start
    is_open = np.bincount(opening, weights=use["cpu_ns"] < 0, minlength=count) > 0
    cpu = np.bincount(opening, weights=use["cpu_ns"], minlength=count).astype(np.int64)
    ran = np.bincount(opening, minlength=count) > 0
    core = run.table.windows[index].core
    is_known = core < len(switches.cores) and switches.cores[core].is_known
    instead = switches.window_use[rows]
    longest = int(np.argmax(instead["own_ns"] + instead["outside_ns"])) if len(instead) else 0
    thread = int(instead["thread"][longest]) if is_known and len(instead) else 0
    return WindowUse(
        describe(cpu[ran & ~is_open]), int(use["voluntary"].sum()), int(use["involuntary"].sum()),
        int(instead["own_ns"].sum()) if is_known else None, int(instead["outside_ns"].sum()) if is_known else None,
        switches.name(thread, 0) if thread else "",
    )  # fmt: skip


def list_components(run: Measurement) -> list[ComponentRow]:
    """Execution times of all components of a window."""
    rows = []
    for index, component in enumerate(run.table.components):
        if component.window is None:
            continue
        series, unfinished = calc_execution(run, index)
        execution = describe(series.values)
        declared = component.worst_case_ns
        margin = None if execution is None or declared is None else declared - execution.max
        rows.append(ComponentRow(component.name, run.table.windows[component.window].name, declared, execution, margin, unfinished))
    return rows


def list_misses(run: Measurement) -> list[Miss]:
    """Each overrun and skipped window, in order of time."""
    chosen = np.flatnonzero(np.isin(run.openings["outcome"], (OVERRUN, MISSED)))
    order = np.argsort(run.openings["release_ns"][chosen], kind="stable")
    index = _index_steps(run)
    return [_make_miss(run, index, int(row)) for row in chosen[order]]


@dataclass(frozen=True)
class _StepIndex:
    """Steps sorted by the row of their window instance, and steps longer than the period of their window. This makes the evaluation fast
    even if every window of a run overruns."""

    numbers: Array
    steps: Array
    rows: Array
    long_steps: Array
    long_rows: Array

    def list_candidates(self, first: int, row: int) -> Array:
        """Steps of window instance `row`, and the last long step before it, since row `first`. While work hangs, no other work
        of its window runs."""
        begin, end = np.searchsorted(self.rows, [row, row + 1])
        long_begin, long_end = np.searchsorted(self.long_rows, [first, row])
        return np.concatenate((self.long_steps[max(long_begin, long_end - 1) : long_end], self.steps[begin:end]))

    def get_numbers(self, row: int) -> Array:
        """Indices in `Measurement.steps` of the steps of window instance `row`, in order of time."""
        begin, end = np.searchsorted(self.rows, [row, row + 1])
        return self.numbers[begin:end]

    def list_components(self, row: int) -> set[int]:
        """Components with a step in window instance `row`."""
        begin, end = np.searchsorted(self.rows, [row, row + 1])
        return set(self.steps["component"][begin:end].tolist())


def _index_steps(run: Measurement) -> _StepIndex:
    order = np.argsort(run.opening_of_step, kind="stable")
    steps, rows = run.steps[order], run.opening_of_step[order]
    period = np.array([window.period_ns for window in run.table.windows])[run.openings["window"][rows]]
    is_long = (steps["end_ns"] == NOT_BACK) | (steps["end_ns"] >= steps["release_ns"] + period)
    return _StepIndex(order, steps, rows, steps[is_long], rows[is_long])


def _make_miss(run: Measurement, index: _StepIndex, row: int) -> Miss:
    opening = run.openings[row]
    window = run.table.windows[int(opening["window"])]
    release, late = int(opening["release_ns"]), int(opening["woke_ns"] - opening["release_ns"])
    cycle = release // run.table.frame_ns
    if opening["outcome"] == MISSED:
        name, reason, cause, begun = None, "started after its planned end", find_late_cause(run, opening), row
    else:
        name, reason, begun = _find_unfinished(run, index, row)
        cause = _find_cause(run, index, begun)
    if cause.verdict == COMPONENT and cause.by:
        name = cause.by
    text = f"{reason}: {cause.text}" if cause.text else reason
    return Miss(cycle, release, window.name, OUTCOMES[int(opening["outcome"])], name, late, text, cause.verdict, cause.by,
                int(run.openings["release_ns"][begun]) // run.table.frame_ns)  # fmt: skip


def _calc_deadline(run: Measurement, row: int) -> int:
    """As in the executive, a late window keeps its budget, but not beyond its planned end."""
    opening = run.openings[row]
    window = run.table.windows[int(opening["window"])]
    return min(int(opening["woke_ns"]) + window.budget_ns, int(opening["release_ns"]) + window.length_ns)


def _find_unfinished(run: Measurement, index: _StepIndex, row: int) -> tuple[str | None, str, int]:
    """@return component that had not returned at the deadline of an overrun (None if all had), description, and window instance in which the
    work began."""
    opening = run.openings[row]
    number = int(opening["window"])
    window = run.table.windows[number]
    deadline = _calc_deadline(run, row)
    # Includes steps of earlier window instances: while work hangs, its window does not start again.
    steps = index.list_candidates(run.rows_of(number).start, row)
    late = steps[(steps["start_ns"] <= deadline) & ((steps["end_ns"] == NOT_BACK) | (steps["end_ns"] > deadline))]
    if len(late):
        step = late[int(np.argmin(late["start_ns"]))]
        end, name = int(step["end_ns"]), run.table.component_name(int(step["component"]))
        text = "never returned" if end == NOT_BACK else f"returned {(end - deadline) / 1e3:.1f} us after the deadline"
        if step["release_ns"] != opening["release_ns"]:
            begun = run.rows_of(number).start + int(np.searchsorted(run.openings["release_ns"][run.rows_of(number)], step["release_ns"]))
            return name, f"{text}; it began in cycle {int(step['release_ns']) // run.table.frame_ns}", begun
        given = deadline - int(opening["woke_ns"])
        if given < window.budget_ns and NOT_BACK != end <= deadline + window.budget_ns - given:
            return name, f"{text}, which was {(window.budget_ns - given) / 1e3:.1f} us early: the window started late", row
        return name, text, row
    ran = index.list_components(row)
    before = steps[steps["release_ns"] < opening["release_ns"]]
    if not ran and len(before) and opening["closed_ns"] < deadline:
        # The window ended before its deadline: earlier work had not returned at the window start, or had just returned.
        step = before[-1]
        begun = run.rows_of(number).start + int(np.searchsorted(run.openings["release_ns"][run.rows_of(number)], step["release_ns"]))
        text = f"returned {(int(step['end_ns']) - int(opening['woke_ns'])) / 1e3:.1f} us after the window start"
        return run.table.component_name(int(step["component"])), f"{text}; it began in cycle {int(step['release_ns']) // run.table.frame_ns}", begun
    waiting = [component for component in run.table.components_of(number) if component not in ran]
    if waiting:
        return run.table.component_name(waiting[0]), "had not begun at the deadline: its thread did not get the processor", row
    return None, "no step was late: other threads used the processor between steps", row


def _find_cause(run: Measurement, index: _StepIndex, row: int) -> Cause:
    """Determines the cause of the overrun of window instance `row` from its steps."""
    chosen = index.get_numbers(row)
    steps = run.steps[chosen]
    deadline = _calc_deadline(run, row)
    is_late = (steps["start_ns"] <= deadline) & ((steps["end_ns"] == NOT_BACK) | (steps["end_ns"] > deadline))
    uses = None if run.switches is None else run.switches.step_use[chosen]
    return find_overrun_cause(run, run.openings[row], steps, uses, deadline, int(np.argmax(is_late)) if is_late.any() else None)


def list_findings(windows: list[WindowRow], components: list[ComponentRow], misses: list[Miss]) -> list[str]:
    """One line for each overrun that the code caused, each declared worst case that is too low, and each planned instant off the schedule.

    Excludes losses with a cause outside the program.
    """
    findings = []
    for row in components:
        if row.execution is not None and row.margin_ns is not None and row.margin_ns < 0:
            findings.append(f"component '{row.component}': declared worst case {(row.declared_ns or 0) / 1e3:g} us, "
                            f"measured {row.execution.max / 1e3:g} us")  # fmt: skip
    for window in windows:
        overran = [miss for miss in misses if miss.window == window.window and miss.verdict == COMPONENT]
        held = [miss for miss in misses if miss.window == window.window and miss.verdict == OWN_PROCESS]
        if held:
            findings.append(f"window '{window.window}': {len(held)} lost to other threads of the program, first in cycle {held[0].cycle}: "
                            f"{held[0].reason}")  # fmt: skip
        if overran:
            findings.append(f"window '{window.window}': {len(overran)} overran, first in cycle {overran[0].cycle} by "
                            f"'{overran[0].component}', which {overran[0].reason}")  # fmt: skip
        if window.drift.planned_ns:
            findings.append(f"window '{window.window}': planned instants are up to {window.drift.planned_ns / 1e3:g} us off the schedule")
    return findings


def list_limit_findings(windows: list[WindowRow], misses: list[Miss], missed_max: int | None, late_ns_max: int | None) -> list[str]:
    """Findings of --max-missed and --max-late, regardless of the cause. @param missed_max, late_ns_max: None for no limit."""
    findings = []
    if missed_max is not None and len(misses) > missed_max:
        findings.append(f"--max-missed: {len(misses)} windows were skipped or overran, at most {missed_max} are permitted; first in cycle "
                        f"{misses[0].cycle}, window '{misses[0].window}', verdict {misses[0].verdict}")  # fmt: skip
    for window in windows:
        if late_ns_max is not None and window.lateness is not None and window.lateness.max > late_ns_max:
            findings.append(f"--max-late: window '{window.window}' was late by up to {window.lateness.max / 1e3:g} us, at most "
                            f"{late_ns_max / 1e3:g} us are permitted")  # fmt: skip
    return findings


def list_drift_notes(windows: list[WindowRow]) -> list[str]:
    """Windows whose median lateness changed by more than a tenth of their period. Not a finding, because the host alone can cause it."""
    return [
        f"window '{window.window}': the median lateness changed by {window.drift.shift_ns / 1e3:g} us from the first to the last tenth of the run"
        for window in windows
        if window.drift.shift_ns is not None and abs(window.drift.shift_ns) * 10 > window.period_ns
    ]
