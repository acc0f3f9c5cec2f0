# SPDX-License-Identifier: Apache-2.0
"""Plans, and their cases for a motion. Method: a small plan with one error each; the complete shipped plan."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from mamori_tools.campaign import load_plan, load_subject, select
from mamori_tools.campaign.arm.fault import KINDS, LATENT_KINDS, Fault
from mamori_tools.campaign.arm.plan import ArmPlan
from mamori_tools.campaign.arm.selection import ArmCase, resolve
from mamori_tools.campaign.arm.vocabulary import DETECTED_FAULTS, NOTHING
from mamori_tools.motion import Motion, load_limits, read_motion
from mamori_trace.base.errors import InputError

ROOT = Path(__file__).resolve().parents[2]
SHIPPED = ROOT / "examples/safe_arm/faults.yaml"

GOOD = """\
schema: mamori.fault_plan/1
seed: 7
instants: [0.25, 0.5, 0.75]
motion_begins_at_s: 0.1
observe_s: 2.0
bounds: {hold_drift_rad: 0.002, hold_observed_s: 0.5, tracking_error_rad: 0.02}
scenarios:
  - name: none
    title: No fault
    fault: {kind: none}
    expected: {state: Operational, reaction: [None], detected_fault: [None]}
    requirements: {SYS-027: nominal}
  - name: encoder_freeze
    title: Joint {joint} freezes
    fault: {kind: encoder_freeze, joint: fastest, channel: a, min_speed_rad_s: 0.1}
    expected: {state: Safe, reaction: [Ss1, Sto], detected_fault: [EncoderDiscrepancy], within_s: 0.1}
    requirements: {SYS-020: violation, SYS-025: violation}
  - name: message_late
    title: Late
    fault: {kind: message_late, magnitude: 0.05, duration_s: 0.5}
    at_s: [1.0, 2.0]
    expected: {state: Safe, reaction: [Sto], detected_fault: [CommandStale], within_s: 0.02}
    requirements: {SYS-023: violation}
