# SPDX-License-Identifier: Apache-2.0
# Goal: times are shown per state of the system, and leaving an operating state is a finding that --accept does not store.
# Method: one window with six instances whose states are given.
from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from timing_run import make_program, make_run, make_switches, make_table, prepare, write_run, write_switches

from mamori_tools.command.main import main
from mamori_tools.timing.reader import COMPLETED, OPENING, STEP, Measurement, read_measurement
from mamori_tools.timing.states import list_state_components, list_state_findings, list_state_notes, list_states
from mamori_tools.timing.switches import NO_STATE
from mamori_trace.base.errors import InputError

TABLE = make_table(windows=(("work", 0, 100, 300, 1000, 200),), components=(("first", 0, None, 0),), connections=())
US = 1000
STATES = [{"name": "starting", "is_operating": False}, {"name": "moving", "is_operating": True}, {"name": "stopped", "is_operating": False}]
STARTING, MOVING, STOPPED = range(3)


def read(folder: Path, states: Sequence[int], listed: Sequence[dict[str, Any]] = tuple(STATES)) -> Measurement:
    """Instance i is i us late, and its step takes 10 + i us."""
    count = len(states)
    releases = (1000 * np.arange(1, count + 1) + 100) * US
    openings, steps = np.zeros(count, OPENING), np.zeros(count, STEP)
    openings["release_ns"], openings["woke_ns"], openings["outcome"] = releases, releases + np.arange(count) * US, COMPLETED
    openings["closed_ns"] = releases + 90 * US
    steps["release_ns"], steps["start_ns"], steps["end_ns"] = releases, releases + 20 * US, releases + (30 + np.arange(count)) * US
    write_run(folder, TABLE, openings, steps, make_run(TABLE, count, count) | {"switches": make_switches(errno=1), "states": list(listed)})
    write_switches(folder, count, [(US, 0, 0)] * count, [], states)
    return read_measurement(folder)


@pytest.mark.verifies("SWR-TIM-046")
def test_times_are_separate_for_each_state_that_occurred(tmp_path: Path) -> None:
    run = read(tmp_path, [NO_STATE, STARTING, STARTING, MOVING, MOVING, MOVING])

    starting, moving = list_states(run)
    assert (starting.state, starting.is_operating, starting.count) == ("starting", False, 2)
    assert (moving.state, moving.is_operating, moving.count) == ("moving", True, 3)
    assert starting.lateness is not None and (starting.lateness.min, starting.lateness.max) == (1 * US, 2 * US)
    assert moving.lateness is not None and (moving.lateness.min, moving.lateness.max) == (3 * US, 5 * US)
    assert [(one.state, one.component, one.execution.max) for one in list_state_components(run)] == [
        ("starting", "first", 12 * US), ("moving", "first", 15 * US)]  # fmt: skip


@pytest.mark.verifies("SWR-TIM-046", technique="state_transition", polarity="violation")
@pytest.mark.parametrize(("states", "finding"), [
    ([STARTING, STARTING, MOVING, MOVING], ""),
    ([STARTING, MOVING, MOVING, STOPPED], "the system left its operating state 'moving' in cycle 4: 'stopped'"),
    ([STARTING, MOVING, STARTING, MOVING], "the system left its operating state 'moving' in cycle 3: 'starting'"),
    ([NO_STATE, MOVING, NO_STATE, MOVING], ""),
    ([MOVING, NO_STATE, STOPPED], "the system left its operating state 'moving' in cycle 3: 'stopped'"),
    ([STOPPED, STARTING, STOPPED, STARTING], ""),
])  # fmt: skip
def test_leaving_an_operating_state_is_a_finding(tmp_path: Path, states: list[int], finding: str) -> None:
    assert list_state_findings(read(tmp_path, states)) == ([finding] if finding else [])


@pytest.mark.verifies("SWR-TIM-046", technique="state_transition", polarity="violation")
@pytest.mark.parametrize(("states", "findings"), [
    ((MOVING, STARTING), []), ((STOPPED, MOVING), ["the system left its operating state 'moving' in cycle 1: 'stopped'"]),
])  # fmt: skip
def test_states_of_several_cores_are_compared_in_the_order_in_which_their_windows_ended(tmp_path: Path, states: tuple[int, int],
                                                                                        findings: list[str]) -> None:  # fmt: skip
    table = make_table(windows=(("long", 0, 100, 800, 1000, 700), ("short", 1, 200, 200, 1000, 100)), components=(), connections=())
    openings = np.zeros(2, OPENING)
    openings["release_ns"], openings["closed_ns"] = (1100 * US, 1200 * US), (1800 * US, 1300 * US)
    openings["woke_ns"], openings["window"], openings["outcome"] = openings["release_ns"], (0, 1), COMPLETED
    write_run(tmp_path, table, openings, np.zeros(0, STEP), make_run(table, 1, 1) | {"switches": make_switches(windows=2, errno=1), "states": STATES})
    write_switches(tmp_path, 2, [], [], states)

    assert list_state_findings(read_measurement(tmp_path)) == findings


@pytest.mark.verifies("SWR-TIM-046", technique="interface", polarity="violation")
@pytest.mark.parametrize(("last", "status"), [(MOVING, 0), (STARTING, 1)])
def test_run_that_left_its_operating_state_is_not_accepted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
                                                           last: int, status: int) -> None:  # fmt: skip
    monkeypatch.setattr("mamori_tools.timing.picture.draw_report", lambda report, folder: [])
    prepare(tmp_path)
    whole = tmp_path / "data" / "whole"
    run = json.loads((whole / "run.json").read_text(encoding="utf-8"))
    (whole / "run.json").write_text(json.dumps(run | {"switches": make_switches(windows=3, errno=1), "states": STATES}), encoding="utf-8")
    write_switches(whole, 300, [(US, 0, 0)] * 400, [], [MOVING] * 150 + [last] + [MOVING] * 149)
    program, baseline = make_program(tmp_path), tmp_path / "baseline.toml"

    ended = main(["timing", str(program), "--cycles", "100", "--out", str(tmp_path / "out"), "--accept", str(baseline)])

    assert (ended, baseline.exists()) == (status, status == 0)
    said = capsys.readouterr()
    assert ("finding: the system left its operating state 'moving' in cycle" in said.out) == (status == 1)
    assert ("not accepted" in said.err) == (status == 1)


@pytest.mark.verifies("SWR-TIM-046", technique="equivalence_classes")
def test_system_that_never_operated_is_noted(tmp_path: Path) -> None:
    assert list_state_notes(read(tmp_path / "never", [STARTING, STARTING])) == ["the system was never in an operating state during the run"]
    assert list_state_notes(read(tmp_path / "once", [STARTING, MOVING])) == []
    assert list_state_notes(read(tmp_path / "none", [NO_STATE, NO_STATE], [])) == []
    assert list_states(read(tmp_path / "none", [NO_STATE, NO_STATE], [])) == []


@pytest.mark.verifies("SWR-TIM-046", technique="error_guessing", polarity="violation")
def test_state_that_is_not_listed_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"has 3 states, window_use\.npy has state 3"):
        read(tmp_path, [STARTING, 3])
