# SPDX-License-Identifier: Apache-2.0
"""Determines the cause of an overrun or a skipped window: a component, another thread of the program, or a cause outside the program.

@satisfies SWR-TIM-044      Design: docs/design/timing.md#verdict
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from mamori_tools.timing.reader import NOT_BACK, Array, Measurement
from mamori_tools.timing.runner import DEVICES, STEAL_NS_MIN, STOLEN
from mamori_tools.timing.switches import IDLE, OWN, PREEMPTED, UNKNOWN_PRIORITY, UNKNOWN_THREAD, WAITING, CoreLog, Switches

COMPONENT, OWN_PROCESS, OUTSIDE, NOT_KNOWN = "component", "own process", "outside", "not known"
VERDICTS = (COMPONENT, OWN_PROCESS, OUTSIDE, NOT_KNOWN)

CONTINUED_WITHIN_NS = 50_000_000
"""Maximum delay of the record of a continuation (SIGCONT), because an ordinary thread writes it."""
CONTINUED_AFTER_NS = 5_000_000
"""Tolerance between the end of a wait and the record of the continuation."""
RUNNER_DUE_NS = 500_000
"""A runner that has not run for this time after the deadline was prevented from running."""
USED_SHARE = 0.9
"""If a window used this share of its budget itself, its component is the cause."""


@dataclass(frozen=True)
class Cause:
    """`by`: name of the thread or of a component of another window; empty if there is none. `text`: the evidence, for the report; may be empty."""

    verdict: str
    by: str = ""
    text: str = ""


@dataclass
class _LostTimes:
    """Lost times [ns] by verdict and thread."""

    sums: Counter[str] = field(default_factory=Counter)
    threads: Counter[tuple[str, str]] = field(default_factory=Counter)

    def add(self, verdict: str, by: str, time_ns: int) -> None:
        if time_ns > 0:
            self.sums[verdict] += time_ns
            self.threads[verdict, by] += time_ns

    def get_cause(self) -> Cause:
        """The verdict with the longest time."""
        if not self.sums:
            return Cause(NOT_KNOWN)
        verdict = max(self.sums, key=lambda one: (self.sums[one], -VERDICTS.index(one)))
        if verdict == NOT_KNOWN:
            return Cause(NOT_KNOWN, "", "its switches were not recorded")
        (_, by), time = max(((key, time) for key, time in self.threads.items() if key[0] == verdict), key=lambda pair: pair[1])
        what = f"'{by}' of another window ran" if verdict == COMPONENT else by
        return Cause(verdict, by, f"{what} for {time / 1e3:.1f} us")


@dataclass(frozen=True)
class _Core:
    """The core of a window, with the names of its threads."""

    run: Measurement
    log: CoreLog
    switches: Switches
    window: int
    index: int

    @property
    def thread(self) -> int:
        return self.log.window_threads[self.window]

    def get_priority(self, thread: int) -> int:
        known = self.switches.threads.get(thread)
        return 0 if known is None else known.priority

    def add_lost(self, lost: _LostTimes, begin_ns: int, end_ns: int, waiting: int, neutral: frozenset[int]) -> None:
        """Adds the threads that ran in the interval while the thread `waiting` was ready. `neutral` threads belong to the work itself."""
        covered, priority = begin_ns, self.get_priority(waiting)
        slices = self.log.between(begin_ns, end_ns)
        for number, one in enumerate(slices):
            begin, end = max(covered, int(one["begin_ns"])), min(end_ns, int(one["end_ns"]))
            lost.add(NOT_KNOWN, "", begin - covered)
            covered = max(covered, end)
            thread = int(one["thread"])
            if thread in neutral or end <= begin:
                continue
            if thread == UNKNOWN_THREAD:
                lost.add(NOT_KNOWN, "", end - begin)
            elif int(one["process"]) == IDLE:
                lost.add(OUTSIDE, "the processor was idle (the host did not run the program)", end - begin)
            elif not self._is_own(thread):
                lost.add(OUTSIDE, f"{self.switches.name(thread, int(one['process']))} ran", end - begin)
            elif thread == self.log.runner:
                for use, time in self.run.runner_times[self.index].list_uses(begin, end):
                    lost.add(OWN_PROCESS if use == DEVICES else OUTSIDE, use, time)
            elif working := self._find_component(thread, begin):
                lost.add(COMPONENT, working, end - begin)
            elif self._has_less_than(priority, waiting, slices[number : number + 2]):
                # It ran because the waiting thread was not ready yet, or because the host delayed it.
                lost.add(OUTSIDE, "a thread of lower priority ran (the host did not wake the thread of the window)", end - begin)
            else:
                lost.add(OWN_PROCESS, f"{self.switches.name(thread, int(one['process']))} ran", end - begin)
        lost.add(NOT_KNOWN, "", end_ns - covered)

    def _has_less_than(self, priority: int, waiting: int, slices: Array) -> bool:
        """Whether the thread of the first slice has a lower priority. One that ended before its priority could be read has it if the waiting
        thread preempted it."""
        known = self.get_priority(int(slices[0]["thread"]))
        if known != UNKNOWN_PRIORITY:
            return known < priority
        return len(slices) > 1 and int(slices[0]["left"]) == PREEMPTED and int(slices[1]["thread"]) == waiting

    def calc_presence(self, thread: int, begin_ns: int, end_ns: int) -> int:
        """Time [ns] of a thread on the processor within an interval."""
        return sum(min(end_ns, int(one["end_ns"])) - max(begin_ns, int(one["begin_ns"])) for one in self.log.between(begin_ns, end_ns)
                   if int(one["thread"]) == thread)  # fmt: skip

    def _find_component(self, thread: int, instant: int) -> str:
        """@return component of another window that this thread ran at the instant, for threads without fixed priority; otherwise empty."""
        if thread not in self.log.window_threads or self.get_priority(thread) > 0:
            return ""
        window = self.log.window_threads.index(thread)
        steps = self.run.steps
        found = steps[(steps["start_ns"] <= instant) & ((steps["end_ns"] == NOT_BACK) | (steps["end_ns"] > instant))]
        names = [self.run.table.component_name(int(one)) for one in found["component"] if self.run.table.components[int(one)].window == window]
        return names[0] if names else ""

    def _is_own(self, thread: int) -> bool:
        known = self.switches.threads.get(thread)
        return known is not None and known.kind == OWN

    def find_stop(self, begin_ns: int, end_ns: int, deadline_ns: int) -> int | None:
        """@return instant [ns] within this wait at which the process was stopped; None if it only waited: then its runner runs at the
        deadline, and no SIGCONT follows."""
        quiet = self._list_quiet(begin_ns, end_ns)
        for begin, end in quiet:
            if begin <= deadline_ns <= end - RUNNER_DUE_NS:
                return begin
        noted = [instant for instant in self.switches.continued_ns if begin_ns <= instant <= end_ns + CONTINUED_AFTER_NS]
        near = [(end - begin, begin) for begin, end in quiet for instant in noted
                if instant - CONTINUED_WITHIN_NS <= end <= instant + CONTINUED_AFTER_NS]  # fmt: skip
        return max(near)[1] if near else None

    def _list_quiet(self, begin_ns: int, end_ns: int) -> list[tuple[int, int]]:
        """Intervals of a wait without a thread of the program on the processor."""
        known = self.switches.threads.get(self.log.runner)
        quiet, last = [], begin_ns
        for one in self.log.between(begin_ns, end_ns):
            if known is not None and int(one["process"]) == known.process:
                quiet.append((last, int(one["begin_ns"])))
                last = int(one["end_ns"])
        return [*quiet, (last, end_ns)]


def _find_core(run: Measurement, window: int) -> _Core | None:
    """@return None without recorded switches."""
    switches, core = run.switches, run.table.windows[window].core
    if switches is None or core >= len(switches.cores) or not switches.cores[core].is_known or not len(switches.cores[core].slices):
        return None
    return _Core(run, switches.cores[core], switches, window, core)


def find_late_cause(run: Measurement, opening: Array) -> Cause:
    """Determines why the runner did not start this window instance at its planned instant."""
    release, woke = int(opening["release_ns"]), int(opening["woke_ns"])
    core = _find_core(run, int(opening["window"]))
    if core is None:
        return _find_late_cause_without_log(run, release, woke)
    lost = _LostTimes()
    core.add_lost(lost, release, woke, core.log.runner, frozenset())
    return lost.get_cause()


def _find_late_cause_without_log(run: Measurement, release: int, woke: int) -> Cause:
    if run.switches is not None and any(release <= one <= woke + CONTINUED_WITHIN_NS for one in run.switches.continued_ns):
        return Cause(OUTSIDE, "", "the process was stopped")
    return Cause(NOT_KNOWN)


def find_overrun_cause(run: Measurement, opening: Array, steps: Array, uses: Array | None, deadline_ns: int, late: int | None) -> Cause:
    """@param steps of the window instance, in order of time, with their `uses`. @param late index of the step that had not returned at the
    deadline; None if all had."""
    window = int(opening["window"])
    core = _find_core(run, window)
    if core is None or core.thread == 0:
        return _find_cause_without_log(run, opening, steps, uses, late)
    woke, budget = int(opening["woke_ns"]), run.table.windows[window].budget_ns
    last = None if late is None else int(steps["end_ns"][late])
    end = deadline_ns if last is None else last if last != NOT_BACK else int(core.log.slices["end_ns"][-1])
    lost = _LostTimes()
    needed = _account(core, lost, woke, deadline_ns, max(deadline_ns, end), steps)
    stolen = 0 if uses is None else _calc_stolen(core, steps, uses)
    if stolen >= STEAL_NS_MIN:
        needed -= stolen
        # Limited to the time of the thread on the processor before the deadline: later time cannot cause the loss.
        lost.add(OUTSIDE, STOLEN, min(stolen, core.calc_presence(core.thread, woke, deadline_ns)))
    if needed > budget:
        return Cause(COMPONENT)
    core.add_lost(lost, int(opening["release_ns"]), woke, core.log.runner, frozenset())
    lost_ns = sum(lost.sums.values())
    if needed >= USED_SHARE * budget and lost_ns < (1.0 - USED_SHARE) * budget:
        return Cause(COMPONENT)
    return lost.get_cause()


def _account(core: _Core, lost: _LostTimes, woke: int, deadline: int, end: int, steps: Array) -> int:
    """Follows the thread of the window. Adds the waits before the deadline to `lost`. @return time [ns] that the work needed until `end`:
    on the processor, or waiting within a step."""
    others = frozenset({core.thread, core.log.runner})
    needed, covered, left = 0, woke, WAITING
    for one in core.log.between(woke, end):
        if int(one["thread"]) != core.thread:
            continue
        begin, stop = max(woke, int(one["begin_ns"])), min(end, int(one["end_ns"]))
        needed += _account_gap(core, lost, covered, begin, deadline, left, steps, others) + max(0, stop - begin)
        covered, left = max(covered, stop), int(one["left"])
    return needed + _account_gap(core, lost, covered, end, deadline, left, steps, others)


def _account_gap(core: _Core, lost: _LostTimes, begin: int, end: int, deadline: int, left: int, steps: Array, others: frozenset[int]) -> int:
    """@return time [ns] of a wait that the step caused itself, or of the executive."""
    if end <= begin:
        return 0
    if left == WAITING and _is_in_step(steps, begin):
        stop = core.find_stop(begin, end, deadline)
        if stop is None:
            return end - begin
        # After the stop, the thread waits for the processor.
        lost.add(OUTSIDE, "the process was stopped or held", end - stop)
        return stop - begin
    core.add_lost(lost, begin, min(end, deadline), core.thread, others)
    return core.calc_presence(core.log.runner, begin, min(end, deadline))


def _is_in_step(steps: Array, instant: int) -> bool:
    return bool(((steps["start_ns"] <= instant) & ((steps["end_ns"] == NOT_BACK) | (steps["end_ns"] > instant))).any())


def _calc_stolen(core: _Core, steps: Array, uses: Array) -> int:
    """Time [ns] in which the steps were on the processor without CPU time."""
    stolen = 0
    for step, use in zip(steps, uses, strict=True):
        if int(use["cpu_ns"]) >= 0:
            present = core.calc_presence(core.thread, int(step["start_ns"]), int(step["end_ns"]))
            stolen += max(0, present - int(use["cpu_ns"]))
    return stolen


def _find_cause_without_log(run: Measurement, opening: Array, steps: Array, uses: Array | None, late: int | None) -> Cause:
    """Uses CPU time and switches of the steps only. They show whether the step worked, waited or was preempted, but not by which thread."""
    if late is None:
        return Cause(NOT_KNOWN)
    start, end = int(steps["start_ns"][late]), int(steps["end_ns"][late])
    woke, budget = int(opening["woke_ns"]), run.table.windows[int(opening["window"])].budget_ns
    if end == NOT_BACK:
        return Cause(COMPONENT)
    if uses is None:
        return Cause(COMPONENT if end - woke > budget else NOT_KNOWN)
    continued = run.switches.continued_ns if run.switches is not None else ()
    if any(start <= instant <= end + CONTINUED_WITHIN_NS for instant in continued):
        return Cause(OUTSIDE, "", "the process was stopped")
    use = uses[late]
    needed = end - start if use["voluntary"] else int(use["cpu_ns"])
    if start - woke + needed > budget:
        return Cause(COMPONENT)
    return Cause(NOT_KNOWN, "", f"its thread waited {(end - start - int(use['cpu_ns'])) / 1e3:.1f} us for the processor")
