# SPDX-License-Identifier: Apache-2.0
# Goal: the compiled machine has each property, and a defect that takes one of them away is found, and only there.
# Method: both provers on the models of the built program, and on those of machines with one seeded defect each.
from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.safe_state.defects import DEFECTS, Defect
from verification.safe_state.machine import Machine
from verification.safe_state.properties import PROPERTIES, RANKS
from verification.safe_state.prove import REFUTED, Result, prove
from verification.safe_state.relation import Relation


@pytest.fixture(scope="module")
def results(machine: Machine, tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Result]:
    return {result.property.name: result for result in prove(machine, tmp_path_factory.mktemp("proof"))}


@pytest.mark.parametrize(
    "name",
    [pytest.param(one.name, marks=pytest.mark.verifies(one.requirement, technique="state_transition", polarity="violation"))
     for one in PROPERTIES],
)  # fmt: skip
def test_property_of_the_compiled_machine_is_proved(results: Mapping[str, Result], name: str) -> None:
    assert results[name].is_proved, "\n".join(results[name].steps)
    assert results[name].verdicts


@pytest.mark.verifies("SWR-FSM-024", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("defect", DEFECTS, ids=lambda defect: defect.breaks)
def test_seeded_defect_breaks_its_property_and_no_other(machine: Machine, tmp_path: Path, defect: Defect) -> None:
    broken = [result for result in prove(defect.seed(machine), tmp_path) if not result.is_proved]

    assert [result.property.name for result in broken] == [defect.breaks]
    assert set(broken[0].verdicts.values()) == {REFUTED}, "each prover that judges it finds it"
    steps = broken[0].steps
    assert steps
    if not broken[0].property.possible:
        assert steps[0].startswith("SelfTest -> "), "it begins at power-up"
        assert all(re.search(r"\w+.* -> \w+: .*; torque (on|off), brakes (open|closed)|again and again", step) for step in steps)


@pytest.mark.verifies("SWR-FSM-024", technique="requirements_based", polarity="violation")
def test_each_property_has_one_defect_a_requirement_and_a_sentence() -> None:
    requirements = (ROOT / "requirements" / "software" / "safe_state.md").read_text(encoding="utf-8")

    assert [defect.breaks for defect in DEFECTS] == [one.name for one in PROPERTIES]
    assert len({one.name for one in PROPERTIES}) == len(PROPERTIES) >= 12
    for one in PROPERTIES:
        assert f"## {one.requirement} " in requirements
        assert one.sentence.endswith(".")
        assert one.provers


@pytest.mark.verifies("SWR-FSM-023")
def test_properties_know_each_state_of_the_machine(relation: Relation) -> None:
    assert set(RANKS) == set(relation.states)


@pytest.mark.verifies("SWR-FSM-023", technique="state_transition", polarity="violation")
def test_breach_is_shown_from_power_up_on(machine: Machine, tmp_path: Path) -> None:
    defect = next(one for one in DEFECTS if one.breaks == "corrupted-state-locks-out")

    broken = [result for result in prove(defect.seed(machine), tmp_path) if not result.is_proved]

    assert len(broken) == 1
    assert broken[0].steps[-2].endswith("a bit of the stored state flips; torque off, brakes closed")
    assert broken[0].steps[-1].startswith("LockedOut (corrupted) -> Safe: demand ")
