# SPDX-License-Identifier: Apache-2.0
# Goal: a slip in the source of the brake sequence reaches the provers: nothing between the C++ and the counterexample is written by hand.
# Method: a copy of the source with one slip is compiled, explored and judged; what is broken is known beforehand.
from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.prove import prove_brakes
from verification.safe_state.brakes.relation import read_brakes
from verification.safe_state.brakes.sequence import make_cycles
from verification.safe_state.machine import Machine
from verification.safe_state.relation import run_program
from verification.safe_state.source_slip import Slip

HEADER = "include/mamori/safety/reaction/brake_sequence.hpp"
SOURCE = "src/reaction/brake_sequence.cpp"
INCLUDES = tuple(f"-I{ROOT / layer / 'include'}" for layer in ("safety", "kernel"))


GATE_SLIPS = ("pushed brakes open", "late by one tick")  # the others are `long`
SLIPS = {
    "an SS1 closes at once": Slip(
        SOURCE, "state == SafeState::kProtectiveStopSs1 && is_told_", "state == SafeState::kProtectiveStopSs1",
        ("brakes-close-under-torque-in-ss1-only",)),
    "pushed brakes open": Slip(
        SOURCE, "    return is_standing && have_bitten(now);", "    is_told_ = is_standing;\n    return is_standing && have_bitten(now);",
        # Where the push comes with the end of the stop, the brakes stay closed, and their time counts anew: no claim about it holds.
        ("brakes-open-by-a-start-only", "silent-brakes-are-overdue", "torque-outlives-the-hold-within-the-closing-time")),
    "standstill alone confirms": Slip(
        SOURCE, "return is_standing && have_bitten(now);", "return is_standing;", ("ss1-confirmed-by-its-brakes",)),
    "torque outlives every stop": Slip(
        SOURCE, "state == SafeState::kStandby && was_held", "was_held", ("torque-outlives-the-hold-only", "sto-waits-for-no-brakes")),
    "late by one tick": Slip(
        SOURCE, "elapsed < limits_.closes_within;", "elapsed <= limits_.closes_within;",
        ("torque-outlives-the-hold-within-the-closing-time",)),
    "nobody reports": Slip(
        HEADER, "is_told_ && limits_.has_contacts && !are_closed_ &&", "limits_.has_contacts && are_closed_ &&",
        ("silent-brakes-are-overdue",)),
}  # fmt: skip


def build_with(slip: Slip, folder: Path) -> Path:
    """@return the relation program, made from a copy of the source with the slip."""
    for name in (HEADER, SOURCE):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / "safety" / name, folder / name)
    slip.put_into(folder)
    sources = [ROOT / "verification/safe_state/src/brake_main.cpp", ROOT / "kernel/src/base/assert.cpp", folder / SOURCE,
               *(ROOT / "safety/src/reaction").glob("safe_state*.cpp")]  # fmt: skip
    program = folder / "relation"
    subprocess.run(("g++", "-std=c++17", "-O1", f"-I{folder / 'include'}", *INCLUDES, *map(str, sources), "-o", str(program)), check=True)
    return program


@pytest.mark.verifies("SWR-FSM-023", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("name", [pytest.param(name, marks=() if name in GATE_SLIPS else pytest.mark.long) for name in SLIPS])
def test_slip_in_the_source_of_the_brakes_is_refuted(machine: Machine, tmp_path: Path, name: str) -> None:
    slip = SLIPS[name]
    brakes = make_cycles(read_brakes(run_program(build_with(slip, tmp_path)), tmp_path))

    broken = [result for result in prove_brakes(Pair(machine, brakes), tmp_path) if not result.is_proved]

    assert {result.property.name for result in broken} == set(slip.broken)
    assert all(result.steps for result in broken)
