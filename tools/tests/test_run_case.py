# SPDX-License-Identifier: Apache-2.0
"""`mamori run`. Method: the shipped fault plan and motion for the selection of the case; for the exit status, a small program that replaces
the arm and ends in the state that the test selects."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from mamori_tools.campaign import Plan, load_plan
from mamori_tools.campaign.arm.fault import KINDS, LATENT_KINDS
from mamori_tools.campaign.arm.plan import ArmScenario
from mamori_tools.campaign.arm.selection import resolve
from mamori_tools.command import run_case
from mamori_tools.command.help_texts import make_texts
from mamori_tools.command.main import main
from mamori_tools.host import plans
from mamori_tools.host.project import ROOT, Project
from mamori_tools.host.steps import Step
from mamori_tools.motion import Motion, load_limits, read_motion, write_canonical
from mamori_trace.base.errors import InputError
from mamori_trace.readers.series import read_series

PROGRAM = """\
#!{python}
import json, sys
arguments = dict(zip(sys.argv[2::2], sys.argv[3::2]))
state = "{state}"
if state == "rejects":
    sys.stderr.write("safe_arm: --fault: magnitude must be small\\n"); sys.exit(2)
if state == "crashes":
    sys.exit(1)
pairs = dict(pair.split("=") for pair in arguments["--fault"].split(","))
at = 0.5 + float(pairs["at"])
run = {{"schema": "mamori.run/1", "commit": "none", "seed": int(arguments["--seed"]), "simulated_s": at + 2.0,
       "latent": None,
       "fault": {{"kind": pairs["kind"], "joint": None, "channel": None, "at_s": at, "motion_at_s": float(pairs["at"]), "magnitude": None}},
       "final_state": state, "operational_at_s": 0.1, "detected_fault": "PowerLost", "detected_at_s": at, "reaction": "Sto",
       "reacted_at_s": at + 0.001, "standstill_at_s": at + 0.1, "watchdog_bitten": False,
       "physics": {{"max_speed_rad_s": [0.1] * 7, "speed_limit_rad_s": [1.0] * 7, "min_position_margin_rad": 0.4,
                   "stop_travel_rad": [0.031] * 7, "hold_drift_rad": 0.0001, "max_tracking_error_rad": 0.007}}}}