"""


def load(path: Path) -> ArmPlan:
    plan = load_plan(path)
    assert isinstance(plan, ArmPlan)
    return plan


@pytest.fixture
def plan(tmp_path: Path) -> ArmPlan:
    path = tmp_path / "faults.yaml"
    path.write_text(GOOD)
    return load(path)


@pytest.fixture
def motion() -> Motion:
    """Four seconds: joint 1 moves at 0.2 rad/s in the first second, joint 2 at 0.3 rad/s from 2.5 s to 3.5 s."""
    time_s = np.linspace(0.0, 4.0, 401)
    first = np.clip(time_s, 0.0, 1.0) * 0.2
    second = np.clip(time_s - 2.5, 0.0, 1.0) * 0.3
    return Motion("test", "0" * 64, ("J1", "J2"), time_s, np.column_stack([first, second]))


def resolve_one(plan: ArmPlan, motion: Motion, name: str, instants: int | None = None) -> tuple[ArmCase, ...]:
    return resolve(select(plan, [name], instants), motion)


@pytest.mark.verifies("SWR-CMP-001")
def test_a_plan_is_read_as_written(plan: ArmPlan) -> None:
    none, freeze, late = plan.scenarios

    assert (plan.seed, plan.observe_s, plan.bounds.hold_drift_rad) == (7, 2.0, 0.002)
    assert (none.instants, freeze.instants, late.instants, late.in_seconds) == ((), (0.25, 0.5, 0.75), (1.0, 2.0), True)
    assert freeze.expected.reactions == ("Ss1", "Sto")
    assert (none.expected.within_s, freeze.expected.within_s) == (None, 0.1)
    assert freeze.requirements == {"SYS-020": "violation", "SYS-025": "violation"}


PLAN_FAULTS = [
    ("schema: mamori.fault_plan/1", "schema: mamori.fault_plan/9", 1, "this tool reads mamori.fault_plan/1"),
    ("seed: 7", "seed: -1", 2, "0 to 2^64 - 1"),
    ("seed: 7", "sead: 7", 2, "unknown key 'sead' in fault plan; nearest: seed"),
    ("[0.25, 0.5, 0.75]", "[0.25, 1.0]", 3, "below 1"),
    ("[0.25, 0.5, 0.75]", "[0.5, 0.5]", 3, "0.5 after 0.5"),
    ("[0.25, 0.5, 0.75]", "[-0.1]", 3, "write 0 or more"),
    ("[0.25, 0.5, 0.75]", "[]", 3, "is empty"),
    ("[0.25, 0.5, 0.75]", "0.25", 3, "write a list"),
    ("observe_s: 2.0", "observe_s: 0", 5, "above 0"),
    ("observe_s: 2.0", "observe_s: .inf", 5, "not a number"),
    ("hold_drift_rad: 0.002, ", "", 6, "'hold_drift_rad' is missing"),
    ("name: none", "name: ../none", 8, "small letters"),
    ("name: encoder_freeze", "name: none", 13, "'none' stands twice"),
    ("kind: none", "kind: nine", 10, "unknown kind of fault 'nine'; nearest: none"),
    ("state: Safe, reaction: [Ss1", "state: Save, reaction: [Ss1", 16, "unknown 'Save'; nearest: Safe"),
    ("[Ss1, Sto]", "[Ss3]", 16, "unknown 'Ss3'"),
    ("[Ss1, Sto]", "[None, Sto]", 16, "'None' stands alone"),
    ("[Ss1, Sto]", "[]", 16, "is empty"),
    ("[EncoderDiscrepancy]", "[EncoderDiscrepanzy]", 16, "nearest: EncoderDiscrepancy"),
    (", within_s: 0.1}", "}", 16, "'within_s' belongs to a case with a reaction"),
    ("detected_fault: [None]}", "detected_fault: [None], within_s: 1}", 11, "'within_s' belongs to"),
    ("within_s: 0.1}", "within_s: 0}", 16, "above 0"),
    ("joint: fastest, ", "", 15, "encoder_freeze needs 'joint'"),
    ("joint: fastest", "joint: 0", 15, "joints count from 1"),
    ("channel: a", "channel: c", 15, "unknown channel 'c'"),
    ("{kind: none}", "{kind: none, joint: 1}", 10, "none takes no joint"),
    ("{kind: none}", "{kind: none, duration_s: 1}", 10, "takes no duration"),
    ("magnitude: 0.05, ", "magnitude: 0.05, min_speed_rad_s: 1, ", 20, "no joint that could move"),
    ("    at_s: [1.0, 2.0]", "    at_s: [1.0, 2.0]\n    at: [0.5]", 21, "'at' or 'at_s'"),
    ("{SYS-027: nominal}", "{SYS-27: nominal}", 12, "no requirement id"),
    ("{SYS-027: nominal}", "{SYS-027: good}", 12, "unknown 'good'"),
    ("{SYS-027: nominal}", "{}", 12, "names none"),
    ("{SYS-027: nominal}", "{SYS-027: nominal", 13, "no YAML"),
    ("    title: No fault\n", "    title: No fault\n    title: Again\n", 10, "stands twice"),
    ("    title: No fault\n", "    title: ~\n", 9, "write a text"),
    ("reaction: [None], detected_fault: [None]", "reaction: [Sto], detected_fault: [None], within_s: 1", 11, "a false trip"),
]


@pytest.mark.parametrize(("old", "new", "line", "words"), PLAN_FAULTS)
@pytest.mark.verifies("SWR-CMP-002", technique="equivalence_classes", polarity="violation")
def test_a_broken_plan_is_refused_with_its_line(tmp_path: Path, old: str, new: str, line: int, words: str) -> None:
    assert old in GOOD
    path = tmp_path / "faults.yaml"
    path.write_text(GOOD.replace(old, new, 1))

    with pytest.raises(InputError) as caught:
        load_plan(path)
    assert str(caught.value).startswith(f"{path}:{line}: ")
    assert words in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("text", ["a: &a [1]\nb: [*a, *a]\n", "x: " + "[" * 30 + "]" * 30, "- 1\n", "[" * 50_000])
@pytest.mark.verifies("SWR-CMP-002", technique="error_guessing", polarity="violation")
def test_hostile_yaml_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "faults.yaml"
    path.write_text(text)

    with pytest.raises(InputError):
        load_plan(path)


@pytest.mark.verifies("SWR-CMP-002")
def test_scenarios_are_selected_by_name_in_the_order_of_the_plan(plan: ArmPlan, motion: Motion) -> None:
    names = [case.id for case in resolve(select(plan, ["message_late", "none", "none"]), motion)]

    assert names == ["none-1", "message_late-1", "message_late-2"]
    assert len(resolve(select(plan), motion)) == 1 + 3 + 2


@pytest.mark.verifies("SWR-CMP-002")
def test_the_first_instants_of_each_scenario_can_be_selected(plan: ArmPlan, motion: Motion) -> None:
    assert [case.id for case in resolve(select(plan, instants=1), motion)] == ["none-1", "encoder_freeze-1", "message_late-1"]
    assert len(resolve(select(plan, instants=3), motion)) == 6


@pytest.mark.verifies("SWR-CMP-002", technique="boundary_values", polarity="violation")
def test_more_instants_than_the_plan_has_are_refused(plan: ArmPlan) -> None:
    with pytest.raises(InputError, match="4 instants per scenario; the plan has 3: write 1 to 3"):
        select(plan, instants=4)


@pytest.mark.verifies("SWR-CMP-002", polarity="violation")
def test_an_unknown_scenario_is_answered_with_the_nearest_names(plan: ArmPlan) -> None:
    with pytest.raises(InputError, match="unknown scenario 'encoder_frieze'; nearest: encoder_freeze"):
        select(plan, ["encoder_frieze"])


@pytest.mark.verifies("SWR-CMP-002", technique="boundary_values", polarity="violation")
def test_less_than_one_instant_is_refused(plan: ArmPlan) -> None:
    with pytest.raises(InputError, match="write 1 or more"):
        select(plan, instants=0)


@pytest.mark.verifies("SWR-CMP-001")
def test_an_injection_is_placed_where_a_joint_moves(plan: ArmPlan, motion: Motion) -> None:
    faults = [case.fault for case in resolve_one(plan, motion, "encoder_freeze")]

    # 1.0 s: nothing moves until 2.5 s; the mean over 0.1 s reaches 0.1 rad/s when a third of the window is after 2.5 s.
    # 2.0 s: as before, but each instant occurs only once. 3.0 s: joint 2 moves.
    assert [(fault.joint, fault.at_s) for fault in faults if fault] == [(2, 2.44), (2, 2.45), (2, 3.0)]


@pytest.mark.verifies("SWR-CMP-001")
def test_the_fastest_joint_at_the_instant_is_taken(plan: ArmPlan, motion: Motion, tmp_path: Path) -> None:
    path = tmp_path / "early.yaml"
    path.write_text(GOOD.replace("instants: [0.25,", "instants: [0.1,"))
    cases = resolve_one(load(path), motion, "encoder_freeze", 1)

    assert cases[0].fault == Fault("encoder_freeze", 0.4, 1, "a")
    assert cases[0].title == "Joint 1 freezes"


@pytest.mark.verifies("SWR-CMP-001")
def test_a_case_is_watched_for_the_declared_time(plan: ArmPlan, motion: Motion) -> None:
    late = resolve_one(plan, motion, "message_late")[0]
    none = resolve_one(plan, motion, "none")[0]

    assert late.fault == Fault("message_late", 1.0, None, None, 0.05, 0.5)
    assert (late.frames, late.watch_s, late.seed) == (3100, 2.0, 7)
    assert (none.fault, none.frames, none.watch_s) == (None, None, 4.1)


@pytest.mark.parametrize(("old", "new", "words"), [
    ("at_s: [1.0, 2.0]", "at_s: [1.0, 4.0]", "begins at 4.000 s, the motion lasts 4.000 s"),
    ("joint: fastest", "joint: 3", "names joint 3, the arm has 2"),
    ("min_speed_rad_s: 0.1", "min_speed_rad_s: 0.31", "no joint moves at 0.31 rad/s from 1.000 s"),
    ("joint: fastest", "joint: 1", "joint 1 never moves at 0.1 rad/s"),
])
@pytest.mark.verifies("SWR-CMP-002", technique="boundary_values", polarity="violation")
def test_what_a_motion_does_not_have_is_refused(tmp_path: Path, motion: Motion, old: str, new: str, words: str) -> None:
    path = tmp_path / "faults.yaml"
    path.write_text(GOOD.replace(old, new))

    with pytest.raises(InputError) as caught:
        resolve(select(load_plan(path)), motion)
    assert words in str(caught.value)
    assert str(caught.value).startswith(f"{path}:")


@pytest.mark.parametrize(("fault", "text"), [
    (Fault("encoder_freeze", 2.0, 2, "a"), "kind=encoder_freeze,joint=2,channel=a,at=2.0"),
    (Fault("torque_runaway", 0.5, 7, None, -1.0), "kind=torque_runaway,joint=7,at=0.5,magnitude=-1.0"),
    (Fault("message_lost", 0.5, duration_s=0.001), "kind=message_lost,at=0.5,duration=0.001"),
])
@pytest.mark.verifies("SWR-CMP-001", technique="interface")
def test_a_fault_is_given_to_the_program_as_text(fault: Fault, text: str) -> None:
    assert fault.to_text() == text


@pytest.mark.verifies("SWR-CMP-002", technique="interface")
def test_a_plan_may_name_the_faults_that_the_program_detects_and_no_others() -> None:
    header = ROOT / "examples/safe_arm/arm_faults.hpp"
    if not header.exists():
        pytest.skip(f"{header} is absent")
    names = re.findall(r"^    k(\w+), +///<", header.read_text(encoding="utf-8"), re.MULTILINE)

    assert {NOTHING, "SupervisorSilent", "WatchdogExpired", *names} - {"Count"} == set(DETECTED_FAULTS)


@pytest.mark.verifies("SWR-CMP-001", technique="interface")
def test_the_shipped_plan_injects_every_declared_kind_at_three_instants() -> None:
    plan = load_plan(SHIPPED)
    model = ROOT / "simbody_sim/models/pa10_like.yaml"
    if not model.exists():
        pytest.skip(f"{model} is absent")
    cases = resolve(select(plan), read_motion(ROOT / "examples/safe_arm/motions/pick_and_place.yaml", load_limits(model)))
    by_scenario: dict[str, set[float]] = {}
    for case in cases:
        if case.fault is not None:
            by_scenario.setdefault(case.scenario, set()).add(case.fault.at_s)

    assert all(len(instants) == 3 for instants in by_scenario.values())
    assert {case.fault.kind for case in cases if case.fault} >= {
        "encoder_freeze", "encoder_bit_flip", "controller_hang", "torque_runaway", "message_lost", "message_late",
        "power_loss", "supervisor_hang", "processor_stops", "emergency_stop", "protective_stop", "brake_creep",
        "enabling_released", "enabling_squeezed", "run_released", "reduced_speed", "encoder_drift", "clock_wrong"}
    assert [case.scenario for case in cases if case.fault is None] == [
        "none", "start_with_weak_brake", "start_with_sto_ignored", "start_with_relay_stuck", "start_with_start_stuck",
        "reduced_speed", "hold_to_run"]
    assert {case.latent.partition(":")[0] for case in cases} == {"", *LATENT_KINDS}


@pytest.mark.verifies("SWR-CMP-001", technique="interface")
def test_the_shipped_plan_verifies_each_campaign_requirement_with_the_polarity_it_needs() -> None:
    needed: set[tuple[str, str]] = set()
    for block in (ROOT / "requirements/system/system.md").read_text(encoding="utf-8").split("\n## ")[1:]:
        attributes = dict(line[2:].split(": ", 1) for line in block.splitlines() if line.startswith("- "))
        if "campaign" in attributes["Verify"] and attributes["Status"] == "approved":
            needed |= {(block.split()[0], polarity) for polarity in attributes["Polarity"].split(", ")}
    shown = {pair for scenario in load_plan(SHIPPED).scenarios for pair in scenario.requirements.items()}

    assert needed and needed <= shown


@pytest.mark.verifies("SWR-CMP-008")
def test_a_plan_without_a_subject_is_one_of_the_arm(plan: ArmPlan, tmp_path: Path) -> None:
    path = tmp_path / "named.yaml"
    path.write_text(GOOD.replace("seed: 7", "subject: arm\nseed: 7"))

    assert plan.subject == "arm" == load_plan(path).subject
    assert load_subject("arm").name == "arm" and set(load_subject("arm").kinds) == set(KINDS)


@pytest.mark.verifies("SWR-CMP-008", technique="error_guessing", polarity="violation")
def test_an_unknown_subject_is_rejected_with_its_line_and_the_nearest_names(tmp_path: Path) -> None:
    path = tmp_path / "named.yaml"
    path.write_text(GOOD.replace("seed: 7", "subject: arn\nseed: 7"))

    with pytest.raises(InputError, match=r"named.yaml:2: subject: unknown subject 'arn'; .*arm"):
        load_plan(path)
