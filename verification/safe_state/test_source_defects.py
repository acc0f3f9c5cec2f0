# SPDX-License-Identifier: Apache-2.0
# Goal: a slip in the source of the machine reaches the provers: from the C++ to the counterexample nothing is written by hand.
# Method: a copy of the source with one slip is compiled, explored and judged; what is broken is known beforehand.
from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.safe_state.machine import merge
from verification.safe_state.prove import prove
from verification.safe_state.relation import read_relation, run_program
from verification.safe_state.source_slip import Slip

TABLE = "safety/include/mamori/safety/reaction/safe_state.hpp"
EDGE = "safety/include/mamori/safety/base/rising_edge.hpp"
MACHINE = "safety/src/reaction/safe_state_machine.cpp"


GATE_SLIPS = ("cell of the table", "bound")  # the others are `long`
SLIPS = {
    "cell of the table": Slip(
        TABLE, "kHold, kHold, kHold,  kStby, kHold,  kHold,   kHold", "kHold, kHold, kHold,  kOper, kHold,  kHold,   kHold",
        ("stop-never-turns-into-motion",)),
    "order of two events": Slip(
        TABLE, "    kSelfTestFailed,       ///< a self test failed, at power-up or later\n"
        "    kDemandSto,            ///< torque off is demanded\n", "    kDemandSto,\n    kSelfTestFailed,\n",
        # The columns of the table keep their order: what is called STO locks out, and a failed self test leads to Safe.
        ("lost-trust-locks-out",)),
    "level for an edge": Slip(
        EDGE, "level && !was_high_", "level", ("held-reset-restarts-nothing", "start-needs-an-edge")),
    "condition of the start": Slip(
        MACHINE, "inputs.standstill &&\n                   inputs.start_permitted", "inputs.standstill", ("start-is-bumpless",)),
    "bound": Slip(
        MACHINE, "is_over(entered_at_, inputs.now, bound) || (is_at_bound && !inputs.standstill)",
        "is_over(entered_at_, inputs.now, bound) || (is_at_bound && inputs.standstill)",
        ("ss1-within-its-bound", "ss2-escalates-within-both-bounds")),
    "result of an earlier self test": Slip(
        MACHINE, "    has_test_run_ = false;\n", "", ("standby-through-a-fresh-test",)),
    "corrupted state": Slip(
        MACHINE, "        enter(SafeState::kLockedOut, inputs.now);\n        return SafeState::kLockedOut;",
        "        enter(SafeState::kSafe, inputs.now);\n        return SafeState::kSafe;", ("lost-trust-locks-out", "corrupted-state-locks-out")),
}  # fmt: skip


def build_with(slip: Slip, folder: Path) -> Path:
    """@return the relation program, made from a copy of the source with the slip."""
    for name in ("include", "src"):
        shutil.copytree(ROOT / "safety" / name, folder / "safety" / name)
    slip.put_into(folder)
    program = folder / "relation"
    sources = [ROOT / "verification/safe_state/src/main.cpp", ROOT / "kernel/src/base/assert.cpp", *(folder / "safety/src/reaction").glob("safe_state*.cpp")]
    subprocess.run(("g++", "-std=c++17", "-O1", f"-I{folder / 'safety/include'}", f"-I{ROOT / 'kernel/include'}",
                    *map(str, sources), "-o", str(program)), check=True)  # fmt: skip
    return program


@pytest.mark.verifies("SWR-FSM-023", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("name", [pytest.param(name, marks=() if name in GATE_SLIPS else pytest.mark.long) for name in SLIPS])
def test_slip_in_the_source_is_refuted(tmp_path: Path, name: str) -> None:
    slip = SLIPS[name]
    machine = merge(read_relation(run_program(build_with(slip, tmp_path)), tmp_path))

    broken = [result for result in prove(machine, tmp_path) if not result.is_proved]

    assert {result.property.name for result in broken} == set(slip.broken)
    assert all(result.steps for result in broken)
