# SPDX-License-Identifier: Apache-2.0
# Goal: `mamori table` shows the safety rows of a table as text and as a Markdown page, and rejects invalid ones in one line.
# Method: the command in this process, on a handwritten table; lines are compared without their alignment.
from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest
from timing_run import make_table

from mamori_tools.command.main import main

MS, US = 1_000_000, 1_000
SAFETY: dict[str, Any] = {
    "cycle": {"ss2_within_ns": 300 * MS, "ss1_within_ns": 500 * MS, "brakes_close_within_ns": 100 * MS, "brakes_have_contacts": True,
              "watchdog_shortest_ns": 500 * US, "watchdog_longest_ns": 4 * MS, "torque_feedback_ns": 20 * MS, "lateness_max_ns": 50 * US,
              "late_reaction_fault": 2, "self_test_fault": 3, "unconfirmed_brakes_fault": 2, "brakes_first": [0, 3]},
    "supervised": [{"component": 0, "late_cycles": 1, "expired_cycles": 4, "shortest_ns": 5 * US, "longest_ns": 90 * US, "checkpoints": 2, "fault": 1},
                   {"component": 1, "late_cycles": 2, "expired_cycles": 3, "shortest_ns": 0, "longest_ns": 80 * US, "checkpoints": 0,
                    "fault": None}],
    "confirmations": [{"fault": 0, "cycles": 3, "decay": 2, "time_ns": 0, "healing_cycles": 5, "healing_ns": 7 * MS},
                      {"fault": 2, "cycles": 0, "decay": 0, "time_ns": 9 * MS, "healing_cycles": 1, "healing_ns": 0},
                      {"fault": 3, "cycles": 2, "decay": 0, "time_ns": 9 * MS, "healing_cycles": 1, "healing_ns": 0}],
    "stop_sources": [{"component": 1, "port": "state", "confirms": ["standstill", "torque_off"]},
                     {"component": None, "port": "?", "confirms": ["closed_brakes"]}],
    "self_tests": [{"found_within_ns": 2_000 * MS, "fault": 3}, {"found_within_ns": 1_000 * MS, "fault": 9}],
    "assumptions": [{"name": "watchdog", "within_ns": 300 * MS}],
    "protections": [{"component": 2, "profile": 4, "fresh_within_ns": 3 * MS, "lead_ns": 0, "max_delta": 3, "fault": 1},
                    {"component": 3, "profile": 44, "fresh_within_ns": 9 * MS, "lead_ns": 40 * US, "max_delta": None, "fault": 2}],
}  # fmt: skip


def write(folder: Path, safety: object = SAFETY, **changes: object) -> Path:
    names = ("Fast", "Silent", "Late", "Test")
    faults = [{"number": number, "name": name} for number, name in enumerate(names)]
    reactions = [{"fault": number, "reaction": "Sto", "within_ns": 2 * MS, "modes": []} for number in range(len(names))]
    path = folder / "table.json"
    path.write_text(json.dumps({**make_table(), "faults": faults, "reactions": reactions, "safety": safety, **changes}), encoding="utf-8")
    return path


def show(capsys: pytest.CaptureFixture[str], *words: object) -> list[str]:
    assert main(["table", *map(str, words)]) == 0
    return [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]


