# SPDX-License-Identifier: Apache-2.0
# Goal: the cause of an overrun or a skipped window follows from who ran on the processor, and is never invented.
# Method: one window with a budget of 200 us in a length of 300 us, whose second instance is lost; the slices of the processor are given.
from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from timing_run import make_run, make_switches, make_table, write_run, write_switches

from mamori_tools.timing.analysis import Miss, list_findings, list_limit_findings, list_misses, list_windows
from mamori_tools.timing.reader import COMPLETED, MISSED, NOT_BACK, OPENING, OVERRUN, STEP, Measurement, read_measurement
from mamori_tools.timing.switches import NO_STATE
from mamori_tools.timing.verdict import COMPONENT, NOT_KNOWN, OUTSIDE, OWN_PROCESS
from mamori_trace.base.errors import InputError

TABLE = make_table(windows=(("work", 0, 100, 300, 1000, 200),), components=(("first", 0, None, 0),), connections=())
US = 1000
RUNNER, WORK, OWN, LOW, BRIEF, OTHER, KERNEL, ENDED = 11, 20, 31, 32, 33, 41, 42, 43
PREEMPTED, WAITS = 0, 1
PROCESS = {RUNNER: 10, WORK: 10, OWN: 10, LOW: 10, BRIEF: 10, OTHER: 41, KERNEL: 42, ENDED: 43, 0: 0, 2**32 - 1: 10}
THREADS = [{"thread": OWN, "process": 10, "kind": 0, "priority": 85, "name": "burner"},
           {"thread": LOW, "process": 10, "kind": 0, "priority": 60, "name": "low"},
           {"thread": OTHER, "process": 41, "kind": 1, "priority": 0, "name": "hog"},
           {"thread": KERNEL, "process": 42, "kind": 2, "priority": 0, "name": "irq"}]  # fmt: skip

Slices = Sequence[tuple[float, float, int, int]]
"""Begin and end [us] from the planned start, thread, how it left."""


def read(folder: Path, opening: tuple[float, float, int], step: tuple[float, float | None] | None, slices: Slices, use: tuple[int, int, int] = (-1, 0, 0),
         threads: Sequence[dict[str, Any]] = tuple(THREADS), **switches: Any) -> Measurement:  # fmt: skip
    """A run of two window instances. @param opening, step instants [us] of the second one. @param use of its step."""
    openings = np.zeros(2, OPENING)
    openings[0] = (1100 * US, 1110 * US, 1190 * US, 0, COMPLETED)
    release = 2100 * US
    openings[1] = (release, release + int(opening[0] * US), release + int(opening[1] * US), 0, opening[2])
    rows = [(1100 * US, 1112 * US, 1180 * US, 0, 0)]
    if step is not None:
        rows.append((release, release + int(step[0] * US), NOT_BACK if step[1] is None else release + int(step[1] * US), 0, 0))
    times = [(release + int(begin * US), release + int(end * US), thread, PROCESS[thread], left) for begin, end, thread, left in slices]
    run = make_run(TABLE, 2, 2) | {"switches": make_switches(threads, **switches)}
    write_run(folder, TABLE, openings, np.array(rows, STEP), run)
    write_switches(folder, 2, [(68 * US, 0, 0), use][: len(rows)], times)
    return read_measurement(folder)


def judge(folder: Path, *arguments: Any, **named: Any) -> Miss:
    return list_misses(read(folder, *arguments, **named))[0]


LATE = (310, 310, MISSED)
CUT = (10, 211, OVERRUN)


