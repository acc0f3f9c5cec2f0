# SPDX-License-Identifier: Apache-2.0
# Goal: `prove` prints and stores the proved properties, and fails if no proof was possible. Method: the command on the built project, with
# a defect, without provers, and with a folder that is not writable.
from __future__ import annotations

import json
from pathlib import Path

import pytest

from mamori_tools.host.project import Project
from mamori_trace.base.errors import InputError
from verification.safe_state.brakes.properties import BRAKE_PROPERTIES
from verification.safe_state.command import Request, prove_safe_state
from verification.safe_state.conftest import Proved
from verification.safe_state.properties import PROPERTIES

BRAKE_FILES = {"brakes.json", "brakes.pml", "brakes.smt2", "torque.json"}
MACHINE_FILES = {"machine.pml", "machine.smt2", "relation.json"}
NAMES = [one.name for one in (*PROPERTIES, *BRAKE_PROPERTIES)]


@pytest.mark.verifies("SWR-FSM-025")
def test_all_is_proved_printed_as_json_and_kept(proved: Proved) -> None:
    record = proved.record
    assert proved.status == 0
    assert record["schema"] == "mamori.safe_state_proof/1"
    assert (record["situations"], record["merged_situations"], record["corrupted_objects"]) == (82, 16, 1296)
    assert (record["brake_situations"], record["merged_brake_situations"]) == (134, 10)
    assert (record["cycle_situations"], record["cycles"]) == (7662, 8826624)
    assert [row["name"] for row in record["properties"] if row["proved"]] == NAMES
    assert {path.name for path in proved.folder.iterdir()} == {*BRAKE_FILES, *MACHINE_FILES, "proof.json"}
    assert json.loads((proved.folder / "proof.json").read_text(encoding="utf-8")) == record


@pytest.mark.verifies("SWR-FSM-025", technique="fault_injection", polarity="violation")
def test_property_that_does_not_hold_ends_with_status_1_and_its_steps(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status = prove_safe_state(Request(out=tmp_path, defect="start-is-bumpless"))

    shown = capsys.readouterr().out
    assert status == 1
    assert "seeded defect: The start does not wait for the setpoint." in shown
    assert "start-is-bumpless does not hold: " in shown
    assert "Standby -> Operational: demand None" in shown
    assert shown.strip().endswith(f"{len(PROPERTIES)} properties: {len(PROPERTIES) - 1} proved, 1 refuted")


@pytest.mark.verifies("SWR-FSM-025", technique="fault_injection", polarity="violation")
def test_defect_of_the_brakes_is_judged_by_their_properties_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status = prove_safe_state(Request(out=tmp_path, defect="sto-waits-for-no-brakes"))

    shown = capsys.readouterr().out
    assert status == 1
    assert "seeded defect: An SS1 that ends in STO keeps torque for its brakes." in shown
    assert "sto-waits-for-no-brakes does not hold: " in shown
    assert shown.strip().endswith(f"{len(BRAKE_PROPERTIES)} properties: {len(BRAKE_PROPERTIES) - 1} proved, 1 refuted")
    assert {path.name for path in tmp_path.iterdir()} == {*BRAKE_FILES, "proof.json"}


@pytest.mark.verifies("SWR-FSM-025", technique="fault_injection", polarity="violation")
def test_missing_provers_are_named_with_their_packages(tmp_path: Path, capsys: pytest.CaptureFixture[str],
                                                       monkeypatch: pytest.MonkeyPatch) -> None:  # fmt: skip
    monkeypatch.setenv("PATH", str(tmp_path))

    status = prove_safe_state(Request(out=tmp_path / "out"))

    assert status == 1
    assert capsys.readouterr().err == ("mamori: prove: z3, spin, gcc not found in PATH; install the package(s) z3 spin gcc "
                                       "(as root: apt-get install z3 spin gcc)\n")  # fmt: skip
    assert not (tmp_path / "out").exists()


@pytest.mark.verifies("SWR-FSM-025", technique="error_guessing", polarity="violation")
def test_folder_that_cannot_be_made_and_project_that_cannot_be_built_are_told_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("x", encoding="utf-8")
    with pytest.raises(InputError, match=r"not writable .*; specify a writable folder"):
        prove_safe_state(Request(out=tmp_path / "file" / "out"))

    assert prove_safe_state(Request(), Project(tmp_path)) == 1
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert "could not be built" in error


@pytest.mark.verifies("SWR-FSM-025", technique="error_guessing", polarity="violation")
def test_unknown_defect_is_refused_before_anything_is_built(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no defect 'start-is-bump'; nearest: start-is-bumpless"):
        prove_safe_state(Request(defect="start-is-bump"), Project(tmp_path))
