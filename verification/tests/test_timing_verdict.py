# SPDX-License-Identifier: Apache-2.0
"""Goal: the measurement of verdicts counts correct, wrong and exchanged ones. Method: losses with given verdicts and labels."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from mamori_tools.timing.analysis import Miss
from mamori_tools.timing.verdict import COMPONENT, NOT_KNOWN, OUTSIDE, OWN_PROCESS
from verification.real_time import timing_verdict
from verification.real_time.timing_verdict import Tally, judge, main


def make_miss(cycle: int, verdict: str, since: int | None = None, window: str = "work") -> Miss:
    return Miss(cycle, cycle * 10_000_000, window, "overrun", "suspect", 0, "late", verdict, "", cycle if since is None else since)


def count(monkeypatch: pytest.MonkeyPatch, misses: list[Miss], *labels: tuple[int, str]) -> Tally:
    monkeypatch.setattr(timing_verdict, "list_misses", lambda run: misses)
    tally, run = Tally(), None
    rows = [{"kind": "spin", "label": label, "cycle": cycle, "last_cycle": cycle + 1} for cycle, label in labels]
    unread: Any = run
    judge(unread, rows, tally)
    return tally


@pytest.mark.verifies("SWR-TIM-044", polarity="violation")
@pytest.mark.parametrize(("found", "wanted", "verdict"), [
    (COMPONENT, COMPONENT, "passed"), (OWN_PROCESS, OWN_PROCESS, "passed"), (COMPONENT, OUTSIDE, "failed"), (COMPONENT, OWN_PROCESS, "failed"),
    (OWN_PROCESS, COMPONENT, "failed"), (NOT_KNOWN, COMPONENT, "failed"), (OUTSIDE, COMPONENT, "inconclusive"), (OUTSIDE, OWN_PROCESS, "inconclusive"),
])  # fmt: skip
def test_one_wrong_event_decides_by_what_it_names(monkeypatch: pytest.MonkeyPatch, found: str, wanted: str, verdict: str) -> None:
    assert count(monkeypatch, [make_miss(60, found)], (60, wanted)).verdict == verdict


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
def test_nothing_measured_is_not_passed(monkeypatch: pytest.MonkeyPatch) -> None:
    assert count(monkeypatch, [], (60, COMPONENT)).verdict == "inconclusive"


@pytest.mark.verifies("SWR-TIM-044", technique="error_guessing", polarity="violation")
def test_program_that_is_missing_ends_with_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--build", str(tmp_path)]) == 2
    assert "missing; build mamori_timing_events" in capsys.readouterr().err
