# SPDX-License-Identifier: Apache-2.0
"""One seeded defect for each property: a machine that violates only that property. It shows that the provers detect the violation.

@satisfies SWR-FSM-024      Design: docs/design/safe_state.md#seeded-defects
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Generic, TypeVar

import numpy as np

from verification.safe_state.machine import Machine, Past
from verification.safe_state.relation import INPUTS, OUTPUTS, VALUES

Cell = tuple[str, str]
Part = TypeVar("Part")


@dataclass(frozen=True)
class Defect(Generic[Part]):
    """`breaks`: name of the violated property. `sentence`: the wrong behaviour. `seed`: makes the faulty part from the correct one."""

    breaks: str
    sentence: str
    seed: Callable[[Part], Part]


TRUSTED: dict[str, Sequence[str]] = {"lock_out": ("no",), "self_test": ("Running", "Passed")}
WELL: dict[str, Sequence[str]] = {"demand": ("None",), "faults_cleared": ("yes",), "standstill": ("yes",)}
UP_TO_SS2: dict[str, Sequence[str]] = {"demand": ("None", "Degrade", "Ss2")}
RESET: dict[str, Sequence[str]] = {"reset_button": ("yes",)}
START: dict[str, Sequence[str]] = {"start_button": ("yes",), "start_permitted": ("yes",)}


def bend(source: str, target: str, *given: dict[str, Sequence[str]], past: Past | None = None, cell: Cell | None = None,
         is_consistent: bool = True) -> Callable[[Machine], Machine]:  # fmt: skip
    """A machine that steps from `source` to `target` for all inputs with the `given` values. Later values take precedence. Inputs without a
    given value have their TRUSTED ones. `past`: only after these button levels. `cell`: the cell of the table that changes too."""
    allowed: dict[str, Sequence[str]] = dict(TRUSTED)
    for part in given:
        allowed.update(part)

    def seed(machine: Machine) -> Machine:
        answers = machine.next.copy()
        digits = [[VALUES[name].index(value) for value in allowed.get(name, VALUES[name])] for name in INPUTS]
        for number, label in enumerate(machine.labels):
            if (label.state, label.is_consistent) != (source, is_consistent):
                continue
            if past is not None and any((one.start, one.reset) != (past.start, past.reset) and not _agree(one, past, allowed)
                                        for one in machine.pasts[number]):  # fmt: skip
                continue
            for start, reset in product(digits[6], digits[7]):
                place = np.ix_(*digits[:6], [start], [reset], *digits[8:])
                answers[number][place] = machine.find(target, Past(bool(start), bool(reset)))
        table = dict(machine.table)
        if cell is not None:
            table[cell] = target
        return replace(machine, next=answers, table=table)

    return seed


def _agree(one: Past, wanted: Past, allowed: dict[str, Sequence[str]]) -> bool:
    """True if both pasts agree in the buttons that the defect uses."""
    return ("start_button" not in allowed or one.start == wanted.start) and ("reset_button" not in allowed or one.reset == wanted.reset)


def close_brakes(state: str) -> Callable[[Machine], Machine]:
    """A machine that closes its brakes in `state`, with or without torque."""

    def seed(machine: Machine) -> Machine:
        place = OUTPUTS.index("brake_release")
        labels = tuple(
            replace(label, outputs=(*label.outputs[:place], False, *label.outputs[place + 1 :])) if label.state == state else label
            for label in machine.labels
        )
        return replace(machine, labels=labels)

    return seed


DEFECTS: tuple[Defect[Machine], ...] = (
    Defect("stop-weakened-by-reset-only", "The safe state ends by itself when all is well.",
           bend("Safe", "SelfTest", WELL, {"reset_button": ("no",)})),
    Defect("held-reset-restarts-nothing", "A reset that is held down resets again in each cycle.",
           bend("Safe", "SelfTest", WELL, RESET, past=Past(reset=True))),
    Defect("locked-hold-for-good", "STO leads from the locked hold to the safe state, from which a reset restarts.",
           bend("LockedHold", "Safe", {"demand": ("Sto", "Invalid")}, cell=("LockedHold", "DemandSto"))),
    Defect("failed-brakes-are-held", "The bound of an SS1 takes the torque although its brakes failed.",
           bend("ProtectiveStopSs1", "Safe", {"demand": ("None", "Degrade", "Ss2", "Ss1"), "brakes_failed": ("yes",), "time": ("Beyond",)})),
    Defect("locked-out-for-good", "A reset unlocks.",
           bend("LockedOut", "Safe", WELL, RESET, cell=("LockedOut", "Reset"))),
    Defect("sto-in-one-step", "STO is answered by an SS1.",
           bend("Operational", "ProtectiveStopSs1", {"demand": ("Sto", "Invalid")}, cell=("Operational", "DemandSto"))),
    Defect("ss1-within-its-bound", "SS1 waits until an SS2 under way has run out.",
           bend("ProtectiveStopSs2", "ProtectiveStopSs2", {"demand": ("Ss1",), "standstill": ("no",), "time": ("Within",)},
                cell=("ProtectiveStopSs2", "DemandSs1"))),
    Defect("ss2-escalates-within-both-bounds", "An SS2 escalates after its bound instead of at it.",
           bend("ProtectiveStopSs2", "ProtectiveStopSs2", UP_TO_SS2, {"standstill": ("no",), "time": ("AtBound",)})),
    Defect("no-livelock-of-stops", "A hold that is lost is answered by SS2 again.",
           bend("StandstillHold", "ProtectiveStopSs2", UP_TO_SS2, {"standstill": ("no",)}, cell=("StandstillHold", "DemandSs2"))),
    Defect("held-at-standstill-only", "Nobody looks whether the held machine stands.",
           bend("StandstillHold", "StandstillHold", UP_TO_SS2, {"standstill": ("no",)})),
    Defect("demand-ends-motion", "A degraded machine ignores SS2.",
           bend("Degraded", "Degraded", {"demand": ("Ss2",)}, cell=("Degraded", "DemandSs2"))),
    Defect("worst-event-wins", "Standby answers SS2 and ignores SS1.",
           bend("Standby", "Standby", {"demand": ("Ss1",)}, cell=("Standby", "DemandSs1"))),
    Defect("lost-trust-locks-out", "The safe state ignores the lock-out.",
           bend("Safe", "Safe", {"lock_out": ("yes",)}, cell=("Safe", "LockOut"))),
    Defect("torque-with-open-brakes-only", "The brakes close while torque holds.", close_brakes("StandstillHold")),
    Defect("start-needs-an-edge", "A start button that is held down starts.",
           bend("Standby", "Operational", WELL, START, past=Past(start=True))),
    Defect("start-needs-health", "A latched fault that demands nothing does not keep the machine from starting.",
           bend("Standby", "Operational", WELL, START, {"faults_cleared": ("no",)}, past=Past(start=False))),
    Defect("start-is-bumpless", "The start does not wait for the setpoint.",
           bend("Standby", "Operational", WELL, START, {"start_permitted": ("no",)}, past=Past(start=False))),
    Defect("torque-comes-on-from-standby-only", "A machine that moves, without torque, can be started.",
           bend("Standby", "Operational", WELL, START, {"standstill": ("no",)}, past=Past(start=False))),
    Defect("stop-never-turns-into-motion", "A reset leads from the hold into operation.",
           bend("StandstillHold", "Operational", WELL, RESET, past=Past(reset=False), cell=("StandstillHold", "Reset"))),
    Defect("limits-lifted-by-restore-only", "The limits are lifted when their reason has gone.",
           bend("Degraded", "Operational", WELL, {"reset_button": ("no",)})),
    Defect("standby-through-a-fresh-test", "The result of an earlier self test counts.",
           bend("SelfTest", "Standby", {"demand": ("None", "Degrade"), "self_test": ("Passed",)})),
    Defect("corrupted-state-locks-out", "A corrupted state is taken for the safe one.",
           bend("LockedOut", "Safe", is_consistent=False)),
    Defect("moves-are-arrows-of-the-table", "A reset in standby begins the self test again.",
           bend("Standby", "SelfTest", RESET, {"demand": ("None", "Degrade"), "start_button": ("no",)})),
    Defect("every-state-is-reached", "Degrade is answered by SS2.",
           bend("Operational", "ProtectiveStopSs2", {"demand": ("Degrade",)}, cell=("Operational", "Degrade"))),
    Defect("person-brings-it-back", "The safe state ignores the reset.",
           bend("Safe", "Safe", cell=("Safe", "Reset"))),
)  # fmt: skip
