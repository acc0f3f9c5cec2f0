# SPDX-License-Identifier: Apache-2.0
# Goal: the provers detect a defect in the C++ source of machine, brakes or cycle, because no step from source to counterexample is manual. Method:
# a copy of the source with one defect is compiled, explored and checked; the violated properties are known in advance.
from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT, Project
from mamori_trace.base.errors import InputError
from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.relation import read_brakes
from verification.safe_state.brakes.sequence import make_cycles
from verification.safe_state.brakes.subject import BrakeSubject
from verification.safe_state.brakes.torque import fill, read_torque
from verification.safe_state.command import BRAKE_TARGET, CYCLE_TARGET, TARGET
from verification.safe_state.machine import merge
from verification.safe_state.machine_subject import MachineSubject
from verification.safe_state.prove import Subject, prove
from verification.safe_state.relation import read_relation, run_program

TABLE = "safety/include/mamori/safety/reaction/safe_state.hpp"
EDGE = "safety/include/mamori/safety/base/rising_edge.hpp"
MACHINE = "safety/src/reaction/safe_state_machine.cpp"
BRAKE_HEADER = "safety/include/mamori/safety/reaction/brake_sequence.hpp"
BRAKES = "safety/src/reaction/brake_sequence.cpp"
CYCLE = "safety/src/cycle/safety_cycle.cpp"
REGISTER = "safety/src/reaction/fault_register.cpp"
OF_MACHINE, OF_BRAKES, OF_CYCLE = ((TARGET, "main.cpp"), (BRAKE_TARGET, "brake_main.cpp"), (CYCLE_TARGET, "cycle_main.cpp"))
GATE_SLIPS = ("cell of the table", "bound", "pushed brakes open", "late by one tick", "another fault waits too")  # the other slips are `long`


@dataclass(frozen=True)
class Slip:
    """The text `right` occurs once in `file` and becomes `wrong`; the provers then refute the properties `broken`."""

    file: str
    right: str
    wrong: str
    broken: tuple[str, ...] = ()

    @property
    def program(self) -> tuple[str, str]:
        if self.file in (CYCLE, REGISTER):
            return OF_CYCLE
        return OF_BRAKES if self.file in (BRAKE_HEADER, BRAKES) else OF_MACHINE

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
        ("brakes-open-by-a-start-only", "silent-brakes-are-overdue", "torque-outlives-the-hold-within-the-closing-time",
         "brakes-first-waits-for-the-brakes", "brakes-first-ends-with-the-closing-time")),
    "standstill alone confirms": Slip(
        BRAKES, "return is_standing && have_bitten(now);", "return is_standing;",
        ("ss1-confirmed-by-its-brakes", "contacts-confirm-after-the-command-only")),
    "stuck contact confirms": Slip(
        BRAKES, "are_closed_ && (have_reported_open_ || is_time_over)", "are_closed_",
        ("contacts-confirm-after-the-command-only", "brakes-first-waits-for-stuck-contacts")),
    "torque outlives every stop": Slip(
        BRAKES, "state == SafeState::kStandby && was_held", "was_held",
        ("torque-outlives-the-hold-only", "sto-waits-for-no-brakes")),
    "late by one tick": Slip(
        BRAKES, "elapsed < limits_.closes_within;", "elapsed <= limits_.closes_within;",
        ("torque-outlives-the-hold-within-the-closing-time", "brakes-first-ends-with-the-closing-time")),
    "nobody reports": Slip(
        BRAKE_HEADER, "is_told_ && limits_.has_contacts && !are_closed_;", "limits_.has_contacts && are_closed_;",
        ("silent-brakes-are-overdue",)),
    "another fault waits too": Slip(
        CYCLE, "            if (!waits_for_brakes(fault)) {\n                return false;\n            }\n", "",
        ("another-sto-ends-torque-at-once",)),
    "held by nothing": Slip(
        CYCLE, "state != SafeState::kSafe || !can_hold ||", "state != SafeState::kSafe ||", ("another-sto-ends-torque-at-once",)),
    "torque returns": Slip(
        CYCLE, "!was_torque_wanted_ || !state_", "!state_", ("cycle-keeps-torque-only",)),
    "no torque is kept": Slip(
        CYCLE, "    return is_demanded;\n", "    return false && is_demanded;\n",
        ("brakes-first-waits-for-the-brakes", "brakes-first-waits-for-stuck-contacts")),
}  # fmt: skip


