# SPDX-License-Identifier: Apache-2.0
# Goal: the provers detect a defect in the C++ source of machine or brakes, because no step from source to counterexample is manual. Method:
# a copy of the source with one defect is compiled, explored and checked; the violated properties are known in advance.
from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.relation import read_brakes
from verification.safe_state.brakes.sequence import make_cycles
from verification.safe_state.brakes.subject import BrakeSubject
from verification.safe_state.machine import Machine, merge
from verification.safe_state.machine_subject import MachineSubject
from verification.safe_state.prove import Subject, prove
from verification.safe_state.relation import read_relation, run_program

TABLE = "safety/include/mamori/safety/reaction/safe_state.hpp"
EDGE = "safety/include/mamori/safety/base/rising_edge.hpp"
MACHINE = "safety/src/reaction/safe_state_machine.cpp"
BRAKE_HEADER = "safety/include/mamori/safety/reaction/brake_sequence.hpp"
BRAKES = "safety/src/reaction/brake_sequence.cpp"
GATE_SLIPS = ("cell of the table", "bound", "pushed brakes open", "late by one tick")  # the other slips are `long`


@dataclass(frozen=True)
class Slip:
    """The text `right` occurs once in `file` and becomes `wrong`; the provers then refute the properties `broken`."""

    file: str
    right: str
    wrong: str
    broken: tuple[str, ...]

    @property
    def is_of_brakes(self) -> bool:
        return self.file in (BRAKE_HEADER, BRAKES)

    def put_into(self, folder: Path) -> None:
        """@param folder copy of the sources that contains `file`."""
        path = folder / self.file
        text = path.read_text(encoding="utf-8")
        assert text.count(self.right) == 1, "the source has changed; adapt the slip"
        path.write_text(text.replace(self.right, self.wrong), encoding="utf-8")


SLIPS = {
    "cell of the table": Slip(
        TABLE, "kHold, kHold, kHold, kStby, kHold, kHold, kHold", "kHold, kHold, kHold, kOper, kHold, kHold, kHold",
        ("stop-never-turns-into-motion",)),
    "order of two events": Slip(
        TABLE, "    kSelfTestFailed,       ///< a self test failed, at power-up or later\n"
        "    kDemandSto,            ///< torque off is demanded\n", "    kDemandSto,\n    kSelfTestFailed,\n",
        # The columns of the table keep their order: an STO demand now leads to LockedOut, and a failed self test to Safe.
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
    "an SS1 closes at once": Slip(
        BRAKES, "state == SafeState::kProtectiveStopSs1 && is_told_", "state == SafeState::kProtectiveStopSs1",
        ("brakes-close-under-torque-in-ss1-only",)),
    "pushed brakes open": Slip(
        BRAKES, "    return is_standing && have_bitten(now);", "    is_told_ = is_standing;\n    return is_standing && have_bitten(now);",
        # If the push comes at the end of the stop, the brakes stay closed and their time restarts: the properties about this time fail.
        ("brakes-open-by-a-start-only", "silent-brakes-are-overdue", "torque-outlives-the-hold-within-the-closing-time")),
    "standstill alone confirms": Slip(
        BRAKES, "return is_standing && have_bitten(now);", "return is_standing;",
        ("ss1-confirmed-by-its-brakes", "contacts-confirm-after-the-command-only")),
    "stuck contact confirms": Slip(
        BRAKES, "are_closed_ && (have_reported_open_ || is_time_over)", "are_closed_", ("contacts-confirm-after-the-command-only",)),
    "torque outlives every stop": Slip(
        BRAKES, "state == SafeState::kStandby && was_held", "was_held", ("torque-outlives-the-hold-only", "sto-waits-for-no-brakes")),
    "late by one tick": Slip(
        BRAKES, "elapsed < limits_.closes_within;", "elapsed <= limits_.closes_within;",
        ("torque-outlives-the-hold-within-the-closing-time",)),
    "nobody reports": Slip(
        BRAKE_HEADER, "is_told_ && limits_.has_contacts && !are_closed_ &&", "limits_.has_contacts && are_closed_ &&",
        ("silent-brakes-are-overdue",)),
}  # fmt: skip


def build_with(slip: Slip, folder: Path) -> str:
    """@return the relation of the part with the slip, printed by a program built from a copy of the source."""
    for name in ("include", "src"):
        shutil.copytree(ROOT / "safety" / name, folder / "safety" / name)
    slip.put_into(folder)
    program = folder / "relation"
    main = "brake_main.cpp" if slip.is_of_brakes else "main.cpp"
    reaction = folder / "safety/src/reaction"
    sources = [ROOT / "verification/safe_state/src" / main, ROOT / "kernel/src/base/assert.cpp", *reaction.glob("safe_state*.cpp"),
               reaction / "brake_sequence.cpp"]  # fmt: skip
    subprocess.run(("g++", "-std=c++17", "-O1", f"-I{folder / 'safety/include'}", f"-I{ROOT / 'kernel/include'}",
                    *map(str, sources), "-o", str(program)), check=True)  # fmt: skip
    return run_program(program)


def make_subject(slip: Slip, text: str, machine: Machine) -> Subject:
    if slip.is_of_brakes:
        return BrakeSubject(Pair(machine, make_cycles(read_brakes(text, Path("brakes.json")))))
    return MachineSubject(merge(read_relation(text, Path("relation.json"))))


@pytest.mark.verifies("SWR-FSM-023", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("name", [pytest.param(name, marks=() if name in GATE_SLIPS else pytest.mark.long) for name in SLIPS])
def test_slip_in_the_source_is_refuted(machine: Machine, tmp_path: Path, name: str) -> None:
    slip = SLIPS[name]

    broken = [result for result in prove(make_subject(slip, build_with(slip, tmp_path), machine), tmp_path) if not result.is_proved]

    assert {result.property.name for result in broken} == set(slip.broken)
    assert all(result.steps for result in broken)
