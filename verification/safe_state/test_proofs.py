# SPDX-License-Identifier: Apache-2.0
# Goal: the compiled machine and brakes have each property, and the provers refute exactly the property that a defect removes. Method: both
# provers on the models of the built programs, and on models of parts with one seeded defect each.
from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

import pytest

from mamori_tools.host.project import ROOT
from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.defects import BRAKE_DEFECTS
from verification.safe_state.brakes.properties import BRAKE_PROPERTIES
from verification.safe_state.brakes.subject import BrakeSubject
from verification.safe_state.conftest import Proved
from verification.safe_state.defects import DEFECTS
from verification.safe_state.machine_subject import MachineSubject
from verification.safe_state.properties import PROPERTIES, RANKS
from verification.safe_state.prove import REFUTED, Result, prove
from verification.safe_state.relation import Relation

ALL_PROPERTIES = (*PROPERTIES, *BRAKE_PROPERTIES)
ALL_DEFECTS = [defect.breaks for defect in DEFECTS] + [defect.breaks for defect in BRAKE_DEFECTS]


@pytest.fixture(scope="module")
def prove_faulty(pair: Pair, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], list[Result]]:
    """@return a function that returns the properties that are refuted for the part with the seeded defect of a property."""
    of_machine = {defect.breaks: defect for defect in DEFECTS}
    of_brakes = {defect.breaks: defect for defect in BRAKE_DEFECTS}

    @cache
    def prove_one(name: str) -> list[Result]:
        subject = MachineSubject(of_machine[name].seed(pair.machine)) if name in of_machine else BrakeSubject(of_brakes[name].seed(pair))
        return [result for result in prove(subject, tmp_path_factory.mktemp("defect")) if not result.is_proved]

    return prove_one


@pytest.mark.parametrize(
    "name",
    [pytest.param(one.name, marks=pytest.mark.verifies(one.requirement, technique="state_transition", polarity="violation"))
     for one in ALL_PROPERTIES],
)  # fmt: skip
def test_property_of_the_compiled_part_is_proved(proved: Proved, name: str) -> None:
    row = next(row for row in proved.record["properties"] if row["name"] == name)
    assert row["proved"], "\n".join(row["steps"])
    assert row["provers"]


@pytest.mark.verifies("SWR-FSM-024", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("name", ALL_DEFECTS)
def test_seeded_defect_breaks_its_property_and_no_other(prove_faulty: Callable[[str], list[Result]], name: str) -> None:
    broken = prove_faulty(name)

    assert [result.property.name for result in broken] == [name]
    assert set(broken[0].verdicts.values()) == {REFUTED}, "each prover that checks it finds it"
    steps = broken[0].steps
    assert steps
    if not broken[0].property.possible:
        assert steps[0].startswith("SelfTest -> "), "it begins at power-up"
        assert all(re.search(r"\w+.* -> \w+: .*; torque (on|off), brakes (open|closed)|again and again", step) for step in steps)


@pytest.mark.verifies("SWR-FSM-024", technique="requirements_based", polarity="violation")
def test_each_property_has_one_defect_a_requirement_and_a_sentence() -> None:
    requirements = "".join((ROOT / "requirements" / "software" / name).read_text(encoding="utf-8") for name in ("safe_state.md", "cycle.md"))

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
def test_breach_is_shown_from_power_up_on(prove_faulty: Callable[[str], list[Result]]) -> None:
    broken = prove_faulty("corrupted-state-locks-out")

    assert len(broken) == 1
    assert broken[0].steps[-2].endswith("a bit of the stored state flips; torque off, brakes closed")
    assert broken[0].steps[-1].startswith("LockedOut (corrupted) -> Safe: demand ")


@pytest.mark.verifies("SWR-FSM-023", technique="state_transition", polarity="violation")
def test_breach_under_the_machine_is_shown_with_the_inputs_of_both(prove_faulty: Callable[[str], list[Result]]) -> None:
    broken = prove_faulty("ss1-confirmed-by-its-brakes")

    last = broken[0].steps[-1]
    assert last.startswith("ProtectiveStopSs1 -> Safe: demand ")
    assert "stands, contacts silent" in last
    assert "standstill confirmed; torque off, brakes closed" in last