@pytest.mark.verifies("SWR-TIM-044")
@pytest.mark.parametrize(("slices", "verdict", "said"), [
    ([(-50, 300, OWN, WAITS), (300, 320, RUNNER, WAITS)], OWN_PROCESS, "thread 31 of the program ('burner') ran for 300.0 us"),
    ([(-50, 320, RUNNER, WAITS)], OWN_PROCESS, "the thread of the windows ran (devices, observers) for 310.0 us"),
    ([(-50, 300, OTHER, PREEMPTED), (300, 320, RUNNER, WAITS)], OUTSIDE, "process 41 ('hog') ran for 300.0 us"),
    ([(-50, 300, KERNEL, PREEMPTED), (300, 320, RUNNER, WAITS)], OUTSIDE, "kernel thread 42 ('irq') ran for 300.0 us"),
    ([(-50, 300, ENDED, PREEMPTED), (300, 320, RUNNER, WAITS)], OUTSIDE, "process 43 (ended) ran for 300.0 us"),
    ([(-50, 300, 0, PREEMPTED), (300, 320, RUNNER, WAITS)], OUTSIDE, "the processor was idle"),
    ([(-50, 300, LOW, PREEMPTED), (300, 320, RUNNER, WAITS)], OUTSIDE, "a thread of lower priority ran (the host did not wake the"),
    ([(-50, 300, 2**32 - 1, PREEMPTED), (300, 320, RUNNER, WAITS)], NOT_KNOWN, "its switches were not recorded"),
    ([(200, 300, OWN, WAITS), (300, 320, RUNNER, WAITS)], NOT_KNOWN, "its switches were not recorded"),
    ([(-50, 100, OTHER, PREEMPTED), (100, 300, OWN, WAITS), (300, 320, RUNNER, WAITS)], OWN_PROCESS, "ran for 200.0 us"),
])  # fmt: skip
def test_skipped_window_is_caused_by_who_held_the_runner_longest(tmp_path: Path, slices: Slices, verdict: str, said: str) -> None:
    miss = judge(tmp_path, LATE, None, slices)

    assert (miss.verdict, miss.component) == (verdict, None)
    assert said in miss.reason and miss.reason.startswith("started after its planned end")


@pytest.mark.verifies("SWR-TIM-044", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("end", "verdict"), [(334, OWN_PROCESS), (335, COMPONENT)])
def test_component_is_blamed_only_if_it_needed_more_than_the_budget_itself(tmp_path: Path, end: int, verdict: str) -> None:
    slices = [(-5, 12, RUNNER, WAITS), (12, 50, WORK, PREEMPTED), (50, 170, OWN, WAITS), (170, 211, WORK, PREEMPTED), (211, 215, RUNNER, WAITS),
              (215, end + 5, WORK, WAITS)]  # fmt: skip

    miss = judge(tmp_path, CUT, (12, end), slices, use=((end - 12 - 124) * US, 0, 2))

    # Before the deadline: 2 us of the runner, 38 us and 41 us of the work. Afterwards: up to 119 us.
    assert (miss.verdict, miss.component) == (verdict, "first")
    assert ("thread 31 of the program ('burner') ran for 120.0 us" in miss.reason) == (verdict == OWN_PROCESS)


@pytest.mark.verifies("SWR-TIM-044", polarity="violation")
@pytest.mark.parametrize("end", [None, 300])
def test_step_that_works_or_waits_by_itself_is_of_the_component(tmp_path: Path, end: int | None) -> None:
    working = judge(tmp_path / "works", CUT, (12, end), [(-5, 12, RUNNER, WAITS), (12, 211, WORK, PREEMPTED), (211, 215, RUNNER, WAITS),
                                                         (215, 305, WORK, WAITS)])  # fmt: skip
    waiting = judge(tmp_path / "waits", CUT, (12, end), [(-5, 12, RUNNER, WAITS), (12, 20, WORK, WAITS), (20, 210, OTHER, PREEMPTED),
                                                         (210, 215, RUNNER, WAITS), (215, 290, OTHER, PREEMPTED), (290, 310, WORK, WAITS)])  # fmt: skip

    assert [miss.verdict for miss in (working, waiting)] == [COMPONENT, COMPONENT]


