# SPDX-License-Identifier: Apache-2.0
"""Goal: the measurement of verdicts counts correct, wrong and exchanged ones. Method: losses with given verdicts and labels."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from mamori_tools.timing.analysis import Miss
from mamori_tools.timing.reader import STEP
from mamori_tools.timing.runner import STOLEN
from mamori_tools.timing.switches import KERNEL, OTHER, OWN, STEP_USE, Thread
from mamori_tools.timing.verdict import COMPONENT, NOT_KNOWN, OUTSIDE, OWN_PROCESS
from verification.real_time import timing_verdict
from verification.real_time.timing_verdict import Tally, judge, main

FRAME_NS = 10_000_000
PROGRAM_PID = 10
OTHERS = (Thread(30, 30, OTHER, 0, "python3"), Thread(12, 12, KERNEL, 0, "kworker/0:1"))
FOREIGN = f"{OTHERS[0].label} ran"


def make_miss(cycle: int, verdict: str, since: int | None = None, window: str = "work", by: str = "") -> Miss:
    return Miss(cycle, cycle * FRAME_NS, window, "overrun", "suspect", 0, "late", verdict, by, cycle if since is None else since)


def make_measured(lost_ns: int = 0) -> Any:
    """One step in cycle 60 that was `lost_ns` longer than its CPU time, and one of another window that had not returned."""
    steps, use = np.zeros(2, STEP), np.zeros(2, STEP_USE)
    steps["release_ns"], steps["start_ns"], steps["end_ns"] = 60 * FRAME_NS, 60 * FRAME_NS, 60 * FRAME_NS + 1_000_000
    use["cpu_ns"] = (1_000_000 - lost_ns, -1)
    return SimpleNamespace(steps=steps, switches=SimpleNamespace(threads={11: Thread(11, PROGRAM_PID, OWN, 80, "")}, step_use=use))


def count(monkeypatch: pytest.MonkeyPatch, misses: list[Miss], *labels: tuple[int, str], lost_ns: int = 0) -> Tally:
    monkeypatch.setattr(timing_verdict, "list_misses", lambda run: misses)
    tally = Tally()
    rows = [{"kind": "spin", "label": label, "cycle": cycle, "last_cycle": cycle + 1} for cycle, label in labels]
    judge(make_measured(lost_ns), rows, tally)
    return tally


def count_twenty(monkeypatch: pytest.MonkeyPatch, wanted: str, wrong: int, by: str, lost_ns: int = 0) -> Tally:
    """Twenty events, `wrong` of them with the verdict `outside` by `by`."""
    labels = [(cycle, wanted) for cycle in range(60, 260, 10)]
    misses = [make_miss(cycle, OUTSIDE, by=by) if number < wrong else make_miss(cycle, wanted) for number, (cycle, _) in enumerate(labels)]
    return count(monkeypatch, misses, *labels, lost_ns=lost_ns)


@pytest.mark.verifies("SWR-TIM-044", polarity="violation")
@pytest.mark.parametrize(("found", "wanted", "verdict"), [
    (COMPONENT, COMPONENT, "passed"), (OWN_PROCESS, OWN_PROCESS, "passed"), (COMPONENT, OUTSIDE, "failed"), (COMPONENT, OWN_PROCESS, "failed"),
    (OWN_PROCESS, COMPONENT, "failed"), (NOT_KNOWN, COMPONENT, "failed"), (OUTSIDE, COMPONENT, "failed"), (OUTSIDE, OWN_PROCESS, "failed"),
])  # fmt: skip
def test_one_wrong_event_decides_by_what_it_names(monkeypatch: pytest.MonkeyPatch, found: str, wanted: str, verdict: str) -> None:
    assert count(monkeypatch, [make_miss(60, found)], (60, wanted)).verdict == verdict


@pytest.mark.verifies("SWR-TIM-044", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(("by", "verdict"), [
    (FOREIGN, "inconclusive"), (f"{OTHERS[1].label} ran", "inconclusive"), ("process 77 (ended) ran", "inconclusive"),
    ("", "failed"), (f"process {PROGRAM_PID} (ended) ran", "failed"), ("thread 77 ran", "failed"), ("process 31 ('stress-ng-cpu') ran", "failed"),
    ("process 32 ('mamori_timing_e') ran", "failed"), ("the process was stopped or held", "failed"),
    ("the processor was idle (the host did not run the program)", "failed"),
    ("a thread of lower priority ran (the host did not wake the thread of the window)", "failed"),
])  # fmt: skip
@pytest.mark.parametrize("wanted", [COMPONENT, OWN_PROCESS])
def test_only_a_process_that_does_not_belong_to_the_measurement_excuses(monkeypatch: pytest.MonkeyPatch, wanted: str, by: str, verdict: str) -> None:
    assert count_twenty(monkeypatch, wanted, 2, by).verdict == verdict


@pytest.mark.verifies("SWR-TIM-044", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("lost_ns", "verdict"), [(50_000, "inconclusive"), (49_999, "failed")])
def test_steal_time_excuses_only_if_the_steps_show_it(monkeypatch: pytest.MonkeyPatch, lost_ns: int, verdict: str) -> None:
    assert count_twenty(monkeypatch, COMPONENT, 1, STOLEN, lost_ns).verdict == verdict


@pytest.mark.verifies("SWR-TIM-044", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("wrong", "verdict"), [(0, "passed"), (2, "inconclusive"), (3, "failed"), (20, "failed")])
def test_one_disturbed_event_in_ten_is_permitted(monkeypatch: pytest.MonkeyPatch, wrong: int, verdict: str) -> None:
    tally = count_twenty(monkeypatch, COMPONENT, wrong, FOREIGN)
    assert (tally.verdict, tally.disturbed_events, tally.disturbed) == (verdict, wrong, wrong)


@pytest.mark.verifies("SWR-TIM-044", technique="error_guessing", polarity="violation")
def test_disturbed_event_does_not_excuse_another_wrong_one(monkeypatch: pytest.MonkeyPatch) -> None:
    labels = [(cycle, COMPONENT) for cycle in range(60, 260, 10)]
    misses = [make_miss(60, OUTSIDE, by=FOREIGN), make_miss(70, OUTSIDE), *(make_miss(cycle, COMPONENT) for cycle, _ in labels[2:])]

    assert count(monkeypatch, misses, *labels).verdict == "failed"


@pytest.mark.verifies("SWR-TIM-044", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("wrong", "verdict"), [(1, "passed"), (2, "failed")])
def test_nineteen_of_twenty_must_be_correct(monkeypatch: pytest.MonkeyPatch, wrong: int, verdict: str) -> None:
    labels = [(cycle, OWN_PROCESS) for cycle in range(60, 260, 10)]
    misses = [make_miss(cycle, NOT_KNOWN if number < wrong else OWN_PROCESS) for number, (cycle, _) in enumerate(labels)]

    assert count(monkeypatch, misses, *labels).verdict == verdict


@pytest.mark.verifies("SWR-TIM-044", technique="error_guessing", polarity="violation")
def test_component_without_an_event_is_an_exchange_and_earlier_work_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    labels = ((60, COMPONENT), (70, OUTSIDE))
    late = [make_miss(60, COMPONENT), make_miss(65, COMPONENT, since=60), make_miss(70, COMPONENT, since=60)]

    tally = count(monkeypatch, late, *labels)
    assert (tally.verdict, tally.silent.total(), tally.exchanged) == ("passed", 1, 0)
    assert count(monkeypatch, [*late, make_miss(90, COMPONENT)], *labels).verdict == "failed"
    assert count(monkeypatch, [*late, make_miss(90, OUTSIDE)], *labels).verdict == "passed"


@pytest.mark.verifies("SWR-TIM-044", technique="equivalence_classes", polarity="violation")
def test_nothing_measured_is_failed(monkeypatch: pytest.MonkeyPatch) -> None:
    assert count(monkeypatch, [], (60, COMPONENT)).verdict == "failed"
    assert count(monkeypatch, []).verdict == "failed"


@pytest.mark.verifies("SWR-TIM-044", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("effective", "verdict"), [(10, "passed"), (9, "failed")])
def test_half_of_the_events_must_have_an_effect(monkeypatch: pytest.MonkeyPatch, effective: int, verdict: str) -> None:
    labels = [(cycle, COMPONENT) for cycle in range(60, 260, 10)]

    assert count(monkeypatch, [make_miss(cycle, COMPONENT) for cycle, _ in labels[:effective]], *labels).verdict == verdict


@pytest.mark.verifies("SWR-TIM-044", technique="error_guessing", polarity="violation")
def test_program_that_is_missing_ends_with_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--build", str(tmp_path)]) == 2
    assert "missing; build mamori_timing_events" in capsys.readouterr().err
