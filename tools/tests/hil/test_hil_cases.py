# SPDX-License-Identifier: Apache-2.0
# Goal: the cases of `mamori hil` cover each fault and each communication error on each link, and wrong input ends the command in one line
# before a process starts. Method: the command in this process; no network namespace is made.
from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from mamori_tools.command.main import main
from mamori_tools.hil import network
from mamori_tools.hil.processes import Programs
from mamori_tools.hil.scenario import ERRORS, LINKS, PROCESSES, HilCase, choose, list_cases, list_kills
from mamori_tools.host.project import ROOT, Project
from mamori_tools.motion import load_limits, read_motion
from mamori_trace.base.errors import InputError, MissingError

PROJECT = Project(ROOT)
MOTION = PROJECT.motion.with_name("reach.txt")


@pytest.fixture(scope="module")
def cases() -> tuple[HilCase, ...]:
    return list_cases(PROJECT.campaign_plan, read_motion(MOTION, load_limits(PROJECT.model)))


@pytest.fixture(autouse=True)
def _no_namespace(monkeypatch: pytest.MonkeyPatch) -> None:
    """A test that gets so far fails instead of leaving the network of this process."""

    def refuse() -> None:
        raise AssertionError("a namespace was requested")

    monkeypatch.setattr(network, "enter_own_network", refuse)
    monkeypatch.setattr("mamori_tools.command.main.raise_on_signals", lambda: None)
    monkeypatch.setattr("mamori_tools.command.locks.list_written", lambda _: [])


def run(*words: str) -> int:
    return main(["hil", *words])


@pytest.mark.verifies("SWR-HIL-008", technique="requirements_based")
def test_each_error_occurs_on_each_link_once_and_permanently(cases: tuple[HilCase, ...]) -> None:
    found = {(case.error, case.link, case.arm.fault.duration_s is None) for case in cases if case.error and case.arm.fault is not None}

    assert found == {(error, link, lasting) for error in ERRORS for link in LINKS for lasting in (True, False)}
    assert len({case.id for case in cases}) == len(cases) >= 100
    assert cases[0].id == "none-1"
    assert {"power_loss", "supervisor_hang", "message_lost_once"} <= {case.arm.scenario for case in cases}
    assert all(case.frames >= 1000 for case in cases)


@pytest.mark.verifies("SWR-HIL-008", technique="requirements_based")
def test_kills_are_at_random_instants_of_the_motion_and_repeatable() -> None:
    motion = read_motion(MOTION, load_limits(PROJECT.model))
    kills = list_kills(PROJECT.campaign_plan, motion, 60, 7)

    assert kills == list_kills(PROJECT.campaign_plan, motion, 60, 7)
    assert [sum(case.kill == name for case in kills) for name in PROCESSES] == [60, 60, 60]
    assert len({case.kill_at_s for case in kills}) == 180
    assert all(0.5 <= case.kill_at_s <= 0.5 + motion.duration_s for case in kills)


@pytest.mark.verifies("SWR-HIL-008", technique="equivalence_classes", polarity="violation")
def test_an_unknown_case_is_rejected_with_the_nearest_names(cases: tuple[HilCase, ...], capsys: pytest.CaptureFixture[str]) -> None:
    assert [case.id for case in choose(cases, ["power_loss", "loss_drive-1"])] == [
        case.id for case in cases if case.arm.scenario in ("power_loss", "loss_drive")
    ]
    with pytest.raises(InputError, match=r"unknown scenario 'power_los'.*power_loss"):
        choose(cases, ["power_los"])

    assert run("--fault", "nothing_known") == 2
    assert "unknown scenario 'nothing_known'" in capsys.readouterr().err


@pytest.mark.verifies("SWR-HIL-008", technique="boundary_values", polarity="violation")
def test_more_scenarios_than_there_are_end_with_status_2(cases: tuple[HilCase, ...], capsys: pytest.CaptureFixture[str]) -> None:
    assert run("--scenarios", str(len(cases) + 1)) == 2
    assert f"{len(cases) + 1} is more than {len(cases)}" in capsys.readouterr().err
    assert run("--scenarios", "0") == 2
    assert run("--list", "--scenarios", str(len(cases))) == 0


@pytest.mark.verifies("SWR-HIL-007", technique="fault_injection", polarity="violation")
def test_a_user_who_is_not_root_is_told_so(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(Programs, "check", lambda self: None)
    monkeypatch.setattr(shutil, "which", lambda tool: f"/bin/{tool}")
    monkeypatch.setattr("os.geteuid", lambda: 1000)

    assert run("--out", str(tmp_path / "out")) == 3
    assert "need root; call this command as root" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.verifies("SWR-HIL-007", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(("tool", "package"), [("ip", "iproute2"), ("lcm-logger", "liblcm-bin")])
def test_a_missing_tool_is_named_with_its_package(tool: str, package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: None if name == tool else f"/bin/{name}")
    with pytest.raises(MissingError, match=rf"'{tool}' is missing.*{package}"):
        network.check_tools()


@pytest.mark.verifies("SWR-HIL-010", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(("command", "message"), [("no_such_program --x", "'no_such_program' is not a program"), ("'open", "No closing quotation"),
                                                  ("", "is not a program"), (str(MOTION), "is not a program")])  # fmt: skip
def test_a_command_that_cannot_be_run_ends_with_status_2(command: str, message: str, monkeypatch: pytest.MonkeyPatch,
                                                         capsys: pytest.CaptureFixture[str]) -> None:  # fmt: skip
    monkeypatch.setattr(Programs, "get_shipped", lambda self, name: Path("/bin/true"))

    assert run("--controller", command) == 2
    assert message in capsys.readouterr().err


@pytest.mark.verifies("SWR-HIL-010", technique="requirements_based")
def test_a_command_of_the_user_replaces_a_shipped_program(cases: tuple[HilCase, ...], tmp_path: Path) -> None:
    programs = Programs(tmp_path, PROJECT.model, MOTION, {"controller": "python3 'my controller.py' --fast"})

    assert programs.make_command("controller", cases[0], tmp_path) == ["python3", "my controller.py", "--fast"]
    shipped = programs.make_command("kernel", cases[0], tmp_path)
    assert shipped[0] == str(tmp_path / "hil_kernel") and "--fault" not in shipped


@pytest.mark.verifies("SWR-HIL-009", technique="equivalence_classes", polarity="violation")
def test_a_missing_program_and_a_foreign_folder_end_with_status_2(monkeypatch: pytest.MonkeyPatch, tmp_path: Path,
                                                                  capsys: pytest.CaptureFixture[str]) -> None:  # fmt: skip
    monkeypatch.setattr(Programs, "get_shipped", lambda self, name: tmp_path / f"hil_{name}")
    assert run() == 2
    assert "hil_plant: no program that can be run; build it first" in capsys.readouterr().err

    monkeypatch.setattr(Programs, "check", lambda self: None)
    monkeypatch.setattr(network, "check_tools", lambda: None)
    (tmp_path / "letter.txt").write_text("kept", encoding="utf-8")
    assert run("--out", str(tmp_path)) == 2
    assert "is not a folder of an earlier run" in capsys.readouterr().err
    assert (tmp_path / "letter.txt").read_text(encoding="utf-8") == "kept"
