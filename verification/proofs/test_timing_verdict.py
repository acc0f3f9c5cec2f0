# SPDX-License-Identifier: Apache-2.0
# Goal: the timing report finds who delayed a window. Method: a system with labelled events (tools/probe/timing/tests/labelled_run.cpp), half
# of them next to stress-ng; `python -P -m verification.real_time.timing_verdict` runs more of them.
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from mamori_tools.host.project import Project
from verification.real_time.timing_verdict import PROGRAM, measure

EVENTS = 24


@pytest.mark.verifies("SWR-TIM-044", technique="fault_injection", polarity="violation")
def test_cause_of_labelled_events_is_found(project: Project, tmp_path: Path, record_property: Callable[[str, object], None]) -> None:
    program = project.build / PROGRAM
    assert program.exists(), f"{program} is missing; run ./mamori build"

    tally = measure(program, EVENTS, 1, True, tmp_path)
    if tally.verdict == "failed":
        tally = measure(program, EVENTS, 2, True, tmp_path)  # a wrong rule fails again, a single stall of the host does not

    if tally.refused:
        pytest.skip(f"verdict=not-shown: {tally.refused}")
    record_property("verdict", tally.verdict)
    assert 2 * tally.effective >= EVENTS, f"only {tally.effective} of {EVENTS} events had an effect"
    assert tally.verdict != "failed", "\n".join(tally.faults)
    if tally.verdict == "inconclusive":
        pytest.skip(f"verdict=inconclusive: other processes disturbed {tally.disturbed_events} of {EVENTS} events")