def build_with(slip: Slip, folder: Path) -> Path:
    """@return a program that prints the relation of the part with the slip: built from a copy of the source for a header, otherwise from the
    objects of the build."""
    shutil.copytree(ROOT / "safety", folder / "safety", ignore=shutil.ignore_patterns("tests"))
    slip.put_into(folder)
    target, main = slip.program
    program = folder / "relation"
    build = Project(ROOT).build
    if slip.file.endswith(".cpp"):
        parts = [build / f"verification/safe_state/CMakeFiles/{target}.dir/src/{main}.o", folder / slip.file,
                 build / "safety/libmamori_safety.a", build / "kernel/libmamori_kernel.a"]  # fmt: skip
    else:
        reaction = folder / "safety/src/reaction"
        parts = [ROOT / "verification/safe_state/src" / main, ROOT / "kernel/src/base/assert.cpp", *reaction.glob("safe_state*.cpp"),
                 reaction / "brake_sequence.cpp"]  # fmt: skip
    subprocess.run(("g++", "-std=c++17", "-O1", f"-I{folder / 'safety/include'}", f"-I{ROOT / 'kernel/include'}",
                    *map(str, parts), "-o", str(program)), check=True)  # fmt: skip
    return program


def make_subject(slip: Slip, text: str, pair: Pair) -> Subject:
    if slip.program == OF_CYCLE:
        return BrakeSubject(replace(pair, torque=read_torque(text, pair.machine.states, Path("torque.json"))))
    if slip.program == OF_BRAKES:
        return BrakeSubject(Pair(pair.machine, make_cycles(read_brakes(text, Path("brakes.json"))), fill(pair.torque)))
    return MachineSubject(merge(read_relation(text, Path("relation.json"))))


@pytest.mark.verifies("SWR-FSM-023", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("name", [pytest.param(name, marks=() if name in GATE_SLIPS else pytest.mark.long) for name in SLIPS])
def test_slip_in_the_source_is_refuted(pair: Pair, tmp_path: Path, name: str) -> None:
    slip = SLIPS[name]

    broken = [result for result in prove(make_subject(slip, run_program(build_with(slip, tmp_path)), pair), tmp_path) if not result.is_proved]

    assert {result.property.name for result in broken} == set(slip.broken)
    assert all(result.steps for result in broken)


REFUSED = {
    "enters another state than its machine": Slip(
        CYCLE, "inputs.demand = demand.reaction;", "inputs.demand = machine.can_hold ? Reaction::kNone : demand.reaction;"),
    "gives other outputs than its brakes": Slip(
        CYCLE, "outputs.stop_requested = true;", "outputs.brake_release = true;"),
    "keeps torque for another reason than known": Slip(
        CYCLE, "state_.brakes_.is_closing(now)", "state_.brakes_.is_waiting()"),
    "does not latch a fault that is present": Slip(
        CYCLE, "bool result = is_present(fault);", "bool result = fault != 1U && is_present(fault);"),
    "forgets a fault without a reset": Slip(
        CYCLE, "if (reset_edge_.step(reset_button)) {", "if (!reset_edge_.step(reset_button)) {"),
    "demands another reaction than the table": Slip(
        REGISTER, "record.is_latched && is_worse(demand, record.demand)", "record.is_latched"),
}  # fmt: skip


@pytest.mark.verifies("SWR-PRF-053", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("words", REFUSED)
def test_cycle_that_is_not_its_machine_and_brakes_is_refused(tmp_path: Path, words: str) -> None:
    with pytest.raises(InputError, match=words):
        run_program(build_with(REFUSED[words], tmp_path))