@pytest.mark.verifies("SWR-CYC-033")
def test_each_fault_is_shown_with_its_id_its_causes_and_its_confirmation(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = show(capsys, write(tmp_path))

    first = lines.index("faults and reactions") + 1
    assert lines[first : first + 5] == [
        "id fault reaction within raised by latched after healed after",
        "F0 Fast Sto 2 ms machine 3 cycles, minus 2 per cycle without it 5 cycles and 7 ms",
        "F1 Silent Sto 2 ms reader, loss at controller 1 cycle 4 cycles",
        "F2 Late Sto 2 ms loss at drive, late reaction, unconfirmed brakes 9 ms 1 cycle",
        "F3 Test Sto 2 ms self test 0, failed self test 2 cycles or 9 ms 1 cycle",
    ]


@pytest.mark.verifies("SWR-CYC-033")
def test_supervision_stops_self_tests_and_settings_are_shown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = show(capsys, write(tmp_path))

    assert lines[lines.index("supervision") + 1 : -1] == [
        "component late after expired after shortest run longest run checkpoints failure",
        "reader 1 cycle 4 cycles 5 µs 90 µs 2 F1 Silent",
        "monitor 2 cycles 3 cycles 80 µs watchdog is not serviced",
        "",
        "confirmations of stops",
        "confirmation source",
        "standstill monitor.state",
        "torque off monitor.state",
        "closed brakes ?.?",
        "",
        "repeated self tests",
        "self test found within fault",
        "0 2 s F3 Test",
        "1 1 s F9 (not declared)",
        "",
        "assumptions",
        "assumption known within fault",
        "watchdog 300 ms F3 Test",
        "",
        "protected connections",
        "receiver E2E fresh within lead losses in a row fault",
        "controller profile 4 3 ms 2 F1 Silent",
        "drive profile 44 9 ms 40 µs F2 Late",
        "",
        "safety cycle",
        "setting value",
        "SS2 becomes SS1 after 300 ms",
        "SS1 becomes STO after 500 ms",
        "brakes close within 100 ms, with contacts",
        "torque despite STO locks out after 20 ms",
        "watchdog is serviced every 500 µs to 4 ms",
        "latest window start 50 µs",
        "STO after closed brakes F0 Fast, F3 Test",
        "",
    ]


@pytest.mark.verifies("SWR-CYC-033", technique="boundary_values")
def test_rows_that_a_table_does_not_have_are_not_shown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cycle = {**SAFETY["cycle"], "brakes_have_contacts": False, "brakes_first": [], "late_reaction_fault": None}
    few = show(capsys, write(tmp_path, {"cycle": cycle, **{key: [] for key in SAFETY if key != "cycle"}}))
    none = show(capsys, write(tmp_path, None))

    assert not {"supervision", "confirmations of stops", "repeated self tests", "assumptions", "protected connections"} & set(few)
    assert {"brakes close within 100 ms, without contacts", "STO after closed brakes none"} <= set(few)
    assert "F1 Silent Sto 2 ms machine 1 cycle 1 cycle" in few
    assert "safety cycle" not in none
    assert "Silent Sto 2 ms" in none


@pytest.mark.verifies("SWR-CYC-033")
def test_page_has_the_rows_of_the_text_and_every_finding(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path, findings=["window 'a_b': too | long"])
    assert main(["table", str(path)]) == 1
    text = capsys.readouterr().out.splitlines()
    assert main(["table", str(path), "--markdown"]) == 1
    page = capsys.readouterr().out.splitlines()

    assert page[0] == "# System table"
    rows = [" ".join(line.replace("|", " ").split()) for line in page if line.startswith("|") and not line.startswith("|---")]
    assert rows == [" ".join(line.split()) for line in text if line.startswith("  ") and not line.startswith("  window 'a_b'")]
    *titles, last = (line[3:].lower() for line in page if line.startswith("## "))
    assert titles == [line.lower() for line in text[1:] if line and not line.startswith("  ")][:-1]
    assert last == "rules"
    assert page[-1] == r"* window 'a_b': too \| long"
    assert "| F1 | Silent | Sto | 2 ms | reader, loss at controller | 1 cycle | 4 cycles |" in page


@pytest.mark.verifies("SWR-CYC-033", technique="error_guessing", polarity="violation")
def test_names_with_the_letters_of_markdown_stay_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    faults = [{"number": 0, "name": "a|b_c <i>*d* _e_ `f` [g](h)\n&amp;~i~"}]
    page = show(capsys, write(tmp_path, faults=faults, reactions=[]), "--markdown")

    assert any(r"| a\|b_c \<i\>\*d\* \_e\_ \`f\` \[g\](h)" + "\N{REPLACEMENT CHARACTER}" + r"\&amp;\~i\~ | none |" in line for line in page)


def _change(section: str, key: str, value: object) -> dict[str, Any]:
    safety = copy.deepcopy(SAFETY)
    row = safety[section] if section == "cycle" else safety[section][0]
    row[key] = value
    return safety


@pytest.mark.verifies("SWR-CYC-032", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("safety", "sentence"),
    [
        ([], "safety must be an object"),
        ({}, "safety has no 'cycle'"),
        *(({key: value for key, value in SAFETY.items() if key != gone}, f"safety has no '{gone}'") for gone in SAFETY),
        (_change("cycle", "brakes_have_contacts", 1), "safety.cycle.brakes_have_contacts must be true or false"),
        (_change("cycle", "brakes_first", [-1]), "safety.cycle.brakes_first[0] must not be negative"),
        (_change("cycle", "late_reaction_fault", "F1"), "safety.cycle.late_reaction_fault must be an integer"),
        (_change("supervised", "component", 9), "safety.supervised[0].component is 9, beyond the 4 rows"),
        (_change("supervised", "late_cycles", None), "safety.supervised[0].late_cycles must be an integer"),
        (_change("confirmations", "fault", 1.5), "safety.confirmations[0].fault must be an integer"),
        (_change("stop_sources", "confirms", ["standstil"]), "safety.stop_sources[0].confirms[0] is 'standstil'; nearest: standstill"),
        (_change("assumptions", "name", None), "safety.assumptions[0].name must be a text"),
        (_change("protections", "max_delta", "2"), "safety.protections[0].max_delta must be an integer"),
        (_change("protections", "component", 4), "safety.protections[0].component is 4, beyond the 4 rows"),
        (_change("self_tests", "found_within_ns", "1 s"), "safety.self_tests[0].found_within_ns must be an integer"),
    ],
)
def test_invalid_safety_row_is_named(safety: object, sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["table", str(write(tmp_path, safety))]) == 2

    error = capsys.readouterr().err
    assert sentence in error
    assert error.count("\n") == 1