out = arguments["--out"]
open(out + "/run.json", "w").write(json.dumps(run))
joints = ["0.1"] * 14
head = ["t_s"] + [f"q{{j}}" for j in range(1, 8)] + [f"qd{{j}}" for j in range(1, 8)] + ["state"]
rows = [[f"{{t / 100:.3f}}"] + joints + ["Operational" if t / 100 < at else state] for t in range(int((at + 2.0) * 100))]
open(out + "/series.csv", "w").write("\\n".join(",".join(row) for row in [head] + rows) + "\\n")
"""


@pytest.fixture(scope="module")
def plan() -> Plan:
    return load_plan(Project(ROOT).campaign_plan)


@pytest.fixture(scope="module")
def motion() -> Motion:
    return read_motion(Project(ROOT).motion, load_limits(Project(ROOT).model))


@pytest.mark.verifies("SWR-CLI-013", technique="equivalence_classes")
@pytest.mark.parametrize(("fault", "scenario", "text"), [
    (None, "none", None),
    ("power_loss", "power_loss", "kind=power_loss,at=0.897"),
    ("kind=power_loss,at=2", "power_loss", "kind=power_loss,at=2.0"),
    ("encoder_freeze,channel=both,joint=3,at=1", "encoder_freeze_both", "kind=encoder_freeze,joint=3,channel=both,at=1.0"),
    ("torque_runaway,joint=4", "torque_runaway_elbow", "kind=torque_runaway,joint=4,at=0.897,magnitude=-1.0"),
    ("message_lost", "message_lost", "kind=message_lost,at=0.897"),
    ("message_lost,duration=0.001", "message_lost_once", "kind=message_lost,at=0.897,duration=0.001"),
])  # fmt: skip
def test_what_is_left_out_comes_from_the_scenario_most_like_the_fault(plan: Plan, motion: Motion, fault: str | None, scenario: str,
                                                                      text: str | None) -> None:
    cases = resolve(run_case.select_case(plan, motion, fault), motion)

    assert [(case.scenario, case.fault and case.fault.to_text()) for case in cases] == [(scenario, text)]


@pytest.mark.verifies("SWR-CLI-013")
def test_a_fault_is_injected_at_the_instant_that_was_given_also_where_the_joint_stands_still(plan: Plan, motion: Motion) -> None:
    case = resolve(run_case.select_case(plan, motion, "encoder_freeze,joint=1,at=0"), motion)[0]

    assert case.fault is not None
    assert (case.fault.at_s, case.fault.joint) == (0.0, 1)


@pytest.mark.verifies("SWR-CLI-013", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("fault", "sentence"), [
    ("powerloss", "unknown kind 'powerloss'; known: none, encoder_freeze, "),
    ("", "unknown kind ''; known: none, "),
    ("brake_fade", "unknown kind 'brake_fade'; known: "),
    ("power_loss,joint=2", "'joint=2' is not key=value with a known key; power_loss takes at, duration, latent"),
    ("power_loss,at", "'at' is not key=value"),
    ("none,at=1", "none takes latent"),
    ("none,latent=power_loss", "latent is 'power_loss'; valid: brake_stuck_open, "),
    ("power_loss,at=1,at=2", "at is given twice"),
    ("power_loss,at=-0.001", "at is '-0.001'; valid: seconds of the motion, from 0 to below its end at 7.800"),
    ("power_loss,at=7.8", "at is '7.8'; valid: "),
    ("power_loss,at=nan", "at is 'nan'"),
    ("power_loss,duration=0", "duration is '0'; valid: seconds above 0"),
    ("power_loss,duration=inf", "duration is 'inf'"),
    ("encoder_freeze,joint=0", "joint is '0'; valid: 1 to 7 or fastest"),
    ("encoder_freeze,joint=8", "joint is '8'; valid: 1 to 7 or fastest"),
    ("encoder_freeze,channel=c", "channel is 'c'; valid: a, b, both"),
    ("message_late,magnitude=soon", "magnitude is 'soon'; valid: a finite number"),
])  # fmt: skip
def test_a_wrong_fault_is_answered_with_the_valid_words(plan: Plan, motion: Motion, fault: str, sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        resolve(run_case.select_case(plan, motion, fault), motion)
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.verifies("SWR-CLI-013", technique="boundary_values")
@pytest.mark.parametrize("fault", ["power_loss,at=0", "power_loss,at=7.799", "encoder_freeze,joint=1,at=1", "encoder_freeze,joint=7,at=1"])
def test_values_at_their_limits_are_taken(plan: Plan, motion: Motion, fault: str) -> None:
    assert len(resolve(run_case.select_case(plan, motion, fault), motion)) == 1


@pytest.fixture
def command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """Runs the command in a copy of the project data, with a program that ends in `state`."""
    program = tmp_path / "program"

    class Sandbox(Project):
        safe_arm = program
        model = Project(ROOT).model
        motion = Project(ROOT).motion
        campaign_plan = Project(ROOT).campaign_plan

    def run(state: str, *words: str) -> int:
        program.write_text(PROGRAM.format(python=sys.executable, state=state))
        program.chmod(0o755)
        monkeypatch.setattr(run_case, "Project", lambda root: Sandbox(tmp_path))
        monkeypatch.setattr(plans, "build_step", lambda preset, **_: Step("build", (("true",),)))
        monkeypatch.setattr("mamori_tools.command.main.raise_on_signals", lambda: None)
        return main(["run", *words])

    return run


@pytest.mark.verifies("SWR-CLI-013", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(("state", "status", "closing"), [
    ("Safe", 0, "end state as expected"), ("LockedOut", 1, "end state NOT as expected"), ("crashes", 1, "end state NOT as expected"),
])  # fmt: skip
def test_the_status_tells_whether_the_end_state_is_the_expected_one(command: Callable[..., int], state: str, status: int, closing: str,
                                                                    capsys: pytest.CaptureFixture[str]) -> None:
    assert command(state, "--fault", "power_loss") == status

    lines = capsys.readouterr().out.splitlines()
    assert lines[-1] == closing
    assert len(lines) <= 24


@pytest.mark.verifies("SWR-CLI-013")
def test_one_screen_shows_states_reaction_and_stopping_figures_and_names_the_page(command: Callable[..., int], tmp_path: Path,
                                                                                  capsys: pytest.CaptureFixture[str]) -> None:
    assert command("Safe", "--fault", "power_loss,at=1") == 0

    said = capsys.readouterr().out
    page = tmp_path / "build" / "run" / "power_loss" / "case.html"
    for words in ("Sto at 1.501 s, 1.0 ms after the fault", "Sto within 20 ms", "0.0310 rad", "Operational from 0.000 s, Safe from 1.500 s",
                  "Safe (scenario power_loss of the fault plan)", str(page)):  # fmt: skip
        assert words in said
    assert "<svg" in page.read_text(encoding="utf-8")


@pytest.mark.verifies("SWR-MOT-009", technique="interface")
def test_what_the_motion_has_that_is_not_used_is_one_note(command: Callable[..., int], capsys: pytest.CaptureFixture[str]) -> None:
    motion = ROOT / "tools" / "tests" / "motion" / "data" / "arm_with_fingers.yaml"

    assert command("Safe", "--motion", str(motion), "--fault", "power_loss,at=0.002") == 0
    notes = [line for line in capsys.readouterr().out.splitlines() if line.startswith("note: ")]
    assert notes == ["note: arm_with_fingers.yaml: not used: parts 8 to 9 (no arm joints); components not used: LinkPosition"]


def follow(motion_file: Path, folder: Path) -> tuple[Motion, list[float]]:
    """Runs the built arm on a motion. @return the motion, and the final joint positions [rad]."""
    project = Project(ROOT)
    if not project.safe_arm.exists():
        pytest.skip(f"{project.safe_arm} is not built")
    motion = read_motion(motion_file, load_limits(project.model))
    write_canonical(motion, folder / "motion.txt")
    done = subprocess.run([project.safe_arm, "run", "--model", project.model, "--motion", folder / "motion.txt", "--out", folder / "out"],
                          capture_output=True, text=True, check=False, timeout=60)  # fmt: skip
    assert done.returncode == 0, done.stderr
    series = read_series(folder / "out" / "series.csv")
    assert series.state[-1] == "Operational"
    return motion, [joint[-1] for joint in series.position_rad]


@pytest.mark.verifies("SWR-MOT-009", technique="interface")
def test_the_arm_follows_a_motion_with_more_parts_to_its_last_posture(tmp_path: Path) -> None:
    motion, end = follow(ROOT / "tools" / "tests" / "motion" / "data" / "arm_with_fingers.yaml", tmp_path)

    assert end == pytest.approx(motion.position_rad[-1].tolist(), abs=1e-3)


PREDECESSORS = ROOT / "../shared/data/motion/seed_pa10/pa10_example.yaml"


@pytest.mark.skipif(not PREDECESSORS.exists(), reason=f"{PREDECESSORS} is absent")
def test_the_arm_follows_the_example_of_the_predecessors_to_its_last_posture(tmp_path: Path) -> None:
    motion, end = follow(PREDECESSORS, tmp_path)

    assert end == pytest.approx(motion.position_rad[-1].tolist(), abs=1e-3)


@pytest.mark.verifies("SWR-CLI-013", technique="fault_injection", polarity="violation")
def test_a_value_that_the_program_rejects_is_one_line(command: Callable[..., int], capsys: pytest.CaptureFixture[str]) -> None:
    assert command("rejects", "--fault", "message_late,magnitude=99") == 2

    said = capsys.readouterr().err
    assert said == "mamori: run: --fault: magnitude must be small\n"


@pytest.mark.verifies("SWR-CLI-013", technique="fault_injection", polarity="violation")
def test_a_file_in_the_place_of_the_folder_is_one_line(command: Callable[..., int], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "run").write_text("")

    assert command("Safe", "--fault", "power_loss") == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.verifies("SWR-CLI-004", technique="back_to_back")
def test_the_help_lists_each_kind_that_has_a_scenario(plan: Plan) -> None:
    texts = make_texts()
    latent_only = set(LATENT_KINDS) - {"reduced_speed"}

    assert {each.fault.kind for each in plan.scenarios if isinstance(each, ArmScenario)} == {
        kind for kind in KINDS if kind in texts["run"] and kind not in latent_only}
    assert all(kind in texts["run"] for kind in LATENT_KINDS)
    assert all(each.name in texts["demo"] for each in plan.scenarios)
