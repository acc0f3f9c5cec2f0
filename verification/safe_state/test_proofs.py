# SPDX-License-Identifier: Apache-2.0
# Goal: the compiled machine and brakes have each property, and the provers refute exactly the property that a defect removes. Method: both
# provers on the models of the built programs, and on models of parts with one seeded defect each.
from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.defects import BRAKE_DEFECTS
from verification.safe_state.brakes.properties import BRAKE_PROPERTIES
from verification.safe_state.brakes.subject import BrakeSubject
from verification.safe_state.defects import DEFECTS
from verification.safe_state.machine_subject import MachineSubject
from verification.safe_state.properties import PROPERTIES, RANKS
from verification.safe_state.prove import REFUTED, Result, prove
from verification.safe_state.relation import Relation

ALL_PROPERTIES = (*PROPERTIES, *BRAKE_PROPERTIES)
ALL_DEFECTS = [defect.breaks for defect in DEFECTS] + [defect.breaks for defect in BRAKE_DEFECTS]


@pytest.fixture(scope="module")
def results(pair: Pair, tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Result]:
    folder = tmp_path_factory.mktemp("proof")
    return {result.property.name: result for subject in (MachineSubject(pair.machine), BrakeSubject(pair)) for result in prove(subject, folder)}


def prove_faulty(name: str, pair: Pair, folder: Path) -> list[Result]:
    """@return the properties that are refuted for the part with the seeded defect of the property `name`."""
    of_machine = {defect.breaks: defect for defect in DEFECTS}
    of_brakes = {defect.breaks: defect for defect in BRAKE_DEFECTS}
    subject = (MachineSubject(of_machine[name].seed(pair.machine)) if name in of_machine
               else BrakeSubject(replace(pair, brakes=of_brakes[name].seed(pair.brakes))))  # fmt: skip
    return [result for result in prove(subject, folder) if not result.is_proved]


@pytest.mark.parametrize(
    "name",
    [pytest.param(one.name, marks=pytest.mark.verifies(one.requirement, technique="state_transition", polarity="violation"))
     for one in ALL_PROPERTIES],
)  # fmt: skip
def test_property_of_the_compiled_part_is_proved(results: Mapping[str, Result], name: str) -> None:
    assert results[name].is_proved, "\n".join(results[name].steps)
    assert results[name].verdicts


@pytest.mark.verifies("SWR-FSM-024", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("name", ALL_DEFECTS)
def test_seeded_defect_breaks_its_property_and_no_other(pair: Pair, tmp_path: Path, name: str) -> None:
    broken = prove_faulty(name, pair, tmp_path)

    assert [result.property.name for result in broken] == [name]
    assert set(broken[0].verdicts.values()) == {REFUTED}, "each prover that checks it finds it"
    steps = broken[0].steps
    assert steps
    if not broken[0].property.possible:
        assert steps[0].startswith("SelfTest -> "), "it begins at power-up"
        assert all(re.search(r"\w+.* -> \w+: .*; torque (on|off), brakes (open|closed)|again and again", step) for step in steps)


@pytest.mark.verifies("SWR-FSM-024", technique="requirements_based", polarity="violation")
def test_each_property_has_one_defect_a_requirement_and_a_sentence() -> None:
    requirements = (ROOT / "requirements" / "software" / "safe_state.md").read_text(encoding="utf-8")

    assert [one.name for one in ALL_PROPERTIES] == ALL_DEFECTS
    assert len({one.name for one in ALL_PROPERTIES}) == len(ALL_PROPERTIES), "--defect distinguishes them"
    assert len(PROPERTIES) >= 12
    for one in ALL_PROPERTIES:
        assert f"## {one.requirement} " in requirements
        assert one.sentence.endswith(".")
        assert one.provers


@pytest.mark.verifies("SWR-FSM-023")
def test_properties_know_each_state_of_the_machine(relation: Relation) -> None:
    assert set(RANKS) == set(relation.states)


@pytest.mark.verifies("SWR-FSM-023", technique="state_transition", polarity="violation")
def test_breach_is_shown_from_power_up_on(pair: Pair, tmp_path: Path) -> None:
    broken = prove_faulty("corrupted-state-locks-out", pair, tmp_path)

    assert len(broken) == 1
    assert broken[0].steps[-2].endswith("a bit of the stored state flips; torque off, brakes closed")
    assert broken[0].steps[-1].startswith("LockedOut (corrupted) -> Safe: demand ")


@pytest.mark.verifies("SWR-FSM-023", technique="state_transition", polarity="violation")
def test_breach_under_the_machine_is_shown_with_the_inputs_of_both(pair: Pair, tmp_path: Path) -> None:
    broken = prove_faulty("ss1-confirmed-by-its-brakes", pair, tmp_path)

    last = broken[0].steps[-1]
    assert last.startswith("ProtectiveStopSs1 -> Safe: demand ")
    assert "stands, contacts silent" in last
    assert "standstill confirmed; torque off, brakes closed" in last
