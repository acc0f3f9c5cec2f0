# SPDX-License-Identifier: Apache-2.0
# Goal: a run is read completely and quickly; truncated, edited or inconsistent files are rejected.
# Method: runs from timing_run.py, with one fault at a time.
from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from timing_run import COMPONENTS, make_rows, make_run, make_table, write_run

from mamori_tools.timing.environment import collect_setting, collect_state
from mamori_tools.timing.reader import FILES, NOT_BACK, OPENING, read_measurement
from mamori_tools.timing.report import make_report
from mamori_tools.timing.text import make_text
from mamori_trace.base.errors import InputError

TIMES_US = [row[3] for row in COMPONENTS]
HOST = {"setting": collect_setting(), "before": collect_state(), "after": collect_state()}
READ_S_MAX = 5.0
"""Five times the limit for an idle host, so that the test does not fail on a busy one."""


def write(folder: Path, count: int = 20, **changes: Any) -> Path:
    table = make_table()
    openings, steps = make_rows(table, TIMES_US, count)
    return write_run(folder, table, openings, steps, {**make_run(table, count, count), **changes})


def change_rows(folder: Path, name: str, change: Callable[[Any], Any]) -> None:
    rows = np.load(folder / name)
    rows = change(rows)
    np.save(folder / name, rows)


def set_cell(column: str, value: int, row: int = 3) -> Callable[[Any], Any]:
    def change(rows: Any) -> Any:
        rows[column][row] = value
        return rows

    return change


def refuse(folder: Path) -> str:
    with pytest.raises(InputError) as caught:
        read_measurement(folder)
    text = str(caught.value)
    assert "\n" not in text
    return text


@pytest.mark.verifies("SWR-TIM-010")
def test_whole_run_is_read_with_its_steps_at_their_openings(tmp_path: Path) -> None:
    run = read_measurement(write(tmp_path))

    assert (run.cycles_asked, run.cycles_run, run.is_partial, run.reference_ns) == (20, 20, False, 1000)
    assert len(run.openings) == 60 and len(run.steps) == 80
    assert (run.openings["release_ns"][run.opening_of_step] == run.steps["release_ns"]).all()
    assert [run.table.components[one].window for one in run.steps["component"]] == run.openings["window"][run.opening_of_step].tolist()
    assert (run.refused, run.notes) == ([], ())


@pytest.mark.verifies("SWR-TIM-010")
def test_a_minute_of_a_thousand_cycles_a_second_is_read_in_about_a_second(tmp_path: Path) -> None:
    write(tmp_path, 60_000)

    begin = time.process_time()  # time of other programs is excluded
    run = read_measurement(tmp_path)

    assert len(run.steps) == 240_000
    assert time.process_time() - begin < READ_S_MAX