@pytest.mark.verifies("SWR-TIM-044", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(("runner", "continued", "verdict"), [
    (1200, None, OUTSIDE),  # the runner did not run at the deadline
    (211, None, COMPONENT), (211, 1200, COMPONENT),  # it ran; a stop long after the deadline is not the cause
    (211, 100_000, COMPONENT),
])  # fmt: skip
def test_stopped_process_does_not_count_as_a_waiting_component(tmp_path: Path, runner: int, continued: int | None, verdict: str) -> None:
    slices = [(-5, 12, RUNNER, WAITS), (12, 50, WORK, WAITS), (50, runner, 0, PREEMPTED), (runner, runner + 5, RUNNER, WAITS),
              (runner + 5, 1250, 0, PREEMPTED), (1250, 1310, WORK, WAITS)]  # fmt: skip
    instants = [] if continued is None else [(2100 + continued) * US]

    miss = judge(tmp_path, (10, runner + 1, OVERRUN), (12, 1300), slices, continued_ns=instants)

    assert miss.verdict == verdict


@pytest.mark.verifies("SWR-TIM-044", technique="equivalence_classes")
def test_short_stop_before_the_deadline_is_recognised_by_the_continuation(tmp_path: Path) -> None:
    slices = [(-5, 12, RUNNER, WAITS), (12, 50, WORK, WAITS), (50, 180, 0, PREEMPTED), (180, 211, WORK, PREEMPTED), (211, 215, RUNNER, WAITS),
              (215, 300, WORK, WAITS)]  # fmt: skip

    stopped = judge(tmp_path / "stopped", CUT, (12, 290), slices, continued_ns=[2281 * US])
    waited = judge(tmp_path / "waited", CUT, (12, 290), slices)

    assert (stopped.verdict, waited.verdict) == (OUTSIDE, COMPONENT)
    assert "the process was stopped or held for 130.0 us" in stopped.reason


@pytest.mark.verifies("SWR-TIM-044", technique="error_guessing")
def test_presence_without_cpu_time_belongs_to_the_hypervisor(tmp_path: Path) -> None:
    slices = [(-5, 12, RUNNER, WAITS), (12, 305, WORK, WAITS)]

    stolen = judge(tmp_path / "stolen", CUT, (12, 300), slices, use=(100 * US, 0, 0))
    worked = judge(tmp_path / "worked", CUT, (12, 300), slices, use=(288 * US, 0, 0))

    assert (stolen.verdict, worked.verdict) == (OUTSIDE, COMPONENT)
    assert "the hypervisor or interrupts used the processor for 188.0 us" in stolen.reason


@pytest.mark.verifies("SWR-TIM-044", technique="error_guessing")
def test_late_release_that_shortened_the_budget_counts_for_its_cause(tmp_path: Path) -> None:
    slices = [(-50, 240, OTHER, PREEMPTED), (240, 252, RUNNER, WAITS), (252, 301, WORK, PREEMPTED), (301, 305, RUNNER, WAITS), (305, 345, WORK, WAITS)]

    miss = judge(tmp_path, (250, 301, OVERRUN), (252, 340), slices)

    assert (miss.verdict, miss.by) == (OUTSIDE, "process 41 ('hog') ran")


@pytest.mark.verifies("SWR-TIM-044", technique="error_guessing", polarity="violation")
def test_component_of_another_window_that_holds_a_runner_without_priority_is_blamed(tmp_path: Path) -> None:
    table = make_table(windows=(("work", 0, 100, 300, 1000, 200), ("next", 0, 500, 300, 1000, 200)),
                       components=(("first", 0, None, 0), ("second", 1, None, 0)), connections=())  # fmt: skip
    openings = np.array([(1_100_000, 1_110_000, 1_311_000, 0, OVERRUN), (1_500_000, 1_850_000, 1_850_000, 1, MISSED)], OPENING)
    steps = np.array([(1_100_000, 1_112_000, 2_000_000, 0, 0)], STEP)
    switches = make_switches(windows=2)
    switches["threads"] = [row | {"priority": 0} for row in switches["threads"]]
    write_run(tmp_path, table, openings, steps, make_run(table, 1, 1) | {"switches": switches})
    write_switches(tmp_path, 2, [(888_000, 0, 0)], [(1_100_000, 1_112_000, RUNNER, 10, WAITS), (1_112_000, 1_311_000, WORK, 10, PREEMPTED),
                                                    (1_311_000, 1_312_000, RUNNER, 10, WAITS), (1_312_000, 1_845_000, WORK, 10, PREEMPTED),
                                                    (1_845_000, 1_860_000, RUNNER, 10, WAITS), (1_860_000, 2_001_000, WORK, 10, WAITS)])  # fmt: skip

    own, other = list_misses(read_measurement(tmp_path))

    assert (own.verdict, own.component) == (COMPONENT, "first")
    assert (other.verdict, other.component) == (COMPONENT, "first")
    assert "'first' of another window ran for 345.0 us" in other.reason


@pytest.mark.verifies("SWR-TIM-044", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(("end", "use", "continued", "verdict"), [
    (300, (280 * US, 0, 0), [], COMPONENT), (300, (50 * US, 2, 0), [], COMPONENT), (300, (50 * US, 0, 3), [], NOT_KNOWN),
    (None, (-1, 0, 0), [], COMPONENT), (300, (50 * US, 2, 0), [2380 * US], OUTSIDE),
])  # fmt: skip
def test_without_switches_cpu_time_decides_or_the_cause_is_not_known(tmp_path: Path, end: int | None, use: tuple[int, int, int], continued: list[int],
                                                                     verdict: str) -> None:  # fmt: skip
    assert judge(tmp_path, CUT, (12, end), [], use=use, errno=1, continued_ns=continued).verdict == verdict


@pytest.mark.verifies("SWR-TIM-044", technique="equivalence_classes")
def test_without_switches_a_skipped_window_is_not_known_or_the_program_was_stopped(tmp_path: Path) -> None:
    assert judge(tmp_path / "none", LATE, None, [], errno=1).verdict == NOT_KNOWN
    assert judge(tmp_path / "stopped", LATE, None, [], errno=1, continued_ns=[2405 * US]).verdict == OUTSIDE


@pytest.mark.verifies("SWR-TIM-044", polarity="violation")
def test_only_the_program_itself_causes_findings(tmp_path: Path) -> None:
    own = read(tmp_path / "own", LATE, None, [(-50, 300, OWN, WAITS), (300, 320, RUNNER, WAITS)])
    other = read(tmp_path / "other", LATE, None, [(-50, 300, OTHER, PREEMPTED), (300, 320, RUNNER, WAITS)])

    assert list_findings(list_windows(own), [], list_misses(own)) == [
        "window 'work': 1 lost to other threads of the program, first in cycle 2: started after its planned end: "
        "thread 31 of the program ('burner') ran for 300.0 us"]  # fmt: skip
    assert list_findings(list_windows(other), [], list_misses(other)) == []


@pytest.mark.verifies("SWR-TIM-043")
def test_use_of_the_processor_is_shown_per_window(tmp_path: Path) -> None:
    run = read(tmp_path, (10, 90, COMPLETED), (12, 80), [], use=(60 * US, 1, 2))
    assert run.switches is not None
    run.switches.window_use[1] = (5 * US, 7 * US, OWN, NO_STATE, 0, -1, -1)

    use = list_windows(run)[0].use

    assert use is not None and use.cpu is not None
    assert (use.cpu.min, use.cpu.max, use.voluntary, use.involuntary, use.own_ns, use.outside_ns) == (60 * US, 68 * US, 1, 2, 5 * US, 7 * US)
    assert use.longest_by == "thread 31 of the program ('burner')"


@pytest.mark.verifies("SWR-TIM-043", technique="equivalence_classes")
def test_use_without_switches_is_not_known(tmp_path: Path) -> None:
    use = list_windows(read(tmp_path, (10, 90, COMPLETED), (12, 80), [], use=(60 * US, 1, 2), errno=13))[0].use

    assert use is not None and (use.own_ns, use.outside_ns, use.longest_by, use.involuntary) == (None, None, "", 2)


@pytest.mark.verifies("SWR-TIM-043", technique="error_guessing", polarity="violation")
@pytest.mark.parametrize(("change", "said"), [
    (lambda core: core | {"window_threads": []}, "has 0 threads, the table has 1 windows"),
    (lambda core: core | {"right": {"is_granted": True, "errno": 1}}, "must have an errno if it is not granted"),
    (lambda core: core | {"runner": -1}, "must not be negative"),
])  # fmt: skip
def test_inconsistent_record_of_switches_is_refused(tmp_path: Path, change: Any, said: str) -> None:
    read(tmp_path, CUT, (12, 300), [])
    run = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    run["switches"]["cores"] = [change(core) for core in run["switches"]["cores"]]
    (tmp_path / "run.json").write_text(json.dumps(run), encoding="utf-8")

    with pytest.raises(InputError, match=said):
        read_measurement(tmp_path)


@pytest.mark.verifies("SWR-TIM-043", technique="error_guessing", polarity="violation")
@pytest.mark.parametrize(("openings", "steps", "slices", "said"), [
    (3, 2, [], "window_use.npy: holds 3 rows, openings.npy holds 2"), (2, 1, [], "step_use.npy: holds 1 rows, steps.npy holds 2"),
    (2, 2, [(5, 4, 1, 1, 0)], "not in order of time"), (2, 2, [(5, 6, 1, 1, 0), (4, 5, 1, 1, 0)], "not in order of time"),
])  # fmt: skip
def test_files_of_switches_that_do_not_match_are_refused(tmp_path: Path, openings: int, steps: int, slices: list[tuple[int, ...]], said: str) -> None:
    read(tmp_path, CUT, (12, 300), [])
    write_switches(tmp_path, openings, [(0, 0, 0)] * steps, slices)

    with pytest.raises(InputError) as caught:
        read_measurement(tmp_path)
    assert said in str(caught.value)


@pytest.mark.verifies("SWR-TIM-045", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("missed", "late_us", "count"), [(1, None, 0), (0, None, 1), (None, 310, 0), (None, 309.999, 1), (0, 10, 2), (None, None, 0)])
def test_limits_apply_to_every_cause(tmp_path: Path, missed: int | None, late_us: float | None, count: int) -> None:
    run = read(tmp_path, LATE, None, [(-50, 300, OTHER, PREEMPTED), (300, 320, RUNNER, WAITS)])

    found = list_limit_findings(list_windows(run), list_misses(run), missed, None if late_us is None else round(late_us * US))

    assert len(found) == count


@pytest.mark.verifies("SWR-TIM-044", polarity="violation")
@pytest.mark.parametrize(("closed", "reading", "cpu", "verdict", "said"), [
    # The planned start is at 2100 us; the runner is on the processor from 2050 us to 2420 us and starts the window at 2410 us.
    (1190, (20, 20), 360, OWN_PROCESS, "the thread of the windows ran (devices, observers) for 310.0 us"),
    (2050, (340, 340), 20, OUTSIDE, "the measurement ran (reading of the switches) for 290.0 us"),
    (2050, (170, 170), 190, OWN_PROCESS, "the thread of the windows ran (devices, observers) for 190.0 us"),
    (2050, (340, 40), 20, OUTSIDE, "the hypervisor or interrupts used the processor for 290.0 us"),
    (1190, (20, 20), 311, OWN_PROCESS, "the thread of the windows ran (devices, observers) for 310.0 us"),
    (1190, (20, 20), 310, OWN_PROCESS, "the thread of the windows ran (devices, observers) for 260.0 us"),
    (1190, (20, 20), 60, OUTSIDE, "the hypervisor or interrupts used the processor for 300.0 us"),
    (2390, (5, 5), 300, OUTSIDE, "the executive ran in the window before (slowed by the host) for 290.0 us"),
])  # fmt: skip
def test_time_of_the_runner_is_of_the_program_only_outside_of_the_measurement(tmp_path: Path, closed: int, reading: tuple[int, int], cpu: int,
                                                                              verdict: str, said: str) -> None:  # fmt: skip
    run = read(tmp_path, LATE, None, [(-50, 320, RUNNER, WAITS)])
    assert run.switches is not None
    run.openings["closed_ns"][0] = closed * US
    run.switches.window_use["reading_ns"][0], run.switches.window_use["reading_cpu_ns"][0] = reading[0] * US, reading[1] * US
    run.switches.window_use["runner_cpu_ns"][1] = cpu * US

    miss = list_misses(run)[0]

    assert miss.verdict == verdict and said in miss.reason


@pytest.mark.verifies("SWR-TIM-044", technique="equivalence_classes")
@pytest.mark.parametrize(("left", "next_thread", "verdict", "said"), [
    (WAITS, RUNNER, OWN_PROCESS, "thread 33 of the program ran for 300.0 us"),
    (PREEMPTED, OTHER, OWN_PROCESS, "thread 33 of the program ran for 300.0 us"),
    (PREEMPTED, RUNNER, OUTSIDE, "a thread of lower priority ran"),
])  # fmt: skip
def test_thread_that_ended_before_its_priority_was_read_is_judged_by_how_it_left(tmp_path: Path, left: int, next_thread: int, verdict: str,
                                                                                 said: str) -> None:  # fmt: skip
    ended = {"thread": BRIEF, "process": 10, "kind": 0, "priority": -1, "name": ""}

    miss = judge(tmp_path, LATE, None, [(-50, 300, BRIEF, left), (300, 305, next_thread, WAITS), (305, 320, RUNNER, WAITS)], threads=[*THREADS, ended])

    assert miss.verdict == verdict and said in miss.reason
