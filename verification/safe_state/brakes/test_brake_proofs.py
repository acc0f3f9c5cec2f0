# SPDX-License-Identifier: Apache-2.0
# Goal: the compiled brake sequence has each property, alone and under the compiled machine, and a defect that takes one of them away is
# found, and only there. Method: both provers on the models of the built programs, and on those with one seeded defect each.
from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.defects import BRAKE_DEFECTS, BrakeDefect
from verification.safe_state.brakes.properties import BRAKE_PROPERTIES
from verification.safe_state.brakes.prove import prove_brakes
from verification.safe_state.properties import PROPERTIES
from verification.safe_state.prove import REFUTED, Result


@pytest.fixture(scope="module")
def results(pair: Pair, tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Result]:
    return {result.property.name: result for result in prove_brakes(pair, tmp_path_factory.mktemp("proof"))}


@pytest.mark.parametrize(
    "name",
    [pytest.param(one.name, marks=pytest.mark.verifies(one.requirement, technique="state_transition", polarity="violation"))
     for one in BRAKE_PROPERTIES],
)  # fmt: skip
def test_property_of_the_compiled_brakes_is_proved(results: Mapping[str, Result], name: str) -> None:
    assert results[name].is_proved, "\n".join(results[name].steps)
    assert results[name].verdicts


@pytest.mark.verifies("SWR-FSM-024", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("defect", BRAKE_DEFECTS, ids=lambda defect: defect.breaks)
def test_seeded_defect_of_the_brakes_breaks_its_property_and_no_other(pair: Pair, tmp_path: Path, defect: BrakeDefect) -> None:
    broken = [result for result in prove_brakes(replace(pair, brakes=defect.seed(pair.brakes)), tmp_path) if not result.is_proved]

    assert [result.property.name for result in broken] == [defect.breaks]
    assert set(broken[0].verdicts.values()) == {REFUTED}, "each prover that judges it finds it"
    steps = broken[0].steps
    assert steps
    if not broken[0].property.possible:
        assert steps[0].startswith("SelfTest -> "), "it begins at power-up"
        assert all(re.search(r"\w+.* -> \w+: .*; torque (on|off), brakes (open|closed)|again and again", step) for step in steps)


@pytest.mark.verifies("SWR-FSM-024", technique="requirements_based", polarity="violation")
def test_each_property_of_the_brakes_has_one_defect_a_requirement_and_a_sentence() -> None:
    requirements = (ROOT / "requirements" / "software" / "safe_state.md").read_text(encoding="utf-8")
    names = [one.name for one in BRAKE_PROPERTIES]

    assert [defect.breaks for defect in BRAKE_DEFECTS] == names
    assert len({*names, *(one.name for one in PROPERTIES)}) == len(names) + len(PROPERTIES), "--defect tells them apart"
    for one in BRAKE_PROPERTIES:
        assert f"## {one.requirement} " in requirements
        assert one.sentence.endswith(".")
        assert one.provers


@pytest.mark.verifies("SWR-FSM-023", technique="state_transition", polarity="violation")
def test_breach_under_the_machine_is_shown_with_the_inputs_of_both(pair: Pair, tmp_path: Path) -> None:
    defect = next(one for one in BRAKE_DEFECTS if one.breaks == "ss1-confirmed-by-its-brakes")

    broken = [result for result in prove_brakes(replace(pair, brakes=defect.seed(pair.brakes)), tmp_path) if not result.is_proved]

    last = broken[0].steps[-1]
    assert last.startswith("ProtectiveStopSs1 -> Safe: demand ")
    assert "stands, contacts silent" in last
    assert last.endswith("standstill confirmed; torque off, brakes closed")
