# SPDX-License-Identifier: Apache-2.0
"""The proved properties of the machine: each with its requirement, a sentence, and its form for the provers.

Names in the properties for z3 (smt.py): `s` is the situation before the step and `t` the situation after it. `(state s)` and similar terms
are what an external observer sees of a situation. Inputs have their own names. `last_start`, `last_reset` and `has_run` are the past of
`s`.
Names in the properties for spin (promela.py): the values that an external observer sees between two cycles.

@satisfies SWR-FSM-023      Design: docs/design/safe_state.md#properties
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

RANKS: Mapping[str, int] = {
    "Operational": 0, "Degraded": 1, "Standby": 2, "SelfTest": 3, "ProtectiveStopSs2": 4, "StandstillHold": 4, "ProtectiveStopSs1": 5,
    "LockedHold": 6, "Safe": 7, "LockedOut": 8,
}  # fmt: skip
"""Distance from free motion of the machine. A less safe state has a lower rank."""


@dataclass(frozen=True)
class Induction:
    """A claim about many steps: `invariant` is true at power-up, each step preserves it, and it implies `claim`. The counters are defined
    in smt.py."""

    invariant: str
    claim: str


@dataclass(frozen=True)
class Property:
    """`step`: true for each single step (z3). `induction`: for z3. `always`: a formula of linear temporal logic that is true for each run
    (spin). `possible`: conditions, each of which is true in some run (spin). `is_coupled`: about the brakes under the machine."""

    name: str
    requirement: str
    sentence: str
    step: str = ""
    induction: Induction | None = None
    always: str = ""
    possible: tuple[str, ...] = ()
    is_coupled: bool = False

    @property
    def provers(self) -> tuple[str, ...]:
        return (("z3",) if self.step or self.induction else ()) + (("spin",) if self.always or self.possible else ())


STATES = tuple(RANKS)
TORQUE_COMES_ON = "(and (not (torque s)) (torque t))"
NOTHING_WRONG = "(and (= demand Demand_None) faults_cleared)"
IS_WEAKENED = "(and (is_stop s) (< (rank t) (rank s)))"

PROPERTIES: tuple[Property, ...] = (
    Property(
        "stop-weakened-by-reset-only", "SWR-FSM-006",
        "No stop is left for a weaker state unless the reset is pushed, nothing is demanded or latched, and the machine stands.",
        step=f"(=> {IS_WEAKENED} (and reset_button {NOTHING_WRONG} standstill))",
        always="[] (((state == Safe) && [] !reset) -> [] (state == Safe || state == LockedOut))",
    ),
    Property(
        "held-reset-restarts-nothing", "SWR-FSM-006",
        "A reset that was down in the cycle before weakens no stop and lifts no limit.",
        step=f"(=> (and reset_button last_reset) (not (or {IS_WEAKENED} (and (is s Degraded) (is t Operational)))))",
        always="[] (((state == Safe) && [] reset) -> [] (state == Safe || state == LockedOut))",
    ),
    Property(
        "locked-hold-for-good", "SWR-FSM-037",
        "The locked hold is left for the locked-out state only.",
        step="(=> (is s LockedHold) (or (is t LockedHold) (is t LockedOut)))",
        always="[] ((state == LockedHold) -> (([] (state == LockedHold)) || ((state == LockedHold) U (state == LockedOut))))",
    ),
    Property(
        "failed-brakes-are-held", "SWR-FSM-037",
        "An SS1 whose brakes failed keeps its torque in the locked hold, which no other state and no other event enters; STO and lost trust"
        " alone take it away.",
        step="(and (=> (and (is t LockedHold) (not (is s LockedHold))) (and (is s ProtectiveStopSs1) brakes_failed))"
             " (=> (and (is s ProtectiveStopSs1) brakes_failed (< demand Demand_Sto) (< self_test Test_Failed) (not lock_out))"
             " (is t LockedHold)))",
    ),
    Property(
        "locked-out-for-good", "SWR-FSM-003",
        "The locked-out state is left by no inputs.",
        step="(=> (is s LockedOut) (is t LockedOut))",
        always="([] !corrupted) -> [] ((state == LockedOut) -> [] (state == LockedOut))",
    ),
    Property(
        "sto-in-one-step", "SWR-FSM-005",
        "Torque is off after the step in which STO, or something that is no reaction, is demanded.",
        step="(=> (>= demand Demand_Sto) (not (torque t)))",
    ),
    Property(
        "ss1-within-its-bound", "SWR-FSM-004",
        "Torque is off at most the bound of SS1 after SS1 was demanded, at the first cycle from then on, unless failed brakes are held.",
        induction=Induction(
            invariant="(and (=> (limit_ss1 s) (and (<= 0 age) (< age ss1_within)))"
                      " (=> demanded (and (limit_ss1 s) (<= 0 since_demand age))))",
            claim="(=> demanded (< since_demand ss1_within))"),
        always="[] (demand_cycles <= SS1_WITHIN)",
    ),
    Property(
        "ss2-escalates-within-both-bounds", "SWR-FSM-004",
        "An SS2 whose standstill never comes has torque off after both bounds, and the cycle in which the first was passed, unless failed"
        " brakes are held.",
        induction=Induction(
            invariant="(and (=> (limit_ss1 s) (and (<= 0 age) (< age ss1_within))) (=> (limit_ss2 s) (and (<= 0 age) (< age ss2_within)))"
                      " (=> unconfirmed (or (and (limit_ss2 s) (= since_stop age))"
                      " (and (limit_ss1 s) (< (- since_stop age) (+ ss2_within cycle))))))",
            claim="(=> unconfirmed (< since_stop (+ ss2_within ss1_within cycle (- 1))))"),
        always="[] (stop_cycles <= SS2_WITHIN + SS1_WITHIN)",
    ),
    Property(
        "no-livelock-of-stops", "SWR-FSM-004",
        "A machine that stays in its stops comes to rest in the held one, and each SS1 ends with torque off or in the locked hold.",
        always="[] ((([] (state == ProtectiveStopSs2 || state == ProtectiveStopSs1 || state == StandstillHold))"
               " -> <> [] (state == StandstillHold)) && ((state == ProtectiveStopSs1) -> <> (!torque || state == LockedHold)))",
    ),
    Property(
        "held-at-standstill-only", "SWR-FSM-004",
        "The machine is in the holding state after those steps only in which it stood.",
        step="(=> (is t StandstillHold) standstill)",
    ),
    Property(
        "demand-ends-motion", "SWR-FSM-005",
        "After a step with a demand the machine moves no further than the demand allows.",
        step="(and (=> (>= demand Demand_Degrade) (not (is t Operational))) (=> (>= demand Demand_Ss2) (not (is_moving t))))",
    ),
    Property(
        "worst-event-wins", "SWR-FSM-005",
        "A worse demand, a failed self test or a lock-out beside the same other inputs never leads to a less safe state.",
        step="(=> (and (>= worse_demand demand) (or (= worse_self_test self_test) (>= worse_self_test Test_Failed))"
             " (=> lock_out worse_lock_out)) (>= (rank t_worse) (rank t)))",
    ),
    Property(
        "lost-trust-locks-out", "SWR-FSM-008",
        "A lock-out, a failed self test or a status that is none leads to the locked-out state from every state.",
        step="(=> (or lock_out (>= self_test Test_Failed)) (is t LockedOut))",
    ),
    Property(
        "torque-with-open-brakes-only", "SWR-FSM-009",
        "Brakes are open exactly while torque is on, except in the locked hold, whose brakes failed.",
        step="(and (= (torque s) (or (brake s) (is s LockedHold))) (= (torque t) (or (brake t) (is t LockedHold))))",
    ),
    Property(
        "start-needs-an-edge", "SWR-FSM-006",
        "Torque comes on only in a cycle in which the start is down and was up before.",
        step=f"(=> {TORQUE_COMES_ON} (and start_button (not last_start)))",
    ),
    Property(
        "start-needs-health", "SWR-FSM-006",
        "Torque comes on only when nothing is demanded and no fault is latched.",
        step=f"(=> {TORQUE_COMES_ON} {NOTHING_WRONG})",
    ),
    Property(
        "start-is-bumpless", "SWR-FSM-006",
        "Torque comes on only when the setpoint equals the measured position, as the application says.",
        step=f"(=> {TORQUE_COMES_ON} start_permitted)",
    ),
    Property(
        "torque-comes-on-from-standby-only", "SWR-FSM-006",
        "Torque comes on only in standby, at standstill.",
        step=f"(=> {TORQUE_COMES_ON} (and (is s Standby) (is t Operational) standstill))",
    ),
    Property(
        "stop-never-turns-into-motion", "SWR-FSM-002",
        "No stop under torque and no hold leads to a moving state.",
        step="(=> (and (is_stop s) (torque s)) (not (is_moving t)))",
    ),
    Property(
        "limits-lifted-by-restore-only", "SWR-FSM-006",
        "The degraded state is left by a reset with nothing wrong, or for a stop or worse.",
        step=f"(=> (and (is s Degraded) (not (is t Degraded))) (or (and (is t Operational) reset_button {NOTHING_WRONG}) (is_stop t)"
             " (is t LockedOut)))",
    ),
    Property(
        "standby-through-a-fresh-test", "SWR-FSM-008",
        "Standby is entered by a self test that was seen running in this visit and passed, or from the hold.",
        step="(=> (and (is t Standby) (not (is s Standby)))"
             " (or (and (is s SelfTest) has_run (= self_test Test_Passed)) (is s StandstillHold)))",
    ),
    Property(
        "corrupted-state-locks-out", "SWR-FSM-007",
        "A stored state that is found corrupted reads as locked out, has its outputs, and is locked out after the next step.",
        step="(=> (not (consistent s)) (and (= (state s) LockedOut) (not (torque s)) (not (brake s)) (is t LockedOut)))",
    ),
    Property(
        "moves-are-arrows-of-the-table", "SWR-FSM-001",
        "Each change of the state is an arrow of the compiled table.",
        step="(=> (and (consistent s) (not (= (state s) (state t)))) (arrow (state s) (state t)))",
    ),
    Property(
        "every-state-is-reached", "SWR-FSM-001",
        "Each state is reached from power-up: nothing is proved of a machine that does nothing.",
        possible=tuple(f"state == {state}" for state in STATES),
    ),
    Property(
        "person-brings-it-back", "SWR-FSM-006",
        "From the safe state there is a way back to operation.",
        possible=("was_safe && state == Operational",),
    ),
)  # fmt: skip
