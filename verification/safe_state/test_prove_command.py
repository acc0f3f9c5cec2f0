# SPDX-License-Identifier: Apache-2.0
# Goal: `prove` says and keeps what was proved, and nothing passes when nothing could be proved.
# Method: the command on the built project, with a defect, without provers, and with a folder that cannot be written.
from __future__ import annotations

import json
from pathlib import Path

import pytest

from mamori.verification.command.errors import UsageError
from mamori.verification.command.main import main
from mamori.verification.command.project import Project
from mamori.verification.safe_state.command import Request, prove_safe_state
from mamori.verification.safe_state.properties import PROPERTIES

FILES = ["machine.pml", "machine.smt2", "proof.json", "relation.json"]


@pytest.mark.verifies("SWR-FSM-025")
def test_all_is_proved_printed_as_json_and_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status = main(["prove", "safe-state", "--json", "--out", str(tmp_path / "out"), "--jobs", "1"])

    record = json.loads(capsys.readouterr().out)
    assert status == 0
    assert record["schema"] == "mamori.safe_state_proof/1"
    assert (record["situations"], record["merged_situations"], record["corrupted_objects"]) == (74, 15, 1168)
    assert [row["name"] for row in record["properties"] if row["proved"]] == [one.name for one in PROPERTIES]
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == FILES
    assert json.loads((tmp_path / "out" / "proof.json").read_text(encoding="utf-8")) == record


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
    assert prove_safe_state(Request(out=tmp_path / "file" / "out")) == 1
    assert "name another folder with --out" in capsys.readouterr().err

    assert prove_safe_state(Request(), Project(tmp_path)) == 1
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert "could not be built" in error


@pytest.mark.verifies("SWR-FSM-025", technique="error_guessing", polarity="violation")
def test_unknown_defect_is_refused_before_anything_is_built(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="there is no defect 'start-is-bump'; nearest: start-is-bumpless"):
        prove_safe_state(Request(defect="start-is-bump"), Project(tmp_path))