@pytest.mark.verifies("SWR-TIM-011", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("damage", ["missing", "empty", "cut", "text", "folder"])
def test_damaged_file_is_answered_with_its_name(tmp_path: Path, name: str, damage: str) -> None:
    path = write(tmp_path) / name
    content = path.read_bytes()
    path.unlink()
    match damage:
        case "empty":
            path.write_bytes(b"")
        case "cut":
            path.write_bytes(content[: len(content) - 40])
        case "text":
            path.write_text("no such thing", encoding="utf-8")
        case "folder":
            path.mkdir()

    assert refuse(tmp_path).startswith(f"{path}:")


@pytest.mark.verifies("SWR-TIM-011", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("change", "said"),
    [({"schema": "mamori.timing_run/2"}, "this command reads 'mamori.timing_run/1'"),
     ({"cycles": {"asked": 20, "run": 21}}, "states that 21 of 20 were run"),
     ({"cycles": {"asked": 0, "run": 0}}, "states that 0 of 0 were run"),
     ({"cycles": {"asked": 20}}, "has no 'run'"),
     ({"is_partial": True}, "20 of 20 cycles were run"),
     ({"is_partial": 1}, "must be true or false"),
     ({"frame_ns": 999_999}, "but 1000000 in the table"),
     ({"reference_ns": 0}, "must be positive"),
     ({"lost_rows": 2}, "2 rows were lost because the memory was full; measure fewer cycles"),
     ({"notes": [1]}, "must be a text"),
     ({"findings": "none"}, "must be a list"),
     ({"rights": {}}, "has no 'priority'"),
     ({"requests": {"block_cycles": 0, "count": 1, "paces": [0]}}, "has blocks of 0 cycles"),
     ({"requests": {"block_cycles": 10, "count": 1, "paces": [0, 0]}}, "has 2 blocks of 10 cycles; the run is longer"),
     ({"requests": {"block_cycles": 10, "count": 1, "paces": [0, 0, 1, 3]}}, "requests.paces[3]"),
     ({"requests": {"block_cycles": 10, "count": 1, "paces": [0, 0, 1, 1]}}, "has a round of three blocks without each pace")],
)  # fmt: skip
def test_record_that_contradicts_itself_is_refused(tmp_path: Path, change: dict[str, Any], said: str) -> None:
    assert said in refuse(write(tmp_path, **change))


@pytest.mark.verifies("SWR-TIM-010")
def test_what_the_program_has_to_say_is_passed_on(tmp_path: Path) -> None:
    assert read_measurement(write(tmp_path, notes=["the arm stands"])).notes == ("the program: the arm stands",)


@pytest.mark.verifies("SWR-TIM-028", polarity="violation")
def test_a_system_that_left_its_operating_state_is_a_finding_and_ends_with_1(tmp_path: Path) -> None:
    text = "the arm left its operating state and ended in LockedOut"
    report = make_report("arm", read_measurement(write(tmp_path, findings=[text])), HOST, False, False, [])

    assert (report.findings, report.status) == ([f"the program: {text}"], 1)
    assert f"finding: the program: {text}" in make_text(report, is_whole=False)


@pytest.mark.verifies("SWR-TIM-028")
@pytest.mark.parametrize("changes", [{}, {"findings": []}])
def test_a_system_that_operates_has_no_finding(tmp_path: Path, changes: dict[str, Any]) -> None:
    report = make_report("arm", read_measurement(write(tmp_path, **changes)), HOST, False, False, [])

    assert (report.findings, report.status) == ([], 0)


@pytest.mark.verifies("SWR-TIM-011", technique="error_guessing", polarity="violation")
def test_granted_right_with_an_error_number_is_refused(tmp_path: Path) -> None:
    rights = make_run(make_table(), 20, 20)["rights"]
    rights["memory"]["errno"] = 12

    assert "but has the errno 12" in refuse(write(tmp_path, rights=rights))


@pytest.mark.verifies("SWR-TIM-011", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("column", "value", "said"),
    [("window", 3, "outside the table (3 windows)"), ("outcome", 5, "unknown outcome (not 0 .. 4)"), ("release_ns", -2, "out of range"),
     ("closed_ns", 2**53, "out of range"), ("woke_ns", 1000, "have a wake-up before their release"), ("closed_ns", 1000, "end before their wake-up")],
)  # fmt: skip
def test_wrong_opening_is_refused_and_shown(tmp_path: Path, column: str, value: int, said: str) -> None:
    change_rows(write(tmp_path), "openings.npy", set_cell(column, value))

    text = refuse(tmp_path)
    assert said in text and f"{column} {value}" in text


@pytest.mark.verifies("SWR-TIM-011", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("column", "value", "said"),
    [("component", 4, "outside the table (4 components)"), ("pass", 3, "unknown pass (not 0 .. 2)"), ("start_ns", 2**53, "out of range"),
     ("start_ns", 5, "began before"), ("end_ns", 5, "ended before"), ("release_ns", 7, "belong to no window instance")],
)  # fmt: skip
def test_wrong_step_is_refused_and_shown(tmp_path: Path, column: str, value: int, said: str) -> None:
    change_rows(write(tmp_path), "steps.npy", set_cell(column, value))

    text = refuse(tmp_path)
    assert said in text and f"{column} {value}" in text


@pytest.mark.verifies("SWR-TIM-011", technique="boundary_values")
def test_greatest_values_that_are_allowed_are_read(tmp_path: Path) -> None:
    change_rows(write(tmp_path), "openings.npy", set_cell("outcome", 4))
    change_rows(tmp_path, "steps.npy", set_cell("end_ns", NOT_BACK))
    change_rows(tmp_path, "steps.npy", set_cell("pass", 2, row=4))

    assert read_measurement(tmp_path).steps["pass"].max() == 2


@pytest.mark.verifies("SWR-TIM-011", technique="error_guessing", polarity="violation")
@pytest.mark.parametrize(
    ("change", "said"),
    [(lambda rows: rows[:0], "has no window instances"), (lambda rows: np.concatenate((rows, rows[4:5])), "are duplicates"),
     (lambda rows: np.delete(rows, 30), "belong to no window instance"), (lambda rows: rows[rows["window"] != 1], "has 0 instances of window 'control'"),
     (lambda rows: rows.reshape(2, -1), "2-dimensional"), (lambda rows: rows["release_ns"].copy(), "openings are a list of")],
)  # fmt: skip
def test_list_of_openings_with_gaps_or_of_another_form_is_refused(tmp_path: Path, change: Callable[[Any], Any], said: str) -> None:
    change_rows(write(tmp_path), "openings.npy", change)

    assert said in refuse(tmp_path)


@pytest.mark.verifies("SWR-TIM-011", technique="error_guessing", polarity="violation")
def test_pickled_rows_are_never_unpacked(tmp_path: Path) -> None:
    np.save(write(tmp_path) / "openings.npy", np.array([{"release_ns": 1}], dtype=object), allow_pickle=True)

    assert "openings are a list of" in refuse(tmp_path)


@pytest.mark.verifies("SWR-TIM-011", technique="interface", polarity="violation")
def test_other_version_of_the_file_format_is_refused(tmp_path: Path) -> None:
    with (write(tmp_path) / "openings.npy").open("wb") as file:
        np.lib.format.write_array(file, np.zeros(3, OPENING), version=(2, 0))

    assert "version 2.0" in refuse(tmp_path)


@pytest.mark.verifies("SWR-TIM-011", technique="interface", polarity="violation")
def test_table_that_breaks_a_rule_is_refused(tmp_path: Path) -> None:
    table = make_table()
    table["findings"] = ["window 'sense': too long"]
    (write(tmp_path) / "table.json").write_text(json.dumps(table), encoding="utf-8")

    assert "violates a rule: window 'sense': too long" in refuse(tmp_path)


@pytest.mark.verifies("SWR-TIM-010", technique="error_guessing")
def test_steps_of_a_window_that_a_stop_cut_off_are_left_out_with_a_note(tmp_path: Path) -> None:
    table = make_table()
    openings, steps = make_rows(table, TIMES_US, 20)
    openings = np.delete(openings, np.flatnonzero(openings["window"] == 2)[-1])
    write_run(tmp_path, table, openings, steps, make_run(table, 30, 20))

    run = read_measurement(tmp_path)

    assert len(run.steps) == 79
    assert run.notes == ("1 steps omitted: the run was stopped before the end of their window",)
